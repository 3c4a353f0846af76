# For tests that are scripts of CMake.

# step(<what it is for> <command>...): the command succeeds, or this test fails with its output.
function(step purpose)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${purpose} failed (${status}):\n${output}")
  endif()
endfunction()

# says(<status> <regular expression> <command>...): the command ends with that status and prints that.
function(says expected_status expected)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL expected_status OR NOT output MATCHES "${expected}")
    message(FATAL_ERROR "expected status ${expected_status} and \"${expected}\" of ${ARGN}, got ${status}:\n${output}")
  endif()
endfunction()
