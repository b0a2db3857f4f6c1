# A module is one folder dynamic_icp/<layer>/<module> and one static library dynamic_icp_<module>.
#
#   dynamic_icp_module(preprocess
#     DEPENDS base spatial                 modules whose headers this one may include
#     SOURCES voxel_grid.cpp               header, source and test lie side by side
#     HEADERS voxel_grid.hpp               public: installed
#     TESTS voxel_grid_test.cpp            all tests of a module make one executable
#     LINKS yaml-cpp::yaml-cpp)            libraries used in the sources only
#
# A file that includes the header of a module not named in DEPENDS stops the configuration with a message: the arrows of
# docs/map.md cannot be broken by accident. The layers are ordered: `method` depends on nothing but itself, `recording`
# on `method`, `tools` on both.
set(DYNAMIC_ICP_LAYERS method recording tools)

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
# What makes an error of memory end the program rather than serve an attacker (scripts/check_hardening.sh looks at the
# result). Sanitizers find more, and _FORTIFY_SOURCE needs optimisation.
option(DYNAMIC_ICP_HARDENING "Checked calls of the C library, guarded stacks, tables that cannot be overwritten" OFF)
if(DYNAMIC_ICP_HARDENING AND NOT DYNAMIC_ICP_SANITIZE AND CMAKE_BUILD_TYPE MATCHES "^(Release|RelWithDebInfo)$")
  target_compile_options(dynamic_icp_build_flags INTERFACE -U_FORTIFY_SOURCE -D_FORTIFY_SOURCE=2 -fstack-protector-strong)
  target_link_options(dynamic_icp_build_flags INTERFACE -Wl,-z,relro,-z,now,-z,noexecstack)
endif()
if(DYNAMIC_ICP_SANITIZE)
  target_compile_options(dynamic_icp_build_flags INTERFACE
    -fsanitize=${DYNAMIC_ICP_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  target_link_options(dynamic_icp_build_flags INTERFACE -fsanitize=${DYNAMIC_ICP_SANITIZE})
endif()
if(DYNAMIC_ICP_BUILD_FUZZERS)
  target_compile_options(dynamic_icp_build_flags INTERFACE -fsanitize=fuzzer-no-link)
endif()

# What nearly every source includes is parsed once for the libraries, once for those that write JSON, and once for tests.
set(DYNAMIC_ICP_HEAVY_HEADERS <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <memory> <optional> <span>
  <string> <string_view> <vector> <Eigen/Core> <Eigen/Geometry> <Eigen/Cholesky> <Eigen/Eigenvalues> <fmt/format.h>)
function(dynamic_icp_precompile target like)
  if(NOT DYNAMIC_ICP_PRECOMPILED_HEADERS)
    return()
  endif()
  target_link_libraries(${target} PRIVATE $<BUILD_INTERFACE:fmt::fmt>)  # one set of definitions for all
  if(NOT TARGET ${like})
    file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled/${like}.cpp CONTENT "")  # touched once only
    if(like MATCHES "test")
      add_executable(${like} EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/precompiled/${like}.cpp)
      target_link_libraries(${like} PRIVATE GTest::gtest_main nlohmann_json::nlohmann_json)
      target_compile_options(${like} PRIVATE -O1)
      target_precompile_headers(${like} PRIVATE ${DYNAMIC_ICP_HEAVY_HEADERS} <gtest/gtest.h> <nlohmann/json.hpp>)
    else()
      add_library(${like} STATIC EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/precompiled/${like}.cpp)
      target_precompile_headers(${like} PRIVATE ${DYNAMIC_ICP_HEAVY_HEADERS})
      if(like MATCHES "json")
        target_link_libraries(${like} PRIVATE nlohmann_json::nlohmann_json)
        target_precompile_headers(${like} PRIVATE <nlohmann/json.hpp>)
      endif()
    endif()
    target_compile_features(${like} PUBLIC cxx_std_20)
    target_compile_definitions(${like} PRIVATE EIGEN_MAX_STATIC_ALIGN_BYTES=16)
    target_link_libraries(${like} PRIVATE dynamic_icp_build_flags Eigen3::Eigen fmt::fmt)
  endif()
  target_precompile_headers(${target} REUSE_FROM ${like})
endfunction()

function(dynamic_icp_check_includes layer module allowed)
  list(FIND DYNAMIC_ICP_LAYERS ${layer} level)
  foreach(file IN LISTS ARGN)
    file(STRINGS ${file} includes REGEX "^#include \"dynamic_icp/[a-z_]+/")
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${file})
    foreach(line IN LISTS includes)
      string(REGEX REPLACE "^#include \"dynamic_icp/([a-z_]+)/([a-z_]+)/.*" "\\1" used_layer "${line}")
      string(REGEX REPLACE "^#include \"dynamic_icp/([a-z_]+)/([a-z_]+)/.*" "\\2" used "${line}")
      if(NOT used IN_LIST allowed)
        message(FATAL_ERROR "dynamic_icp/${layer}/${module}/${file} includes from the module '${used}', which is not "
                            "among those that '${module}' names (${allowed}). See docs/map.md.")
      endif()
      list(FIND DYNAMIC_ICP_LAYERS ${used_layer} used_level)
      if(used_level GREATER level)
        message(FATAL_ERROR "dynamic_icp/${layer}/${module}/${file} includes from '${used_layer}', a layer above its "
                            "own. See docs/map.md.")
      endif()
    endforeach()
  endforeach()
