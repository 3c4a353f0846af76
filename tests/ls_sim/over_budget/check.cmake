execute_process(COMMAND ${CMAKE_COMMAND} -S ${SOURCE} -B ${BINARY} -G Ninja -DMODULES=${MODULES} -DCMAKE_CXX_COMPILER=${COMPILER}
  RESULT_VARIABLE failed OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(failed)
  message(FATAL_ERROR "the project of the kernels that must be refused could not be configured:\n${output}")
endif()

# Fails unless building the kernel fails with what the pattern describes.
function(expect_refusal kernel pattern)
  execute_process(COMMAND ${CMAKE_COMMAND} --build ${BINARY} --target ${kernel}_image
    RESULT_VARIABLE refused OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT refused)
    message(FATAL_ERROR "kernel ${kernel} was built")
  endif()
  if(NOT output MATCHES "${pattern}")
    message(FATAL_ERROR "the refusal of kernel ${kernel} does not say ${pattern}:\n${output}")
  endif()
endfunction()

expect_refusal(glutton "kernel glutton: [0-9]+ bytes over its")
expect_refusal(resident_glutton "kernel resident_glutton: [0-9]+ bytes over its")
expect_refusal(resident_past_the_end "no room for its declared stack in 256 KB")
