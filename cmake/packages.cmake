# Debian packages by `cpack` in the build folder (scripts/packages.sh): dynamic-icp, libdynamic-icp-dev and, where it is
# built, python3-dynamic-icp. Each holds the files of install components.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME dynamic-icp)
set(CPACK_PACKAGE_CONTACT "The Dynamic-ICP developers <developers@dynamic-icp.invalid>" CACHE STRING
    "Maintainer of the packages: who builds them")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "")  # each has its own
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian/documents.cmake)
set(CPACK_DYNAMIC_ICP_SOURCES ${PROJECT_SOURCE_DIR})  # for that script

set(CPACK_COMPONENTS_ALL program)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME dynamic-icp)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_DESCRIPTION "odometry and registration for FMCW LiDAR
Estimates the trajectory of a LiDAR that measures the velocity of every point
by its Doppler, in scenes full of moving objects, from its scans alone. It
reads bags of ROS 1 and ROS 2, MCAP, PCD, PLY, NPZ and the layouts of public
data sets, simulates drives with ground truth, and compares with baselines.")

if(DYNAMIC_ICP_BUILD_IO)
  list(APPEND CPACK_COMPONENTS_ALL core io)
  set(CPACK_COMPONENT_CORE_GROUP dev)
  set(CPACK_COMPONENT_IO_GROUP dev)
  set(CPACK_DEBIAN_DEV_PACKAGE_NAME libdynamic-icp-dev)
  set(CPACK_DEBIAN_DEV_PACKAGE_SECTION libdevel)
  # The libraries are static: who links them needs what they use.
  set(CPACK_DEBIAN_DEV_PACKAGE_DEPENDS "libeigen3-dev (>= 3.4), libfmt-dev, libyaml-cpp-dev, libzip-dev, liblzf-dev, \
libsqlite3-dev, zlib1g-dev, libzstd-dev, liblz4-dev, libbz2-dev")
  set(CPACK_DEBIAN_DEV_DESCRIPTION "odometry and registration for FMCW LiDAR (C++ library)
Headers and static libraries of Dynamic-ICP: the method (dynamic_icp::core) and
the readers of recordings (dynamic_icp::io), found by find_package(dynamic_icp)
of CMake.")
endif()

if(TARGET dynamic_icp_python)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-dynamic-icp)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
  # An extension module is made for one minor version of Python.
  execute_process(COMMAND /usr/bin/python3 -c "import sys; print('python3 (>= 3.{0}), python3 (<< 3.{1})'.format(
    sys.version_info[1], sys.version_info[1] + 1))" OUTPUT_VARIABLE python OUTPUT_STRIP_TRAILING_WHITESPACE)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
    "${python}, python3-numpy, dynamic-icp (= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
  set(CPACK_DEBIAN_PYTHON_DESCRIPTION "odometry and registration for FMCW LiDAR (Python 3)
The module dynamic_icp: odometry, its stages alone, readers of recordings,
evaluation and simulation, with arrays of NumPy in and out.")
endif()

include(CPack)
