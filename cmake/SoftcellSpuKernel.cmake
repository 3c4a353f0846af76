# softcell_add_spu_kernel(<name> SOURCES <file>... STACK_BYTES <n> BUDGET_BYTES <n> [INCLUDES <folder>...] [RESIDENT_AT <address>]
#                         [PROGRAM] [OPTIONS <option>...] [UNCHECKED_ONLY] [HOST_ONLY] [WARNINGS_AS_ERRORS])
#
# Builds one SPU kernel for the host: freestanding objects, linked on their own at local-store address 0 into
# <binary dir>/<name>.spu.elf. The build fails when the image leaves no room for its stack, holds a relocation, or passes its
# budget (image and stack together). Target <name>_image depends on the file; its property SOFTCELL_IMAGE is the path.
# The same sources make the checked image, <name>.checked.spu.elf (target <name>_checked_image), which reports every load and store to
# the emulator. It is larger: all of the local store is its budget. UNCHECKED_ONLY leaves it out, for a kernel that then does not fit.
# A PROGRAM is loaded whole and is no job: it may have pointers in its static data, static constructors, exit(), and functions of the C
# library (spu_kernels/sdk/library), of which the image holds what it uses. With a source in C (*.c: GNU C17) it is one anyway. OPTIONS
# are for the compiler, -DNAME=VALUE for example.
# RESIDENT_AT links the image at that local-store address, with its stack below it, for a kernel that calls others: theirs lie at the
# bottom as ever.
# With a compiler for the SPU (SOFTCELL_SPU_CXX, see SoftcellSpuElf.cmake) the same sources also make the executable
# <binary dir>/<name>.elf, for the interpreter and a console, target <name>_spu_elf. Its image and stack are held against the same
# declarations. HOST_ONLY leaves it out. A PROGRAM has none.
# The compiler's warnings are errors with WARNINGS_AS_ERRORS only.
# Each source is also checked against the declarations of a real SPU compiler, as the test spu_syntax.<name>.<file>, unless the
# variable SOFTCELL_KERNEL_TESTS is OFF.

include(${CMAKE_CURRENT_LIST_DIR}/SoftcellSpuElf.cmake)

# GNU ld: the link script is written for it.
find_program(SOFTCELL_KERNEL_LINKER ld.bfd)
if(NOT SOFTCELL_KERNEL_LINKER)
  message(FATAL_ERROR "softcell: GNU ld (ld.bfd), which links SPU kernels, was not found; on Debian it is in the package binutils.")
endif()

# The objects of one build of a kernel.
function(softcell_compile_spu_sources target)
  cmake_parse_arguments(arg "WARNINGS_AS_ERRORS;PROGRAM" "HEADERS" "SOURCES;INCLUDES;OPTIONS" ${ARGN})
  include(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/SoftcellKernelSettings.cmake)
  if(arg_PROGRAM)
    set(SOFTCELL_KERNEL_FLAGS ${SOFTCELL_PROGRAM_KERNEL_FLAGS} ${SOFTCELL_PROGRAM_FLAGS} ${SOFTCELL_PROGRAM_CXX_FLAGS})
  endif()
  if(arg_WARNINGS_AS_ERRORS)
    list(APPEND SOFTCELL_KERNEL_FLAGS -Werror)
  endif()
  add_library(${target} OBJECT ${arg_SOURCES})
  # The project's own flags come first on the command line; these win over them.
  target_compile_options(${target} PRIVATE
    -U_FORTIFY_SOURCE ${SOFTCELL_KERNEL_FLAGS} ${SOFTCELL_KERNEL_CXX_FLAGS} ${arg_OPTIONS})
  set_target_properties(${target} PROPERTIES CXX_STANDARD 17)  # CMake's own option goes last
  # The flags of somebody's project concern its own code, not the SDK.
  set(system SYSTEM)
  if(SOFTCELL_WARNINGS_AS_ERRORS)
    set(system)
  endif()
  target_include_directories(${target} ${system} PRIVATE ${SOFTCELL_SDK_DIR}/host ${SOFTCELL_SDK_DIR}/..)
  target_include_directories(${target} PRIVATE ${arg_INCLUDES})
  if(SOFTCELL_PRECOMPILED_HEADERS AND arg_HEADERS)
    target_precompile_headers(${target} REUSE_FROM ${arg_HEADERS})
    # No compiler cache: it takes as long to find such a kernel as the compiler to make it.
    set_target_properties(${target} PROPERTIES CXX_COMPILER_LAUNCHER "")
  endif()
