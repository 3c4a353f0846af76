# Installs the build tree, then builds and tests examples/saxpy with nothing but what was installed.

# step(<what it is for> <command>...): the command succeeds, or this test fails with its output.
function(step purpose)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${purpose} failed (${status}):\n${output}")
  endif()
endfunction()

set(prefix ${SCRATCH}/prefix)
set(copy ${SCRATCH}/saxpy)
set(build ${SCRATCH}/build)
file(REMOVE_RECURSE ${SCRATCH})
file(COPY ${EXAMPLE} DESTINATION ${SCRATCH})  # away from our source tree, so that nothing of it is found by chance

step("cmake --install" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
step("configuring the example" ${CMAKE_COMMAND} -S ${copy} -B ${build} -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${prefix}
  -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=${BUILD_TYPE})
step("building the example" ${CMAKE_COMMAND} --build ${build} --parallel 2)
step("testing the example" ${CMAKE_CTEST_COMMAND} --test-dir ${build} --output-on-failure)
step("the installed command" ${prefix}/bin/softcell --version)

# The installed files name no file of the source tree.
file(GLOB_RECURSE package ${prefix}/lib/cmake/*.cmake ${prefix}/share/*.cmake)
cmake_path(GET EXAMPLE PARENT_PATH examples)
cmake_path(GET examples PARENT_PATH source)
foreach(file IN LISTS package)
  file(READ ${file} text)
  string(FIND "${text}" "${source}/" found)
  if(NOT found EQUAL -1)
    message(FATAL_ERROR "${file} refers to the source tree ${source}")
  endif()
endforeach()
