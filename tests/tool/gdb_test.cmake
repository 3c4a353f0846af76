# As docs/guide/running-kernels.md says it: gdb stops in a kernel that runs from the local stores of two SPEs.
if(NOT EXISTS "${GDB}")
  message("skipped: gdb is not installed")
  return()
endif()

# The line where a block has arrived and is about to be computed.
file(STRINGS ${SOURCE} lines)
set(line 0)
set(number 0)
foreach(text IN LISTS lines)
  math(EXPR number "${number} + 1")
  if(text MATCHES "^ +compute\\(")
    set(line ${number})
  endif()
endforeach()
if(line EQUAL 0)
  message(FATAL_ERROR "${SOURCE} has no line that calls compute()")
endif()

# 64 bytes are 16 floats.
file(MAKE_DIRECTORY ${SCRATCH})
string(REPEAT "0123456789ABCDEF" 4 bytes)
file(WRITE ${SCRATCH}/x.bin "${bytes}")

execute_process(
  COMMAND ${GDB} -nx -batch -iex "set debuginfod enabled off" -iex "set breakpoint pending on"
    -ex "break saxpy.cpp:${line}" -ex run -ex "print job.count" -ex backtrace -ex delete -ex continue
    --args ${SOFTCELL} spu run ${IMAGE} --spes 2 --deadline 3600 --in x=${SCRATCH}/x.bin --out y=${SCRATCH}/y.bin:64
      --arg f32:2 @x @y 16 2 0
  OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE status)
if(output MATCHES "ptrace: Operation not permitted|Could not trace the inferior")
  message("skipped: this machine does not let gdb trace a process")
  return()
endif()

# The breakpoint, a variable, the kernel's frames unwound from its own stack, and the end of the run.
foreach(expected "hit Breakpoint 1" "\\$1 = 16" "main \\(spe=[^\n]*saxpy.cpp:${line}" "exited normally")
  if(NOT output MATCHES "${expected}")
    message(FATAL_ERROR "gdb did not show \"${expected}\":\n${output}")
  endif()
endforeach()
if(output MATCHES "warning: Loadable section")
  message(FATAL_ERROR "gdb is not content with the symbols:\n${output}")
endif()