endfunction()

# softcell_report_objects(<accesses|atomics>...)
# What checked images link besides: softcell_report_accesses and softcell_report_atomics, compiled once.
function(softcell_report_objects)
  foreach(what IN LISTS ARGN)
    if(NOT TARGET softcell_report_${what})
      softcell_compile_spu_sources(softcell_report_${what} SOURCES ${SOFTCELL_SDK_DIR}/checked/report_${what}.cpp)
    endif()
  endforeach()
endfunction()

# The program that gives casts of vectors in C their meaning.
function(softcell_vector_casts_program)
  if(NOT TARGET softcell_vector_casts)
    add_executable(softcell_vector_casts EXCLUDE_FROM_ALL ${SOFTCELL_SDK_DIR}/c/vector_casts.cpp)
    set_target_properties(softcell_vector_casts PROPERTIES CXX_STANDARD 20 CXX_STANDARD_REQUIRED ON)
  endif()
endfunction()

# Compiles one source in C; the object's path goes to <object>. Between the preprocessor and the compiler, casts of vectors get the
# meaning that they have on an SPU.
function(softcell_compile_c_source object name source)
  cmake_parse_arguments(arg "WARNINGS_AS_ERRORS" "" "INCLUDES;OPTIONS" ${ARGN})
  include(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/SoftcellKernelSettings.cmake)
  softcell_vector_casts_program()
  cmake_path(ABSOLUTE_PATH source)
  cmake_path(GET source FILENAME file)
  set(stem ${CMAKE_CURRENT_BINARY_DIR}/${name}.${file})
  softcell_spu_source_options(options "${arg_INCLUDES}" "${arg_OPTIONS}" "${arg_WARNINGS_AS_ERRORS}")
  add_custom_command(OUTPUT ${stem}.o
    COMMAND ${CMAKE_CXX_COMPILER} -x c -std=gnu17 ${SOFTCELL_C_FLAGS} ${SOFTCELL_PROGRAM_FLAGS} -DSOFTCELL_VECTOR_CASTS ${options}
      -Wno-unused-command-line-argument -isystem ${SOFTCELL_SDK_DIR}/host -MD -MF ${stem}.d -MT ${stem}.o -E ${source} -o ${stem}.i
    COMMAND softcell_vector_casts ${stem}.i ${stem}.softcell.i
    COMMAND ${CMAKE_CXX_COMPILER} -x cpp-output -std=gnu17 ${SOFTCELL_C_FLAGS} ${SOFTCELL_PROGRAM_FLAGS} ${options}
      ${SOFTCELL_C_REWRITTEN_FLAGS} -c ${stem}.softcell.i -o ${stem}.o
    COMMAND ${CMAKE_OBJCOPY} --weaken-symbols=${stem}.softcell.i.inline ${stem}.o
    DEPENDS ${source} softcell_vector_casts DEPFILE ${stem}.d
    COMMAND_EXPAND_LISTS VERBATIM
    COMMENT "Compiling C kernel source ${file}")
  set(${object} ${stem}.o PARENT_SCOPE)
endfunction()

