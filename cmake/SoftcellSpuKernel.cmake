# softcell_add_spu_kernel(<name> SOURCES <file>... STACK_BYTES <n> BUDGET_BYTES <n> [INCLUDES <folder>...] [RESIDENT_AT <address>]
#                         [UNCHECKED_ONLY] [WARNINGS_AS_ERRORS])
#
# Builds one SPU kernel for the host: freestanding objects, linked on their own at local-store address 0 into
# <binary dir>/<name>.spu.elf. The build fails when the image leaves no room for its stack, holds a relocation, or passes its
# budget (image and stack together). Target <name>_image depends on the file; its property SOFTCELL_IMAGE is the path.
# The same sources make the checked flavour, <name>.checked.spu.elf (target <name>_checked_image), which reports every load and store to
# the emulator. It is larger: all of the local store is its budget. UNCHECKED_ONLY leaves it out, for a kernel that then does not fit.
# RESIDENT_AT links the image at that local-store address, with its stack below it, for a kernel that calls others: theirs lie at the
# bottom as ever.
# The compiler's warnings are errors with WARNINGS_AS_ERRORS only.
# Each source is also checked against the declarations of a real SPU compiler, as the test spu_syntax.<name>.<file>, unless the
# variable SOFTCELL_KERNEL_TESTS is OFF.

# GNU ld: the link script is written for it.
find_program(SOFTCELL_KERNEL_LINKER ld.bfd)
if(NOT SOFTCELL_KERNEL_LINKER)
  message(FATAL_ERROR "softcell: GNU ld (ld.bfd), which links SPU kernels, was not found; on Debian it is in the package binutils.")
endif()

# The objects of one flavour of a kernel.
function(softcell_compile_spu_sources target)
  cmake_parse_arguments(arg "WARNINGS_AS_ERRORS" "HEADERS" "SOURCES;INCLUDES;OPTIONS" ${ARGN})
  include(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/SoftcellKernelSettings.cmake)
  if(arg_WARNINGS_AS_ERRORS)
    list(APPEND SOFTCELL_KERNEL_FLAGS -Werror)
  endif()
  add_library(${target} OBJECT ${arg_SOURCES})
  # The project's own flags come first on the command line; these win over them.
  target_compile_options(${target} PRIVATE
    -U_FORTIFY_SOURCE ${SOFTCELL_KERNEL_FLAGS}
    # No gcse: it spills more than it saves here, and a real SPU g++ 9 needs to go without it too (it miscompiles). No scev-cprop: a
    # pointer that a short loop has moved on is not to be calculated again behind it.
    "$<$<CXX_COMPILER_ID:GNU>:-fno-tree-loop-distribute-patterns;-fno-gcse;-fno-tree-scev-cprop>"
    ${arg_OPTIONS})
  set_target_properties(${target} PROPERTIES CXX_STANDARD 17)  # CMake's own option goes last
  target_include_directories(${target} PRIVATE ${SOFTCELL_SDK_DIR}/host ${SOFTCELL_SDK_DIR}/.. ${arg_INCLUDES})
  if(SOFTCELL_PRECOMPILED_HEADERS AND arg_HEADERS)
    target_precompile_headers(${target} REUSE_FROM ${arg_HEADERS})
    target_compile_options(${target} PRIVATE $<$<CXX_COMPILER_ID:GNU>:-fpch-preprocess>)
  else()
    target_compile_options(${target} PRIVATE "SHELL:-include ${SOFTCELL_SDK_DIR}/host/softcell_entry.h")
  endif()
endfunction()

