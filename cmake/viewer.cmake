# The viewer of report pages: viewer/ bundled by esbuild into a C++ source. Nothing is downloaded here: `npm ci` in viewer/
# (scripts/install_viewer.sh) is what makes the bundle possible. Without it reports have no interactive view.
set(DYNAMIC_ICP_VIEWER AUTO CACHE STRING "Viewer in reports: ON, OFF, or AUTO (where node and viewer/node_modules are there)")
set_property(CACHE DYNAMIC_ICP_VIEWER PROPERTY STRINGS AUTO ON OFF)

# Sets OUT_VAR to the source that defines dynamic_icp::report::viewer_bundle(), for target_sources of a target of the same
# CMakeLists.txt.
function(dynamic_icp_viewer_source OUT_VAR)
  set(folder ${PROJECT_SOURCE_DIR}/viewer)
  set(${OUT_VAR} ${PROJECT_SOURCE_DIR}/dynamic_icp/tools/report/viewer_bundle_missing.cpp PARENT_SCOPE)
  if(NOT DYNAMIC_ICP_VIEWER)
    message(STATUS "Viewer of reports: left out (DYNAMIC_ICP_VIEWER=OFF)")
    return()
  endif()

  if(EXISTS ${folder}/viewer_bundle.cpp)  # archives of the sources bring it along (scripts/packages.sh)
    message(STATUS "Viewer of reports: ${folder}/viewer_bundle.cpp")
    set(${OUT_VAR} ${folder}/viewer_bundle.cpp PARENT_SCOPE)
    return()
  endif()

  find_program(DYNAMIC_ICP_NODE NAMES node nodejs)
  set(missing)
  if(NOT DYNAMIC_ICP_NODE)
    set(missing "node is not installed")
  elseif(NOT EXISTS ${folder}/node_modules/esbuild/package.json OR NOT EXISTS ${folder}/node_modules/three/package.json)
    set(missing "viewer/node_modules is not there")
  endif()
  if(missing AND DYNAMIC_ICP_VIEWER STREQUAL "AUTO")
    message(STATUS "Viewer of reports: left out, ${missing} (scripts/install_viewer.sh)")
    return()
  elseif(missing)
    message(FATAL_ERROR "DYNAMIC_ICP_VIEWER=${DYNAMIC_ICP_VIEWER}, but ${missing}: run scripts/install_viewer.sh")
  endif()

  file(GLOB_RECURSE parts CONFIGURE_DEPENDS ${folder}/src/*.js ${folder}/src/*.css)
  set(source ${CMAKE_CURRENT_BINARY_DIR}/viewer_bundle.cpp)
  add_custom_command(OUTPUT ${source}
    COMMAND ${DYNAMIC_ICP_NODE} ${folder}/build.mjs --cpp ${source}
    DEPENDS ${parts} ${folder}/build.mjs ${folder}/cpp_source.mjs ${folder}/package-lock.json
    COMMENT "Bundling the viewer of reports" VERBATIM)
  message(STATUS "Viewer of reports: ${DYNAMIC_ICP_NODE}")
  set(${OUT_VAR} ${source} PARENT_SCOPE)
endfunction()
