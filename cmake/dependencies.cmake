# Everything the build uses comes from the distribution's packages; nothing is downloaded here. The method needs Eigen and
# fmt; what only the readers or the program need is not looked for without them.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
if(DYNAMIC_ICP_BUILD_APPS OR DYNAMIC_ICP_BUILD_PYTHON OR DYNAMIC_ICP_BUILD_TESTS OR DYNAMIC_ICP_BUILD_BENCHMARKS OR DYNAMIC_ICP_BUILD_FUZZERS)
  set(DYNAMIC_ICP_NEEDS_TOOLS ON)
endif()

if(DYNAMIC_ICP_BUILD_IO OR DYNAMIC_ICP_NEEDS_TOOLS)
  find_package(nlohmann_json 3.9 REQUIRED)
  find_package(yaml-cpp REQUIRED)
  # Older yaml-cpp packages export a plain target name.
  if(NOT TARGET yaml-cpp::yaml-cpp)
    add_library(yaml-cpp::yaml-cpp ALIAS yaml-cpp)
  endif()
  # Not by find_package: the CMake files of the distributions' libzip ask for its command line tools, which are packages
  # of their own.
  if(NOT TARGET libzip::zip)
    find_path(DYNAMIC_ICP_LIBZIP_INCLUDE_DIR zip.h REQUIRED)
    find_library(DYNAMIC_ICP_LIBZIP_LIBRARY zip REQUIRED)
    add_library(libzip::zip UNKNOWN IMPORTED GLOBAL)
    set_target_properties(libzip::zip PROPERTIES IMPORTED_LOCATION ${DYNAMIC_ICP_LIBZIP_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES ${DYNAMIC_ICP_LIBZIP_INCLUDE_DIR})
  endif()
  # Without CMake files in older distributions; the header lies in a folder of its own or not.
  if(NOT TARGET liblzf::lzf)
    find_path(DYNAMIC_ICP_LIBLZF_INCLUDE_DIR lzf.h PATH_SUFFIXES liblzf REQUIRED)
    find_library(DYNAMIC_ICP_LIBLZF_LIBRARY lzf REQUIRED)
    add_library(liblzf::lzf UNKNOWN IMPORTED GLOBAL)
    set_target_properties(liblzf::lzf PROPERTIES IMPORTED_LOCATION ${DYNAMIC_ICP_LIBLZF_LIBRARY}
      INTERFACE_INCLUDE_DIRECTORIES ${DYNAMIC_ICP_LIBLZF_INCLUDE_DIR})
  endif()
  find_package(ZLIB REQUIRED)
  # What bags are packed with, and what ROS 2 keeps them in. libzstd, liblz4 and libbz2 come without CMake files.
  find_package(SQLite3 REQUIRED)
  set(libraries zstd lz4 bz2)
  set(headers zstd.h lz4frame.h bzlib.h)
  foreach(library header IN ZIP_LISTS libraries headers)
    if(NOT TARGET dynamic_icp::${library})
      string(TOUPPER ${library} name)
      find_path(DYNAMIC_ICP_${name}_INCLUDE_DIR ${header} REQUIRED)
      find_library(DYNAMIC_ICP_${name}_LIBRARY ${library} REQUIRED)
      add_library(dynamic_icp::${library} UNKNOWN IMPORTED GLOBAL)
      set_target_properties(dynamic_icp::${library} PROPERTIES IMPORTED_LOCATION ${DYNAMIC_ICP_${name}_LIBRARY}
        INTERFACE_INCLUDE_DIRECTORIES ${DYNAMIC_ICP_${name}_INCLUDE_DIR})
    endif()
  endforeach()
endif()

if(DYNAMIC_ICP_NEEDS_TOOLS)
  find_package(PNG REQUIRED)
  # Embree 3 (Debian 12, Ubuntu 22.04) and Embree 4 (newer) differ in the name of their package and header.
  find_package(embree 4 QUIET)
  if(embree_FOUND)
    set(DYNAMIC_ICP_EMBREE_VERSION 4)
  else()
    find_package(embree 3 REQUIRED)
    set(DYNAMIC_ICP_EMBREE_VERSION 3)
  endif()
endif()
if(DYNAMIC_ICP_BUILD_APPS)
  find_package(CLI11 REQUIRED)
endif()
if(DYNAMIC_ICP_BUILD_TESTS)
  find_package(GTest REQUIRED)
  find_package(rapidcheck QUIET)
endif()