# The C library of the local store and what C's intrinsics call, as an archive of which the linker takes what is used.
function(softcell_program_library target)
  if(TARGET ${target})
    return()
  endif()
  include(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/SoftcellKernelSettings.cmake)
  file(GLOB sources CONFIGURE_DEPENDS ${SOFTCELL_SDK_DIR}/library/*.cpp)
  softcell_compile_spu_sources(${target}_objects PROGRAM SOURCES ${sources} ${SOFTCELL_SDK_DIR}/c/c_intrinsics.cpp OPTIONS ${ARGN})
  add_library(${target} STATIC $<TARGET_OBJECTS:${target}_objects>)
  set_target_properties(${target} PROPERTIES LINKER_LANGUAGE CXX)
endfunction()

# The SDK's headers, compiled once for all kernels of softcell itself: most kernels of the tests are short. (That each kernel includes
# what it uses is checked by the tests spu_syntax.*, which work without.)
function(softcell_precompile_sdk target)
  if(SOFTCELL_PRECOMPILED_HEADERS AND NOT TARGET ${target})
    set(empty ${CMAKE_CURRENT_BINARY_DIR}/${target}.cpp)
    file(CONFIGURE OUTPUT ${empty} CONTENT "")
    softcell_compile_spu_sources(${target} SOURCES ${empty} OPTIONS ${ARGN})
    target_precompile_headers(${target} PRIVATE
      <stdint.h> <spu_intrinsics.h> <spu_mfcio.h>)
  endif()
endfunction()

# Links objects into an image and holds it against its budget.
function(softcell_link_spu_image name)
  cmake_parse_arguments(arg "" "IMAGE;CHECKED;STACK_BYTES;BUDGET_BYTES;RESIDENT_AT;LIBRARY" "OBJECTS;OBJECT_FILES" ${ARGN})
  include(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/SoftcellKernelSettings.cmake)
  set(image_begin 0x80)
  set(begin 0)  # of what counts for the budget: the environment does
  if(arg_RESIDENT_AT)
    set(image_begin ${arg_RESIDENT_AT})
    set(begin ${arg_RESIDENT_AT})
  endif()
  # A program begins in its library, which calls main.
  set(program 0)
  set(library)
  set(check_definitions)
  list(TRANSFORM arg_OBJECTS REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>" OUTPUT_VARIABLE objects)
  if(arg_LIBRARY)
    set(program 1)
    # Its functions win over the library's of the same name (muldefs). That it has none twice itself is seen when its objects are linked alone.
    set(check_definitions COMMAND ${SOFTCELL_KERNEL_LINKER} -m elf32_x86_64 -r --no-warn-execstack -o ${arg_IMAGE}.objects ${objects} ${arg_OBJECT_FILES})
    set(library -e softcell_start --gc-sections -z muldefs -u softcell_start $<TARGET_FILE:${arg_LIBRARY}>)
  endif()
  add_custom_command(OUTPUT ${arg_IMAGE}
    ${check_definitions}
    COMMAND sh ${SOFTCELL_LINK_IMAGE} ${name} ${arg_IMAGE} ${begin} ${arg_STACK_BYTES} ${arg_BUDGET_BYTES} ${CMAKE_COMMAND} ${CMAKE_NM}
      ${SOFTCELL_KERNEL_LINKER} -m elf32_x86_64 -pie --no-dynamic-linker -T ${SOFTCELL_SDK_DIR}/ls.ld
      --defsym softcell_stack_bytes=${arg_STACK_BYTES}
      --defsym softcell_is_checked=${arg_CHECKED} --defsym softcell_is_program=${program} --defsym softcell_image_begin=${image_begin}
      --emit-relocs --build-id=none -z noexecstack --no-warn-rwx-segments -z max-page-size=128
      ${objects} ${arg_OBJECT_FILES} ${library}
    DEPENDS ${arg_OBJECTS} ${objects} ${arg_OBJECT_FILES} ${arg_LIBRARY} ${SOFTCELL_SDK_DIR}/ls.ld ${SOFTCELL_LINK_IMAGE}
    COMMAND_EXPAND_LISTS VERBATIM
    COMMENT "Linking local-store image ${name}")
endfunction()

# The part of softcell_add_spu_kernel for programs; its arguments are the caller's.
macro(softcell_add_spu_program name c_sources)
  set(cpp_sources ${arg_SOURCES})
  list(FILTER cpp_sources EXCLUDE REGEX "\\.c$")
  set(builds plain)
  if(NOT arg_UNCHECKED_ONLY)
    list(APPEND builds checked)
  endif()
  foreach(build IN LISTS builds)
    set(suffix)
    set(checked 0)
    set(c_flags)
    set(cpp_flags)
    set(objects)
    set(stack ${arg_STACK_BYTES})
    set(budget ${arg_BUDGET_BYTES})
    set(image ${CMAKE_CURRENT_BINARY_DIR}/${name}.spu.elf)
    if(build STREQUAL "checked")
      set(suffix _checked)
      set(checked 1)
      set(c_flags ${SOFTCELL_C_CHECKED_FLAGS})
      set(cpp_flags ${SOFTCELL_CHECKED_FLAGS})
      math(EXPR stack "${arg_STACK_BYTES} + ${SOFTCELL_CHECKED_STACK_BYTES}")
      set(budget 262144)
      set(image ${CMAKE_CURRENT_BINARY_DIR}/${name}.checked.spu.elf)
      softcell_report_objects(accesses atomics)
      set(objects softcell_report_accesses softcell_report_atomics)
    endif()
    softcell_program_library(softcell_program_library${suffix} ${cpp_flags})
    if(cpp_sources)
      softcell_compile_spu_sources(${name}${suffix}_objects PROGRAM SOURCES ${cpp_sources} INCLUDES ${arg_INCLUDES}
        OPTIONS ${cpp_flags} ${arg_OPTIONS} ${warnings})
      list(APPEND objects ${name}${suffix}_objects)
    endif()
    set(object_files)
    foreach(source IN ITEMS ${c_sources})
      softcell_compile_c_source(object ${name}${suffix} ${source} INCLUDES ${arg_INCLUDES} OPTIONS ${c_flags} ${arg_OPTIONS} ${warnings})
      list(APPEND object_files ${object})
    endforeach()
    softcell_link_spu_image(${name}${suffix} IMAGE ${image} CHECKED ${checked} OBJECTS ${objects} OBJECT_FILES ${object_files}
      STACK_BYTES ${stack} BUDGET_BYTES ${budget} LIBRARY softcell_program_library${suffix})
    add_custom_target(${name}${suffix}_image ALL DEPENDS ${image})
    set_target_properties(${name}${suffix}_image PROPERTIES SOFTCELL_IMAGE ${image})
  endforeach()
endmacro()

function(softcell_add_spu_kernel name)
  cmake_parse_arguments(arg "UNCHECKED_ONLY;HOST_ONLY;WARNINGS_AS_ERRORS;PROGRAM" "STACK_BYTES;BUDGET_BYTES;RESIDENT_AT"
    "SOURCES;INCLUDES;OPTIONS" ${ARGN})
  include(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/SoftcellKernelSettings.cmake)
  if(arg_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "softcell_add_spu_kernel(${name}): unknown arguments ${arg_UNPARSED_ARGUMENTS}")
  endif()
  foreach(number STACK_BYTES BUDGET_BYTES)
    if(DEFINED arg_${number} AND (NOT arg_${number} MATCHES "^[1-9][0-9]*$" OR arg_${number} GREATER 262144))
      message(FATAL_ERROR
        "softcell_add_spu_kernel(${name}): ${number} is ${arg_${number}}; a whole number from 1 to 262144 was expected, the bytes of a local store")
    endif()
  endforeach()
  foreach(required STACK_BYTES BUDGET_BYTES SOURCES)
    if(NOT arg_${required})
      message(FATAL_ERROR "softcell_add_spu_kernel(${name}): ${required} is missing")
    endif()
  endforeach()
  set(warnings)
  if(arg_WARNINGS_AS_ERRORS OR SOFTCELL_WARNINGS_AS_ERRORS)
    set(warnings WARNINGS_AS_ERRORS)
  endif()
  set(c_sources ${arg_SOURCES})
  list(FILTER c_sources INCLUDE REGEX "\\.c$")
  if(arg_PROGRAM OR c_sources)
    if(arg_RESIDENT_AT)
      message(FATAL_ERROR "softcell_add_spu_kernel(${name}): a program begins at the bottom of the local store; leave out RESIDENT_AT")
    endif()
    softcell_add_spu_program(${name} "${c_sources}")
    return()
  endif()
  set(image ${CMAKE_CURRENT_BINARY_DIR}/${name}.spu.elf)
  # Clang refuses precompiled headers of another dialect, and a project's own may have GNU's extensions.
  set(dialect)
  if(NOT DEFINED CMAKE_CXX_EXTENSIONS OR CMAKE_CXX_EXTENSIONS)
    set(dialect gnu_)
  endif()
  softcell_precompile_sdk(softcell_${dialect}kernel_headers)
  softcell_compile_spu_sources(${name}_objects SOURCES ${arg_SOURCES} INCLUDES ${arg_INCLUDES} ${warnings} OPTIONS ${arg_OPTIONS}
    HEADERS softcell_${dialect}kernel_headers)
  softcell_link_spu_image(${name} IMAGE ${image} CHECKED 0 OBJECTS ${name}_objects
    STACK_BYTES ${arg_STACK_BYTES} BUDGET_BYTES ${arg_BUDGET_BYTES} RESIDENT_AT ${arg_RESIDENT_AT})
  add_custom_target(${name}_image ALL DEPENDS ${image})
  set_target_properties(${name}_image PROPERTIES SOFTCELL_IMAGE ${image})

  if(SOFTCELL_SPU_CXX AND NOT arg_HOST_ONLY)
    softcell_add_spu_elf(${name} SOURCES ${arg_SOURCES} INCLUDES ${arg_INCLUDES} OPTIONS ${arg_OPTIONS} ${warnings}
      STACK_BYTES ${arg_STACK_BYTES} BUDGET_BYTES ${arg_BUDGET_BYTES} RESIDENT_AT ${arg_RESIDENT_AT})
  endif()

  if(NOT arg_UNCHECKED_ONLY)
    softcell_report_objects(accesses)
    set(checked_image ${CMAKE_CURRENT_BINARY_DIR}/${name}.checked.spu.elf)
    softcell_precompile_sdk(softcell_checked_${dialect}kernel_headers ${SOFTCELL_CHECKED_FLAGS})
    softcell_compile_spu_sources(${name}_checked_objects SOURCES ${arg_SOURCES} INCLUDES ${arg_INCLUDES}
        HEADERS softcell_checked_${dialect}kernel_headers OPTIONS ${SOFTCELL_CHECKED_FLAGS} ${arg_OPTIONS} ${warnings})
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
# softcell_image_<kernel>_end[]; their checked images likewise, as softcell_image_<kernel>_checked, and with SOFTCELL_SPU_CXX their
# executables for the SPU, as softcell_image_<kernel>_spu.
function(softcell_embed_spu_images library)
  if(NOT DEFINED CMAKE_ASM_COMPILE_OBJECT)  # set in a folder where the language is enabled
    message(FATAL_ERROR
      "softcell_embed_spu_images(${library}): images are embedded by the assembler; enable it, as in project(... LANGUAGES CXX ASM).")
  endif()
  foreach(kernel IN LISTS ARGN)
    if(NOT TARGET ${kernel}_image)
      message(FATAL_ERROR "softcell_embed_spu_images(${library}): there is no kernel ${kernel} of softcell_add_spu_kernel()")
    endif()
    softcell_embed_spu_image(${library} ${kernel})
    if(TARGET ${kernel}_checked_image)
      softcell_embed_spu_image(${library} ${kernel}_checked)
    endif()
    # softcell's own are embedded without debug information, and whether there is a compiler or not.
    if(TARGET ${kernel}_spu_elf AND NOT library STREQUAL "softcell_spu_kernels")
      get_target_property(elf ${kernel}_spu_elf SOFTCELL_IMAGE)
      softcell_embed_image_file(${library} ${kernel}_spu ${elf})
    endif()
  endforeach()
endfunction()

# softcell_embed_spu_program(<target> <symbol> <kernel>)
# Puts a kernel and its checked image into a program or library, as `extern spe_program_handle_t <symbol>` of libspe2.
function(softcell_embed_spu_program target symbol kernel)
  if(NOT DEFINED CMAKE_ASM_COMPILE_OBJECT)
    message(FATAL_ERROR
      "softcell_embed_spu_program(${target}): programs are embedded by the assembler; enable it, as in project(... LANGUAGES CXX ASM).")
  endif()
  if(NOT TARGET ${kernel}_image)
    message(FATAL_ERROR "softcell_embed_spu_program(${target}): there is no kernel ${kernel} of softcell_add_spu_kernel()")
  endif()
  get_target_property(image ${kernel}_image SOFTCELL_IMAGE)
  set(images ${image})
  set(checked_pointer 0)
  set(checked_bytes)
  if(TARGET ${kernel}_checked_image)
    get_target_property(checked_image ${kernel}_checked_image SOFTCELL_IMAGE)
    list(APPEND images ${checked_image})
    set(checked_pointer .Lchecked)
    set(checked_bytes ".balign 128\n.Lchecked: .incbin \"${checked_image}\"")
  endif()
  set(stub ${CMAKE_CURRENT_BINARY_DIR}/${target}.${symbol}.program.S)
  file(CONFIGURE OUTPUT ${stub} @ONLY CONTENT [[
.section .data.rel.ro, "aw"
.balign 8
.global @symbol@
.type @symbol@, @object
.size @symbol@, 40
@symbol@:
.long 40, 0
.quad .Limage, 0, @checked_pointer@, .Lname
.section .rodata
.Lname: .asciz "@kernel@"
.balign 128
.Limage: .incbin "@image@"
@checked_bytes@
.section .note.GNU-stack,"",%progbits
]])
  target_sources(${target} PRIVATE ${stub})
  set_source_files_properties(${stub} PROPERTIES OBJECT_DEPENDS "${images}")
  add_dependencies(${target} ${kernel}_image)
endfunction()

function(softcell_embed_spu_image library kernel)
  get_target_property(image ${kernel}_image SOFTCELL_IMAGE)
  softcell_embed_image_file(${library} ${kernel} ${image})
endfunction()

function(softcell_embed_image_file library kernel image)
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
