# softcell_add_spu_kernel(<name> SOURCES <file>... STACK_BYTES <n> BUDGET_BYTES <n> [INCLUDES <folder>...] [RESIDENT_AT <address>] [UNCHECKED_ONLY])
#
# Builds one SPU kernel for the host: freestanding objects, linked on their own at local-store address 0 into
# <binary dir>/<name>.spu.elf. The build fails when the image leaves no room for its stack, holds a relocation, or passes its
# budget (image and stack together). Target <name>_image depends on the file; its property SOFTCELL_IMAGE is the path.
# The same sources make the checked flavour, <name>.checked.spu.elf (target <name>_checked_image), which reports every load and store to
# the emulator. It is larger: all of the local store is its budget. UNCHECKED_ONLY leaves it out, for a kernel that then does not fit.
# RESIDENT_AT links the image at that local-store address, with its stack below it, for a kernel that calls others: theirs lie at the
# bottom as ever.
# Each source is also checked against the declarations of a real SPU compiler, as the test spu_syntax.<name>.<file>.

# Seen by every folder of a project that softcell is a part of, where the functions below are called: hence in the cache.
set(SOFTCELL_SDK_DIR ${CMAKE_CURRENT_LIST_DIR}/../spu_kernels/sdk CACHE INTERNAL "")
# GNU ld: the link script is written for it.
find_program(SOFTCELL_KERNEL_LINKER ld.bfd REQUIRED)
set(SOFTCELL_CHECK_BUDGET ${CMAKE_CURRENT_LIST_DIR}/CheckSpuBudget.cmake CACHE INTERNAL "")

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
  -Wall -Wextra -Wshadow -Werror -Wno-unknown-warning-option
  CACHE INTERNAL "")

# How a source is checked against the declarations of a real SPU compiler, sdk/check, with either of the host's compilers.
set(SOFTCELL_SPU_CHECK_FLAGS
  -std=c++17 -ffreestanding -fno-exceptions -fno-rtti -fsyntax-only -Wall -Wextra -Werror
  # The SPU's data model: 32-bit pointers and long, 64-bit numbers aligned to eight, unsigned char. (x32 has it; no library is needed.)
  -mx32 -funsigned-char -D__SPU__
  # As an SPU g++ has it, and clang++ has not: vectors change their type by casts only.
  -fno-lax-vector-conversions
  # stdint.h and stddef.h come from sdk/check; a local store has no other library.
  -nostdinc -I ${SOFTCELL_SDK_DIR}/check -I ${SOFTCELL_SDK_DIR}/..
  CACHE INTERNAL "")

# What the checked flavour is compiled with: a call before each load and store, to spu_kernels/sdk/checked. Why which compiler gets
# which is written there.
set(SOFTCELL_CHECKED_FLAGS
  -DSOFTCELL_CHECKED  # a kernel that fills the local store has to make do with less of it then
  "$<$<CXX_COMPILER_ID:GNU>:-fsanitize=thread;SHELL:--param tsan-instrument-func-entry-exit=0>"
  "$<$<CXX_COMPILER_ID:Clang>:-fsanitize=kernel-address>"
  "$<$<CXX_COMPILER_ID:Clang>:SHELL:-mllvm -asan-instrumentation-with-call-threshold=0 -mllvm -asan-opt=0>"
  "$<$<CXX_COMPILER_ID:Clang>:SHELL:-mllvm -asan-stack=0 -mllvm -asan-globals=0>"
  CACHE INTERNAL "")
# What its reports and spilled registers take of the stack, in bytes, on top of what the kernel declares.
set(SOFTCELL_CHECKED_STACK_BYTES 1024 CACHE INTERNAL "")

# The objects of one flavour of a kernel.
function(softcell_compile_spu_sources target)
  cmake_parse_arguments(arg "" "" "SOURCES;INCLUDES;OPTIONS" ${ARGN})
  add_library(${target} OBJECT ${arg_SOURCES})
  # The project's own flags come first on the command line; these win over them.
  target_compile_options(${target} PRIVATE
    -U_FORTIFY_SOURCE ${SOFTCELL_KERNEL_FLAGS}
    # No gcse: it spills more than it saves here, and a real SPU g++ 9 needs to go without it too (it miscompiles). No scev-cprop: a
    # pointer that a short loop has moved on is not to be calculated again behind it.
    "$<$<CXX_COMPILER_ID:GNU>:-fno-tree-loop-distribute-patterns;-fno-gcse;-fno-tree-scev-cprop>"
    "SHELL:-include ${SOFTCELL_SDK_DIR}/host/softcell_entry.h" ${arg_OPTIONS})
  set_target_properties(${target} PROPERTIES CXX_STANDARD 17)  # CMake's own option goes last
  target_include_directories(${target} PRIVATE ${SOFTCELL_SDK_DIR}/host ${SOFTCELL_SDK_DIR}/.. ${arg_INCLUDES})
endfunction()