endfunction()

function(dynamic_icp_module module)
  cmake_parse_arguments(MODULE "" "" "DEPENDS;SOURCES;HEADERS;TESTS;LINKS;TEST_DEPENDS" ${ARGN})
  get_filename_component(layer_folder ${CMAKE_CURRENT_SOURCE_DIR} DIRECTORY)
  get_filename_component(layer ${layer_folder} NAME)
  set_property(GLOBAL APPEND PROPERTY DYNAMIC_ICP_MODULES_OF_${layer} ${module})
  set_property(GLOBAL PROPERTY DYNAMIC_ICP_DEPENDS_OF_${module} ${MODULE_DEPENDS})
  file(GLOB private_headers CONFIGURE_DEPENDS RELATIVE ${CMAKE_CURRENT_SOURCE_DIR} *.hpp)
  dynamic_icp_check_includes(${layer} ${module} "${module};${MODULE_DEPENDS}" ${MODULE_SOURCES} ${private_headers})
  dynamic_icp_check_includes(${layer} ${module} "${module};${MODULE_DEPENDS};${MODULE_TEST_DEPENDS}" ${MODULE_TESTS})

  set(target dynamic_icp_${module})
  add_library(${target} STATIC ${MODULE_SOURCES})
  target_include_directories(${target} PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_definitions(${target} PUBLIC EIGEN_MAX_STATIC_ALIGN_BYTES=16)  # see base/eigen_layout.hpp
  target_link_libraries(${target} PUBLIC Eigen3::Eigen PRIVATE dynamic_icp_build_flags ${MODULE_LINKS})
  foreach(other IN LISTS MODULE_DEPENDS)
    target_link_libraries(${target} PUBLIC dynamic_icp_${other})
  endforeach()
  if("nlohmann_json::nlohmann_json" IN_LIST MODULE_LINKS)
    dynamic_icp_precompile(${target} dynamic_icp_precompiled_json)
  else()
    dynamic_icp_precompile(${target} dynamic_icp_precompiled)
  endif()
  foreach(header IN LISTS MODULE_HEADERS)
    set_property(GLOBAL APPEND PROPERTY DYNAMIC_ICP_HEADERS_OF_${layer} ${layer}/${module}/${header})
  endforeach()

  if(DYNAMIC_ICP_BUILD_TESTS AND MODULE_TESTS)
    add_executable(${target}_test ${MODULE_TESTS})
    target_link_libraries(${target}_test PRIVATE ${target} dynamic_icp_testing_algebra dynamic_icp_build_flags ${MODULE_LINKS}
      GTest::gtest_main)
    foreach(other IN LISTS MODULE_TEST_DEPENDS)
      target_link_libraries(${target}_test PRIVATE dynamic_icp_${other})
    endforeach()
    # Tests are built once and run once: time spent optimising them is lost.
    target_compile_options(${target}_test PRIVATE -O1)
    dynamic_icp_precompile(${target}_test dynamic_icp_precompiled_test)
    gtest_discover_tests(${target}_test TEST_PREFIX ${module}. DISCOVERY_TIMEOUT 60)
  endif()
endfunction()
