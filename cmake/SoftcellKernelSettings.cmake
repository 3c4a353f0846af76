# How SPU kernels are compiled for the host. The functions of SoftcellSpuKernel.cmake include this file themselves: a project that has
# softcell as a subproject sees its functions, but no variables of its folders.

set(SOFTCELL_SDK_DIR ${CMAKE_CURRENT_LIST_DIR}/../spu_kernels/sdk)
set(SOFTCELL_CHECK_BUDGET ${CMAKE_CURRENT_LIST_DIR}/CheckSpuBudget.cmake)
set(SOFTCELL_LINK_IMAGE ${CMAKE_CURRENT_LIST_DIR}/link_spu_image.sh)

set(SOFTCELL_KERNEL_FLAGS
  -std=c++17 -ffreestanding -fno-exceptions -fno-rtti -fPIE -fvisibility=hidden -fno-stack-protector
  # Kernels are optimised in every configuration: their budgets and their bits do not depend on it.
  -O2 -g -mavx2 -mfma
  # The SPU's data model: long, size_t and pointers have 32 bits. It is 64-bit code with 32-bit pointers, which an ordinary 64-bit
  # process calls. (_MM_MALLOC_H_INCLUDED: immintrin.h is not to include the host's C library, which has no headers for this data model.)
  -mx32 -D_MM_MALLOC_H_INCLUDED
  # Its char is unsigned, and its long double is a double.
  -funsigned-char -mlong-double-64
  # SPU arithmetic truncates at run time, so nothing may be folded in another mode or fused unasked.
  -frounding-math -fno-trapping-math -ffp-contract=off
  # How to unwind goes to the debugger only: ls.ld leaves .eh_frame out of the image.
  -fno-asynchronous-unwind-tables
  # The stack is measured in bytes below the stack pointer; SPU code has no red zone to rely on.
  -mno-red-zone -fomit-frame-pointer
  # No loops turned into calls of memcpy or memset: there is no C library in a local store.
  -fno-builtin
  -Wall -Wextra -Wshadow -Wno-unused-parameter)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(APPEND SOFTCELL_KERNEL_FLAGS -fno-diagnostics-show-labels)  # a message names the types already
else()
  list(APPEND SOFTCELL_KERNEL_FLAGS -Wno-unknown-warning-option)
endif()

# And the C++ sources of kernels and programs besides. One thread runs in a local store: static variables of functions need no locks.
set(SOFTCELL_KERNEL_CXX_FLAGS -fno-threadsafe-statics)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(APPEND SOFTCELL_KERNEL_CXX_FLAGS
    # Addresses in 64-bit registers take no prefix bytes.
    -maddress-mode=long
    # No gcse: it spills more than it saves here, and a real SPU g++ 9 needs to go without it too (it miscompiles). No scev-cprop: a
    # pointer that a short loop has moved on is not to be calculated again behind it.
    -fno-tree-loop-distribute-patterns -fno-gcse -fno-tree-scev-cprop)
else()
  # Clang has no address mode, and unrolls less to make up for the prefix bytes.
  list(APPEND SOFTCELL_KERNEL_CXX_FLAGS "SHELL:-mllvm -unroll-threshold=100")
endif()

# How the same sources are compiled for the SPU, by GCC 7 to 9.
set(SOFTCELL_SPU_C_FLAGS -std=gnu17 -O2 -g -ffreestanding
  # The arithmetic of the host's build: nothing is fused unasked.
  -ffp-contract=off
  # GCC 9's SPU port has miscompiled conversions between bytes and words with gcse. Loops become no calls of memcpy or memset.
  -fno-gcse -fno-tree-loop-distribute-patterns
  # An address that is made of the one before waits for it in a processor that executes in order (match: 5 % of all cycles).
  -fno-ivopts
  -Wall -Wextra -Wno-unused-parameter)
set(SOFTCELL_SPU_CXX_FLAGS ${SOFTCELL_SPU_C_FLAGS} -fno-exceptions -fno-rtti -fno-threadsafe-statics)
list(REMOVE_ITEM SOFTCELL_SPU_CXX_FLAGS -std=gnu17)
list(PREPEND SOFTCELL_SPU_CXX_FLAGS -std=c++17)

# Programs: other people's sources, in C or C++, with the C library of the local store. What they do not use is left out of the image.
# (The compiler is asked once: a build has hundreds of kernels, each of which reads this file several times.)
get_property(SOFTCELL_COMPILER_HEADERS GLOBAL PROPERTY SOFTCELL_COMPILER_HEADERS)
if(NOT SOFTCELL_COMPILER_HEADERS)
  execute_process(COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=include OUTPUT_VARIABLE SOFTCELL_COMPILER_HEADERS
    OUTPUT_STRIP_TRAILING_WHITESPACE)
  set_property(GLOBAL PROPERTY SOFTCELL_COMPILER_HEADERS ${SOFTCELL_COMPILER_HEADERS})
