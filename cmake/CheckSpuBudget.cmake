# Run after a kernel is linked: refuses an image that passes its declared budget, by name and by how much. With the linker and the
# objects of an executable for the SPU, it also refuses one that takes more stack than is declared.
execute_process(COMMAND ${NM} ${IMAGE} OUTPUT_VARIABLE symbols RESULT_VARIABLE failed)
if(failed OR NOT symbols MATCHES "([0-9a-f]+) [A-Za-z] _end\n")
  message(FATAL_ERROR "kernel ${KERNEL}: ${IMAGE} has no symbol _end; it was not linked with ls.ld")
endif()
math(EXPR total "0x${CMAKE_MATCH_1} - ${BEGIN} + ${STACK_BYTES}")
if(total GREATER BUDGET_BYTES)
  math(EXPR excess "${total} - ${BUDGET_BYTES}")
  file(REMOVE ${IMAGE})
  message(FATAL_ERROR "kernel ${KERNEL}: ${excess} bytes over its budget: image and stack take ${total} of ${BUDGET_BYTES} bytes")
endif()

if(NOT SPU_LINKER)
  return()
endif()
# The linker follows calls, and lists each function that nobody calls. Those are main and what is called by pointers only: with one
# of each at a time the stack is at most their sum. 32 bytes are the frame that main returns to.
execute_process(COMMAND ${SPU_LINKER} --stack-analysis -e main --defsym abort=0 ${OBJECTS} -o ${IMAGE}.analysed
  OUTPUT_VARIABLE analysis ERROR_VARIABLE analysis_errors RESULT_VARIABLE failed)
file(REMOVE ${IMAGE}.analysed)
string(REGEX MATCHALL ": 0x[0-9a-f]+\n" roots "${analysis}")
if(failed OR NOT roots)
  message(FATAL_ERROR "kernel ${KERNEL}: the SPU's linker did not tell how much stack it takes: ${analysis_errors}")
endif()
set(stack 32)
foreach(root IN LISTS roots)
  string(REGEX MATCH "0x[0-9a-f]+" bytes "${root}")
  math(EXPR stack "${stack} + ${bytes}")
endforeach()
if(stack GREATER STACK_BYTES)
  file(REMOVE ${IMAGE})
  message(FATAL_ERROR "kernel ${KERNEL}: its stack takes up to ${stack} bytes on the SPU, and STACK_BYTES declares ${STACK_BYTES}")
endif()
