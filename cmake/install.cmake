# cmake --install: component `core` (the method: needs Eigen and fmt), component `io` (the readers of recordings) and the
# program; and what find_package(dynamic_icp COMPONENTS core|io) and a parent project need.
include(CMakePackageConfigHelpers)
set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/dynamic_icp)

# One library of all modules of a layer.
function(dynamic_icp_library name layer)
  get_property(modules GLOBAL PROPERTY DYNAMIC_ICP_MODULES_OF_${layer})
  set(objects)
  foreach(module IN LISTS modules)
    list(APPEND objects $<TARGET_OBJECTS:dynamic_icp_${module}>)
  endforeach()
  add_library(dynamic_icp_${name} ${objects})
  add_library(dynamic_icp::${name} ALIAS dynamic_icp_${name})
  set_target_properties(dynamic_icp_${name} PROPERTIES EXPORT_NAME ${name} LINKER_LANGUAGE CXX
    VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    INSTALL_RPATH $ORIGIN)  # as shared libraries, io finds core beside it
  target_include_directories(dynamic_icp_${name} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(dynamic_icp_${name} PUBLIC cxx_std_20)
  target_compile_definitions(dynamic_icp_${name} PUBLIC EIGEN_MAX_STATIC_ALIGN_BYTES=16)
  target_link_libraries(dynamic_icp_${name} PUBLIC ${ARGN})
  if(NOT DYNAMIC_ICP_INSTALL)
    return()
  endif()
  install(TARGETS dynamic_icp_${name} EXPORT dynamic_icp_${name}_targets COMPONENT ${name})
  install(EXPORT dynamic_icp_${name}_targets FILE dynamic_icp-${name}-targets.cmake NAMESPACE dynamic_icp::
    DESTINATION ${package_folder} COMPONENT ${name})
  get_property(headers GLOBAL PROPERTY DYNAMIC_ICP_HEADERS_OF_${layer})
  foreach(header IN LISTS headers)
    get_filename_component(folder ${header} DIRECTORY)
    install(FILES ${PROJECT_SOURCE_DIR}/dynamic_icp/${header}
      DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/dynamic_icp/${folder} COMPONENT ${name})
  endforeach()
endfunction()

dynamic_icp_library(core method Eigen3::Eigen)
target_link_libraries(dynamic_icp_core PRIVATE fmt::fmt pthread)
if(DYNAMIC_ICP_BUILD_IO)
  dynamic_icp_library(io recording dynamic_icp_core)
  target_link_libraries(dynamic_icp_io PRIVATE fmt::fmt yaml-cpp::yaml-cpp libzip::zip liblzf::lzf
    SQLite::SQLite3 ZLIB::ZLIB dynamic_icp::zstd dynamic_icp::lz4 dynamic_icp::bz2)
endif()

if(DYNAMIC_ICP_INSTALL)
  install(FILES dynamic_icp/dynamic_icp.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/dynamic_icp COMPONENT core)
  if(DYNAMIC_ICP_BUILD_IO)
    install(FILES dynamic_icp/recording.hpp DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/dynamic_icp COMPONENT io)
  endif()
  configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/dynamic_icp-config.cmake.in
    ${PROJECT_BINARY_DIR}/dynamic_icp-config.cmake INSTALL_DESTINATION ${package_folder})
  write_basic_package_version_file(${PROJECT_BINARY_DIR}/dynamic_icp-config-version.cmake COMPATIBILITY SameMinorVersion)
  install(FILES ${PROJECT_BINARY_DIR}/dynamic_icp-config.cmake ${PROJECT_BINARY_DIR}/dynamic_icp-config-version.cmake
    DESTINATION ${package_folder} COMPONENT core)
endif()