endif()
set(SOFTCELL_PROGRAM_FLAGS -ffunction-sections -fdata-sections -D__SPU__ -nostdinc
  -isystem${SOFTCELL_SDK_DIR}/library/include -isystem${SOFTCELL_COMPILER_HEADERS}  # joined: CMake drops a second -isystem
  # There is no operating system in a local store, by which portable sources choose.
  -Ulinux -U__linux -U__linux__ -U__gnu_linux__ -Uunix -U__unix -U__unix__
  # There is one thread, whose variables are variables like any other. (The compiler would look for them in memory of the host's thread.)
  -D__thread= -D_Thread_local=
  "-D__ea=_Pragma(\"GCC error \\\"there is no address space __ea here: move bytes of main storage by DMA, with mfc_get() and mfc_put()\\\"\")")
# In C++ the word may stand alone in a function, where it means static.
set(SOFTCELL_PROGRAM_CXX_FLAGS
  "-Dthread_local=_Pragma(\"GCC error \\\"one thread runs in a local store: leave out thread_local, or in a function write static\\\"\")")
# What kernels are compiled with, for programs. GCC's freestanding main is a function like any other, which has to return something
# itself; Clang's other main takes nothing but argc and argv.
set(SOFTCELL_PROGRAM_KERNEL_FLAGS ${SOFTCELL_KERNEL_FLAGS})
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(REMOVE_ITEM SOFTCELL_PROGRAM_KERNEL_FLAGS -ffreestanding)
  list(APPEND SOFTCELL_PROGRAM_CXX_FLAGS -Wno-main)
else()
  list(APPEND SOFTCELL_PROGRAM_CXX_FLAGS -Werror=return-type)
endif()
# Of a C source that softcell_vector_casts has rewritten: lines are those of the source, columns are not.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  set(SOFTCELL_C_REWRITTEN_FLAGS -fno-diagnostics-show-caret)
else()
  set(SOFTCELL_C_REWRITTEN_FLAGS -fno-caret-diagnostics -Wno-unused-command-line-argument)
endif()
set(SOFTCELL_C_FLAGS ${SOFTCELL_KERNEL_FLAGS})
list(REMOVE_ITEM SOFTCELL_C_FLAGS -std=c++17 -fno-exceptions -fno-rtti -fno-builtin -Wextra -Wshadow)
# As the SPU's compilers do it: variables without a value that several sources define are one, as old C has it.
# Likewise their inline functions, of which softcell_vector_casts makes weak ones.
list(APPEND SOFTCELL_C_FLAGS -fcommon -fgnu89-inline)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(REMOVE_ITEM SOFTCELL_C_FLAGS -ffreestanding)  # GCC's main is then no special function, and returns nothing by itself
  list(APPEND SOFTCELL_C_FLAGS -fno-builtin -maddress-mode=long -Wno-main)
  set(SOFTCELL_C_CHECKED_FLAGS -DSOFTCELL_CHECKED -fsanitize=thread --param tsan-instrument-func-entry-exit=0)
else()
  list(APPEND SOFTCELL_C_FLAGS -fno-builtin -Werror=return-type)
  set(SOFTCELL_C_CHECKED_FLAGS -DSOFTCELL_CHECKED -fsanitize=kernel-address -mllvm -asan-instrumentation-with-call-threshold=0
    -mllvm -asan-opt=0 -mllvm -asan-stack=0 -mllvm -asan-globals=0)
endif()

# How a source is checked against the declarations of a real SPU compiler, sdk/check, with either of the host's compilers.
set(SOFTCELL_SPU_CHECK_FLAGS
  -std=c++17 -ffreestanding -fno-exceptions -fno-rtti -fsyntax-only -Wall -Wextra -Werror -Wno-unused-parameter
  # The SPU's data model: 32-bit pointers and long, 64-bit numbers aligned to eight, unsigned char. (x32 has it; no library is needed.)
  -mx32 -funsigned-char -D__SPU__
  # As an SPU g++ has it, and clang++ has not: vectors change their type by casts only.
  -fno-lax-vector-conversions
  # stdint.h and stddef.h come from sdk/check; a local store has no other library.
  -nostdinc -I ${SOFTCELL_SDK_DIR}/check -I ${SOFTCELL_SDK_DIR}/..)

# What checked images are compiled with: a call before each load and store, to spu_kernels/sdk/checked. Why which compiler gets
# which is written there.
set(SOFTCELL_CHECKED_FLAGS -DSOFTCELL_CHECKED)  # a kernel that fills the local store has to make do with less of it then
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  list(APPEND SOFTCELL_CHECKED_FLAGS -fsanitize=thread "SHELL:--param tsan-instrument-func-entry-exit=0")
else()
  list(APPEND SOFTCELL_CHECKED_FLAGS -fsanitize=kernel-address
    "SHELL:-mllvm -asan-instrumentation-with-call-threshold=0 -mllvm -asan-opt=0" "SHELL:-mllvm -asan-stack=0 -mllvm -asan-globals=0")
endif()
# What its reports and spilled registers take of the stack, in bytes, on top of what the kernel declares.
set(SOFTCELL_CHECKED_STACK_BYTES 1024)
