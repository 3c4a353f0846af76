# How SPU kernels are compiled for the host. The functions of SoftcellSpuKernel.cmake include this file themselves: a project that has
# softcell as a subproject sees its functions, but no variables of its folders.

set(SOFTCELL_SDK_DIR ${CMAKE_CURRENT_LIST_DIR}/../spu_kernels/sdk)
set(SOFTCELL_CHECK_BUDGET ${CMAKE_CURRENT_LIST_DIR}/CheckSpuBudget.cmake)

set(SOFTCELL_KERNEL_FLAGS
  -std=c++17 -ffreestanding -fno-exceptions -fno-rtti -fPIE -fvisibility=hidden -fno-stack-protector
  # Kernels are optimised in every configuration: their budgets and their bits do not depend on it.
  -O2 -g -mavx2 -mfma
  # SPU arithmetic truncates at run time, so nothing may be folded in another mode or fused unasked.
  -frounding-math -fno-trapping-math -ffp-contract=off
  # How to unwind goes to the debugger only: ls.ld leaves .eh_frame out of the image.
  -fno-asynchronous-unwind-tables
  # The stack is measured in bytes below the stack pointer; SPU code has no red zone to rely on.
  -mno-red-zone -fomit-frame-pointer
  # No loops turned into calls of memcpy or memset: there is no C library in a local store.
  -fno-builtin
  -Wall -Wextra -Wshadow -Wno-unknown-warning-option)

# How a source is checked against the declarations of a real SPU compiler, sdk/check, with either of the host's compilers.
set(SOFTCELL_SPU_CHECK_FLAGS
  -std=c++17 -ffreestanding -fno-exceptions -fno-rtti -fsyntax-only -Wall -Wextra -Werror
  # The SPU's data model: 32-bit pointers and long, 64-bit numbers aligned to eight, unsigned char. (x32 has it; no library is needed.)
  -mx32 -funsigned-char -D__SPU__
  # As an SPU g++ has it, and clang++ has not: vectors change their type by casts only.
  -fno-lax-vector-conversions
  # stdint.h and stddef.h come from sdk/check; a local store has no other library.
  -nostdinc -I ${SOFTCELL_SDK_DIR}/check -I ${SOFTCELL_SDK_DIR}/..)

# What the checked flavour is compiled with: a call before each load and store, to spu_kernels/sdk/checked. Why which compiler gets
# which is written there.
set(SOFTCELL_CHECKED_FLAGS
  -DSOFTCELL_CHECKED  # a kernel that fills the local store has to make do with less of it then
  "$<$<CXX_COMPILER_ID:GNU>:-fsanitize=thread;SHELL:--param tsan-instrument-func-entry-exit=0>"
  "$<$<CXX_COMPILER_ID:Clang>:-fsanitize=kernel-address>"
  "$<$<CXX_COMPILER_ID:Clang>:SHELL:-mllvm -asan-instrumentation-with-call-threshold=0 -mllvm -asan-opt=0>"
  "$<$<CXX_COMPILER_ID:Clang>:SHELL:-mllvm -asan-stack=0 -mllvm -asan-globals=0>")
# What its reports and spilled registers take of the stack, in bytes, on top of what the kernel declares.
set(SOFTCELL_CHECKED_STACK_BYTES 1024)
