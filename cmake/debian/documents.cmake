# What Debian's policy asks of every package beside its files: licence and changes. CPack runs this once all is installed into
# the folders that become packages.
cmake_policy(VERSION 3.22)

# The text of the licence, without its name and copyright, as the format of copyright files has it.
file(READ ${CPACK_DYNAMIC_ICP_SOURCES}/LICENSE licence)
string(REGEX REPLACE ".*\n(Permission is)" "\\1" licence "${licence}")
string(REGEX REPLACE "\n\n" "\n.\n" licence "${licence}")
string(REGEX REPLACE "\n$" "" licence "${licence}")
string(REPLACE "\n" "\n " licence "${licence}")
string(TIMESTAMP date "%a, %d %b %Y %H:%M:%S +0000" UTC)  # of SOURCE_DATE_EPOCH, where it is set

# Whatever the modes of the sources: an archive unpacked by root has those of its maker.
set(mode FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
file(GLOB folders LIST_DIRECTORIES true ${CPACK_TEMPORARY_DIRECTORY}/*)
foreach(folder IN LISTS folders)
  get_filename_component(component ${folder} NAME)
  string(TOUPPER ${component} component)
  set(package ${CPACK_DEBIAN_${component}_PACKAGE_NAME})
  set(documents ${folder}${CPACK_PACKAGING_INSTALL_PREFIX}/share/doc/${package})
  configure_file(${CMAKE_CURRENT_LIST_DIR}/copyright.in ${documents}/copyright @ONLY ${mode})
  configure_file(${CMAKE_CURRENT_LIST_DIR}/changelog.in ${documents}/changelog.Debian @ONLY ${mode})
  configure_file(${CPACK_DYNAMIC_ICP_SOURCES}/CHANGELOG.md ${documents}/changelog COPYONLY ${mode})
  execute_process(COMMAND gzip -9nf ${documents}/changelog ${documents}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
endforeach()