# The SDK's headers, compiled once for all kernels of softcell itself: most kernels of the tests are short. (That each kernel includes
# what it uses is checked by the tests spu_syntax.*, which work without.)
function(softcell_precompile_sdk target)
  if(SOFTCELL_PRECOMPILED_HEADERS AND NOT TARGET ${target})
    set(empty ${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp)
    file(CONFIGURE OUTPUT ${empty} CONTENT "")
    softcell_compile_spu_sources(${target} SOURCES ${empty} OPTIONS ${ARGN})
    target_precompile_headers(${target} PRIVATE
      ${SOFTCELL_SDK_DIR}/host/softcell_entry.h <spu_intrinsics.h> <spu_mfcio.h>)
  endif()
endfunction()

# Links objects into an image and holds it against its budget.
function(softcell_link_spu_image name)
  cmake_parse_arguments(arg "" "IMAGE;CHECKED;STACK_BYTES;BUDGET_BYTES;RESIDENT_AT" "OBJECTS" ${ARGN})
  include(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/SoftcellKernelSettings.cmake)
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
  cmake_parse_arguments(arg "UNCHECKED_ONLY;WARNINGS_AS_ERRORS" "STACK_BYTES;BUDGET_BYTES;RESIDENT_AT" "SOURCES;INCLUDES" ${ARGN})
  include(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/SoftcellKernelSettings.cmake)
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "softcell_add_spu_kernel(${name}): unknown arguments ${arg_UNPARSED_ARGUMENTS}")
  endif()
  foreach(required STACK_BYTES BUDGET_BYTES SOURCES)
    if(NOT arg_${required})
      message(FATAL_ERROR "softcell_add_spu_kernel(${name}): ${required} is missing")
    endif()
  endforeach()
  set(warnings)
  if(arg_WARNINGS_AS_ERRORS OR SOFTCELL_WARNINGS_AS_ERRORS)
    set(warnings WARNINGS_AS_ERRORS)
  endif()
  set(image ${CMAKE_CURRENT_BINARY_DIR}/${name}.spu.elf)
  softcell_precompile_sdk(softcell_kernel_headers)
  softcell_compile_spu_sources(${name}_objects SOURCES ${arg_SOURCES} INCLUDES ${arg_INCLUDES} ${warnings}
    HEADERS softcell_kernel_headers)
  softcell_link_spu_image(${name} IMAGE ${image} CHECKED 0 OBJECTS ${name}_objects
    STACK_BYTES ${arg_STACK_BYTES} BUDGET_BYTES ${arg_BUDGET_BYTES} RESIDENT_AT ${arg_RESIDENT_AT})
  add_custom_target(${name}_image ALL DEPENDS ${image})
  set_target_properties(${name}_image PROPERTIES SOFTCELL_IMAGE ${image})

  if(NOT arg_UNCHECKED_ONLY)
    if(NOT TARGET softcell_report_accesses)
      softcell_compile_spu_sources(softcell_report_accesses SOURCES ${SOFTCELL_SDK_DIR}/checked/report_accesses.cpp)
    endif()
    set(checked_image ${CMAKE_CURRENT_BINARY_DIR}/${name}.checked.spu.elf)
    softcell_precompile_sdk(softcell_checked_kernel_headers ${SOFTCELL_CHECKED_FLAGS})
    softcell_compile_spu_sources(${name}_checked_objects SOURCES ${arg_SOURCES} INCLUDES ${arg_INCLUDES}
      HEADERS softcell_checked_kernel_headers OPTIONS ${SOFTCELL_CHECKED_FLAGS} ${warnings})
    math(EXPR checked_stack "${arg_STACK_BYTES} + ${SOFTCELL_CHECKED_STACK_BYTES}")
    softcell_link_spu_image(${name}_checked IMAGE ${checked_image} CHECKED 1
      OBJECTS ${name}_checked_objects softcell_report_accesses STACK_BYTES ${checked_stack} BUDGET_BYTES 262144
      RESIDENT_AT ${arg_RESIDENT_AT})
    add_custom_target(${name}_checked_image ALL DEPENDS ${checked_image})
    set_target_properties(${name}_checked_image PROPERTIES SOFTCELL_IMAGE ${checked_image})
  endif()

  if(DEFINED SOFTCELL_KERNEL_TESTS AND NOT SOFTCELL_KERNEL_TESTS)
    return()
  endif()
  if(NOT warnings)
    list(APPEND SOFTCELL_SPU_CHECK_FLAGS -Wno-error)
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
  if(NOT DEFINED CMAKE_ASM_COMPILE_OBJECT)  # set in a folder where the language is enabled
    message(FATAL_ERROR
      "softcell_embed_spu_images(${library}): images are embedded by the assembler; enable it, as in project(... LANGUAGES CXX ASM).")
  endif()
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