# Links objects into an image and holds it against its budget.
function(softcell_link_spu_image name)
  cmake_parse_arguments(arg "" "IMAGE;CHECKED;STACK_BYTES;BUDGET_BYTES;RESIDENT_AT" "OBJECTS" ${ARGN})
  set(image_begin 0x80)
  set(begin 0)  # of what counts for the budget: the environment does
  if(arg_RESIDENT_AT)
    set(image_begin ${arg_RESIDENT_AT})
    set(begin ${arg_RESIDENT_AT})
  endif()
  list(TRANSFORM arg_OBJECTS REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE objects)
  add_custom_command(OUTPUT ${arg_IMAGE}
    COMMAND ${SOFTCELL_KERNEL_LINKER} -pie --no-dynamic-linker -T ${SOFTCELL_SDK_DIR}/ls.ld
      --defsym softcell_stack_bytes=${arg_STACK_BYTES} --defsym softcell_budget_bytes=${arg_BUDGET_BYTES}
      --defsym softcell_is_checked=${arg_CHECKED} --defsym softcell_image_begin=${image_begin}
      --emit-relocs --build-id=none -z noexecstack --no-warn-rwx-segments -z max-page-size=128
      ${objects} -o ${arg_IMAGE}
    COMMAND ${CMAKE_COMMAND} -DNM=${CMAKE_NM} -DIMAGE=${arg_IMAGE} -DKERNEL=${name} -DBEGIN=${begin}
      -DSTACK_BYTES=${arg_STACK_BYTES} -DBUDGET_BYTES=${arg_BUDGET_BYTES} -P ${SOFTCELL_CHECK_BUDGET}
    DEPENDS ${arg_OBJECTS} ${objects} ${SOFTCELL_SDK_DIR}/ls.ld ${SOFTCELL_CHECK_BUDGET}
    COMMAND_EXPAND_LISTS VERBATIM
    COMMENT "Linking local-store image ${name}")
endfunction()

function(softcell_add_spu_kernel name)
  cmake_parse_arguments(arg "UNCHECKED_ONLY" "STACK_BYTES;BUDGET_BYTES;RESIDENT_AT" "SOURCES;INCLUDES" ${ARGN})
  foreach(required STACK_BYTES BUDGET_BYTES SOURCES)
    if(NOT arg_${required})
      message(FATAL_ERROR "softcell_add_spu_kernel(${name}): ${required} is missing")
    endif()
  endforeach()
  set(image ${CMAKE_CURRENT_BINARY_DIR}/${name}.spu.elf)
  softcell_compile_spu_sources(${name}_objects SOURCES ${arg_SOURCES} INCLUDES ${arg_INCLUDES})
  softcell_link_spu_image(${name} IMAGE ${image} CHECKED 0 OBJECTS ${name}_objects
    STACK_BYTES ${arg_STACK_BYTES} BUDGET_BYTES ${arg_BUDGET_BYTES} RESIDENT_AT ${arg_RESIDENT_AT})
  add_custom_target(${name}_image ALL DEPENDS ${image})
  set_target_properties(${name}_image PROPERTIES SOFTCELL_IMAGE ${image})

  if(NOT arg_UNCHECKED_ONLY)
    if(NOT TARGET softcell_report_accesses)
      softcell_compile_spu_sources(softcell_report_accesses SOURCES ${SOFTCELL_SDK_DIR}/checked/report_accesses.cpp)
    endif()
    set(checked_image ${CMAKE_CURRENT_BINARY_DIR}/${name}.checked.spu.elf)
    softcell_compile_spu_sources(${name}_checked_objects SOURCES ${arg_SOURCES} INCLUDES ${arg_INCLUDES}
      OPTIONS ${SOFTCELL_CHECKED_FLAGS})
    math(EXPR checked_stack "${arg_STACK_BYTES} + ${SOFTCELL_CHECKED_STACK_BYTES}")
    softcell_link_spu_image(${name}_checked IMAGE ${checked_image} CHECKED 1
      OBJECTS ${name}_checked_objects softcell_report_accesses STACK_BYTES ${checked_stack} BUDGET_BYTES 262144
      RESIDENT_AT ${arg_RESIDENT_AT})
    add_custom_target(${name}_checked_image ALL DEPENDS ${checked_image})
    set_target_properties(${name}_checked_image PROPERTIES SOFTCELL_IMAGE ${checked_image})
  endif()

  foreach(source IN LISTS arg_SOURCES)
    cmake_path(ABSOLUTE_PATH source)
    cmake_path(GET source STEM stem)
    list(TRANSFORM arg_INCLUDES PREPEND -I OUTPUT_VARIABLE include_options)
    add_test(NAME spu_syntax.${name}.${stem}
      COMMAND ${CMAKE_CXX_COMPILER} ${SOFTCELL_SPU_CHECK_FLAGS} ${include_options} ${source})
    set_tests_properties(spu_syntax.${name}.${stem} PROPERTIES LABELS kernel)
  endforeach()
endfunction()

# softcell_embed_spu_images(<library> <kernel>...)
# Puts the images into a static library as read-only data: extern "C" const unsigned char softcell_image_<kernel>[] and
# softcell_image_<kernel>_end[]; their checked flavours likewise, as softcell_image_<kernel>_checked.
function(softcell_embed_spu_images library)
  foreach(kernel IN LISTS ARGN)
    softcell_embed_spu_image(${library} ${kernel})
    if(TARGET ${kernel}_checked_image)
      softcell_embed_spu_image(${library} ${kernel}_checked)
    endif()
  endforeach()
endfunction()

function(softcell_embed_spu_image library kernel)
  get_target_property(image ${kernel}_image SOFTCELL_IMAGE)
  set(stub ${CMAKE_CURRENT_BINARY_DIR}/${kernel}.embed.S)
  file(CONFIGURE OUTPUT ${stub} @ONLY CONTENT [[
.section .rodata
.balign 64
.global softcell_image_@kernel@, softcell_image_@kernel@_end
softcell_image_@kernel@:
.incbin "@image@"
softcell_image_@kernel@_end:
.section .note.GNU-stack,"",%progbits
]])
  target_sources(${library} PRIVATE ${stub})
  set_source_files_properties(${stub} PROPERTIES OBJECT_DEPENDS ${image})
endfunction()
