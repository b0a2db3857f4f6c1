# cmake --install: the program, the libraries of the rooms, their headers, and what find_package(dynamic_icp) needs.
include(CMakePackageConfigHelpers)

add_library(dynamic_icp INTERFACE)
add_library(dynamic_icp::dynamic_icp ALIAS dynamic_icp)
get_property(rooms GLOBAL PROPERTY DYNAMIC_ICP_ROOMS)
foreach(room IN LISTS rooms)
  target_link_libraries(dynamic_icp INTERFACE dynamic_icp_${room})
endforeach()
install(TARGETS dynamic_icp EXPORT dynamic_icp_targets)

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/dynamic_icp)
install(EXPORT dynamic_icp_targets FILE dynamic_icp-targets.cmake NAMESPACE dynamic_icp:: DESTINATION ${package_folder})
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/dynamic_icp-config.cmake.in
  ${PROJECT_BINARY_DIR}/dynamic_icp-config.cmake INSTALL_DESTINATION ${package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/dynamic_icp-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/dynamic_icp-config.cmake ${PROJECT_BINARY_DIR}/dynamic_icp-config-version.cmake
  DESTINATION ${package_folder})
