# cmake -DCOMPILE="<compiler>;<option>..." -DSOURCES="<file>;..." -P compile_each.cmake
# Reads each source on its own, without making code; all that do not compile are shown.
set(failed)
foreach(source IN LISTS SOURCES)
  cmake_path(GET source STEM stem)
  execute_process(COMMAND ${COMPILE} -fsyntax-only ${source} RESULT_VARIABLE status ERROR_VARIABLE text)
  if(NOT status EQUAL 0)
    list(APPEND failed ${stem})
    message("${text}")
  endif()
endforeach()
if(failed)
  message(FATAL_ERROR "these do not compile: ${failed}")
endif()
