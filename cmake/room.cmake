# A room is one folder under dynamic_icp/ and one static library dynamic_icp_<room>.
#
#   dynamic_icp_room(preprocess
#     DEPENDS base spatial                 rooms whose headers this one may include
#     SOURCES voxel_grid.cpp               header, source and test lie side by side
#     HEADERS voxel_grid.hpp               public: installed
#     TESTS voxel_grid_test.cpp            all tests of a room make one executable
#     LINKS yaml-cpp::yaml-cpp)            libraries used in the sources only
#
# A file that includes the header of a room not named in DEPENDS (or of what those depend on) stops the
# configuration with a message: the arrows of docs/map.md cannot be broken by accident.

add_library(dynamic_icp_build_flags INTERFACE)
target_compile_options(dynamic_icp_build_flags INTERFACE
  -Wall -Wextra -Wpedantic -Wconversion -Wshadow
  # The same results from every compiler: no fused multiply-adds that the source does not ask for.
  -ffp-contract=off
  # Nobody reads errno or the flags of floating point: without them loops with a choice in them become vectors.
  -fno-math-errno -fno-trapping-math)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # GCC 12 reports false positives inside Eigen's and the standard library's inlined code.
  target_compile_options(dynamic_icp_build_flags INTERFACE -Wno-maybe-uninitialized -Wno-array-bounds -Wno-restrict)
endif()
if(DYNAMIC_ICP_SANITIZE)
  target_compile_options(dynamic_icp_build_flags INTERFACE
    -fsanitize=${DYNAMIC_ICP_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(dynamic_icp_build_flags INTERFACE -fsanitize=${DYNAMIC_ICP_SANITIZE})
endif()
if(DYNAMIC_ICP_BUILD_FUZZERS)
  target_compile_options(dynamic_icp_build_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()

function(dynamic_icp_check_includes room allowed)
  foreach(file IN LISTS ARGN)
    file(STRINGS ${file} includes REGEX "^#include \"dynamic_icp/")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    foreach(line IN LISTS includes)
      string(REGEX REPLACE "^#include \"dynamic_icp/([a-z_]+)/.*" "\\1" used "${line}")
      if(NOT used IN_LIST allowed)
        message(FATAL_ERROR "dynamic_icp/${room}/${file} includes from the room '${used}', which is not among "
                            "the rooms that '${room}' may use (${allowed}). See docs/map.md.")
      endif()
    endforeach()
  endforeach()
endfunction()

function(dynamic_icp_room room)
  cmake_parse_arguments(ROOM "" "" "DEPENDS;SOURCES;HEADERS;TESTS;LINKS;TEST_DEPENDS" ${ARGN})
  set(allowed ${room})
  foreach(other IN LISTS ROOM_DEPENDS)
    get_property(reached GLOBAL PROPERTY DYNAMIC_ICP_ROOM_${other})
    list(APPEND allowed ${other} ${reached})
  endforeach()
  list(REMOVE_DUPLICATES allowed)
  set_property(GLOBAL PROPERTY DYNAMIC_ICP_ROOM_${room} ${allowed})
  set_property(GLOBAL APPEND PROPERTY DYNAMIC_ICP_ROOMS ${room})
  dynamic_icp_check_includes(${room} "${allowed}" ${ROOM_SOURCES} ${ROOM_HEADERS})

  set(target dynamic_icp_${room})
  add_library(${target} STATIC ${ROOM_SOURCES})
  add_library(dynamic_icp::${room} ALIAS ${target})
  set_target_properties(${target} PROPERTIES EXPORT_NAME ${room})
  target_include_directories(${target} PUBLIC
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_link_libraries(${target} PUBLIC Eigen3::Eigen PRIVATE $<BUILD_INTERFACE:dynamic_icp_build_flags> ${ROOM_LINKS})
  foreach(other IN LISTS ROOM_DEPENDS)
    target_link_libraries(${target} PUBLIC dynamic_icp_${other})
  endforeach()
  install(TARGETS ${target} EXPORT dynamic_icp_targets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(FILES ${ROOM_HEADERS} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/dynamic_icp/${room})

  if(DYNAMIC_ICP_BUILD_TESTS AND ROOM_TESTS)
    add_executable(${target}_test ${ROOM_TESTS})
    target_link_libraries(${target}_test PRIVATE ${target} dynamic_icp_build_flags ${ROOM_LINKS} GTest::gtest_main)
    foreach(other IN LISTS ROOM_TEST_DEPENDS)
      target_link_libraries(${target}_test PRIVATE dynamic_icp_${other})
    endforeach()
    # Tests are built once and run once: time spent optimising them is lost.
    target_compile_options(${target}_test PRIVATE -O1)
    gtest_discover_tests(${target}_test TEST_PREFIX ${room}. DISCOVERY_TIMEOUT 60)
  endif()
endfunction()
