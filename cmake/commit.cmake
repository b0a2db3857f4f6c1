# Writes the source that says which commit a program was built from; run at every build, and touched only where that
# changed, so that a commit costs one small source and a link. The same sources give the same bytes.
#   cmake -DSOURCES=FOLDER -DOUTPUT=FILE.cpp -P commit.cmake
cmake_minimum_required(VERSION 3.22)
file(STRINGS ${SOURCES}/cmake/archived_commit.txt commit LIMIT_COUNT 1)  # filled in by `git archive`
if(commit MATCHES "Format")
  set(commit "")
endif()
# Sources without .git may lie in the repository of somebody else.
if(NOT commit AND EXISTS ${SOURCES}/.git)
  execute_process(COMMAND git -C ${SOURCES} describe --always --exclude=* --abbrev=12 --dirty=+
    OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
string(REGEX MATCH "^[0-9a-f]+\\+?" commit "${commit}")
string(REGEX REPLACE "^(............)[0-9a-f]*" "\\1" commit "${commit}")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "#include \"apps/build_info.hpp\"

std::string_view dynamic_icp::apps::commit() { return \"@commit@\"; }
" @ONLY)
