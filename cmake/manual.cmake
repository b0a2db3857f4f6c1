# Lets the program write its manual and what completes its commands in shells, as they lie below share/. Run when it is installed.
#   cmake -DPROGRAM=FILE -DFOLDER=FOLDER -P manual.cmake
cmake_minimum_required(VERSION 3.22)

function(write_output file)  # then the arguments of the program
  get_filename_component(folder ${FOLDER}/${file} DIRECTORY)
  file(MAKE_DIRECTORY ${folder})
  execute_process(COMMAND ${PROGRAM} ${ARGN} OUTPUT_FILE ${FOLDER}/${file} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${FOLDER})
write_output(man/man1/dynamic-icp.1 manual)
execute_process(COMMAND ${PROGRAM} manual --list OUTPUT_VARIABLE commands COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" commands "${commands}")
foreach(command IN LISTS commands)
  write_output(man/man1/dynamic-icp-${command}.1 manual ${command})
endforeach()
find_program(GZIP gzip)
if(GZIP)
  file(GLOB files ${FOLDER}/man/man1/*.1)
  execute_process(COMMAND ${GZIP} -9n ${files} COMMAND_ERROR_IS_FATAL ANY)
endif()

write_output(bash-completion/completions/dynamic-icp completion bash)
write_output(fish/vendor_completions.d/dynamic-icp.fish completion fish)
write_output(zsh/${ZSH_FOLDER}/_dynamic-icp completion zsh)
