# cpack refuses to make packages where a program is missing that finds out what they depend on, and names the program's package.
find_program(SHLIBDEPS dpkg-shlibdeps REQUIRED)
find_program(FILE file REQUIRED)

# Those programs alone are in PATH.
function(expect_refusal missing_package)
  file(REMOVE_RECURSE ${SCRATCH})
  file(MAKE_DIRECTORY ${SCRATCH}/bin)
  foreach(program IN LISTS ARGN)
    cmake_path(GET program FILENAME name)
    file(CREATE_LINK ${program} ${SCRATCH}/bin/${name} SYMBOLIC)
  endforeach()
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env PATH=${SCRATCH}/bin ${CPACK} -D CMAKE_FIND_USE_CMAKE_SYSTEM_PATH=OFF
      --config ${BUILD}/CPackConfig.cmake -B ${SCRATCH}/packages
    RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  if(status EQUAL 0 OR NOT output MATCHES "was not found; on Debian it is in the package ${missing_package}\\.")
    message(FATAL_ERROR "cpack without the package ${missing_package} ended with status ${status}:\n${output}")
  endif()
  file(GLOB_RECURSE packages ${SCRATCH}/packages/*.deb)
  if(packages)
    message(FATAL_ERROR "cpack without the package ${missing_package} made ${packages}")
  endif()
endfunction()

expect_refusal(dpkg-dev ${FILE})
expect_refusal(file ${SHLIBDEPS})
