# The same kernels as executables for the SPU, which the interpreter runs and a console's loader takes. Used by softcell_add_spu_kernel.
#
# SOFTCELL_SPU_CXX is a C++ compiler for spu-elf, GCC 7 to 9, with its C compiler, linker and assembler beside it. Without it nothing is
# built for the SPU.

set(SOFTCELL_SPU_CXX "" CACHE FILEPATH "C++ compiler for spu-elf (GCC 7 to 9), which builds each kernel for the SPU as well")

# softcell_spu_source_options(<variable> <include folders> <options> <warnings as errors>): of a kernel's source, for either compiler.
function(softcell_spu_source_options variable folders options warnings_as_errors)
  foreach(folder IN LISTS folders)
    cmake_path(ABSOLUTE_PATH folder)
    list(APPEND options -I${folder})
  endforeach()
  if("${warnings_as_errors}")
    list(APPEND options -Werror)
  endif()
  set(${variable} ${options} PARENT_SCOPE)
endfunction()

# softcell_find_spu_tool(<variable> <tool>): the tool beside the compiler, spu-elf-gcc of spu-elf-g++.
function(softcell_find_spu_tool variable tool)
  cmake_path(GET SOFTCELL_SPU_CXX PARENT_PATH folder)
  cmake_path(GET SOFTCELL_SPU_CXX FILENAME compiler)
  string(REGEX REPLACE "[gc][+][+](-[0-9.]+)?$" "${tool}" name "${compiler}")
  set(path ${folder}/${name})
  if(name STREQUAL compiler OR NOT EXISTS ${path})
    message(FATAL_ERROR "softcell: SOFTCELL_SPU_CXX is ${SOFTCELL_SPU_CXX}, and its ${tool} was not found beside it as ${path}.")
  endif()
  set(${variable} ${path} PARENT_SCOPE)
endfunction()

# softcell_find_spu_libgcc(<variable>): the compiler's own library: products of 64 bits, the manager of MFC tags. Nothing of a C library.
# The compiler is asked once for all kernels.
function(softcell_find_spu_libgcc variable)
  set(known SOFTCELL_LIBGCC_OF_${SOFTCELL_SPU_CXX})
  get_property(libgcc GLOBAL PROPERTY ${known})
  if(NOT libgcc)
    execute_process(COMMAND ${SOFTCELL_SPU_CXX} -print-libgcc-file-name OUTPUT_VARIABLE libgcc OUTPUT_STRIP_TRAILING_WHITESPACE
      COMMAND_ERROR_IS_FATAL ANY)
    set_property(GLOBAL PROPERTY ${known} ${libgcc})
  endif()
  set(${variable} ${libgcc} PARENT_SCOPE)
endfunction()

# softcell_add_spu_elf(<name> SOURCES <file>... STACK_BYTES <n> BUDGET_BYTES <n> [INCLUDES <folder>...] [OPTIONS <option>...]
#                      [RESIDENT_AT <address>] [WARNINGS_AS_ERRORS])
# <binary dir>/<name>.elf, target <name>_spu_elf; its property SOFTCELL_IMAGE is the path.
function(softcell_add_spu_elf name)
  cmake_parse_arguments(arg "WARNINGS_AS_ERRORS" "STACK_BYTES;BUDGET_BYTES;RESIDENT_AT" "SOURCES;INCLUDES;OPTIONS" ${ARGN})
  include(${CMAKE_CURRENT_FUNCTION_LIST_DIR}/SoftcellKernelSettings.cmake)
  softcell_find_spu_tool(c_compiler gcc)
  softcell_find_spu_tool(linker ld)
  softcell_find_spu_tool(nm nm)
  softcell_find_spu_libgcc(libgcc)
  softcell_spu_source_options(options "${arg_INCLUDES}" "${arg_OPTIONS}" "${arg_WARNINGS_AS_ERRORS}")
  list(APPEND options -I${SOFTCELL_SDK_DIR}/.. -I${SOFTCELL_SDK_DIR}/shared)
  set(objects)
  foreach(source IN LISTS arg_SOURCES)
    cmake_path(ABSOLUTE_PATH source)
    cmake_path(GET source FILENAME file)
    set(object ${CMAKE_CURRENT_BINARY_DIR}/${name}.spu_elf.${file}.o)
    set(compiler ${SOFTCELL_SPU_CXX} ${SOFTCELL_SPU_CXX_FLAGS})
    if(file MATCHES "\\.c$")
      set(compiler ${c_compiler} ${SOFTCELL_SPU_C_FLAGS})
    endif()
    add_custom_command(OUTPUT ${object}
      COMMAND ${compiler} ${options} -MD -MF ${object}.d -MT ${object} -c ${source} -o ${object}
      DEPENDS ${source} DEPFILE ${object}.d VERBATIM
      COMMENT "Compiling ${file} of ${name} for the SPU")
    list(APPEND objects ${object})
  endforeach()
  # Once for each folder: a folder has no output of another's rules.
  set(start ${CMAKE_CURRENT_BINARY_DIR}/softcell_spu_start.o)
  get_property(known DIRECTORY PROPERTY SOFTCELL_SPU_START)
  if(NOT known)
    set_property(DIRECTORY PROPERTY SOFTCELL_SPU_START ${start})
    add_custom_command(OUTPUT ${start} COMMAND ${c_compiler} -c ${SOFTCELL_SDK_DIR}/spu/start.s -o ${start}
      DEPENDS ${SOFTCELL_SDK_DIR}/spu/start.s VERBATIM COMMENT "Assembling the SPU's start-up code")
  endif()
  set(image_begin 0x80)
  set(begin 0)
  if(arg_RESIDENT_AT)
    set(image_begin ${arg_RESIDENT_AT})
    set(begin ${arg_RESIDENT_AT})
  endif()
  set(elf ${CMAKE_CURRENT_BINARY_DIR}/${name}.elf)
  add_custom_command(OUTPUT ${elf}
    COMMAND ${linker} -T ${SOFTCELL_SDK_DIR}/spu/ls.ld --defsym softcell_stack_bytes=${arg_STACK_BYTES}
      --defsym softcell_budget_bytes=${arg_BUDGET_BYTES} --defsym softcell_image_begin=${image_begin}
      --build-id=none -z max-page-size=128 ${start} ${objects} ${libgcc} -o ${elf}
    COMMAND ${CMAKE_COMMAND} -DNM=${nm} -DIMAGE=${elf} -DKERNEL=${name} -DBEGIN=${begin} -DSTACK_BYTES=${arg_STACK_BYTES}
      -DBUDGET_BYTES=${arg_BUDGET_BYTES} -DSPU_LINKER=${linker} "-DOBJECTS=${objects};${libgcc}" -P ${SOFTCELL_CHECK_BUDGET}
    DEPENDS ${start} ${objects} ${SOFTCELL_SDK_DIR}/spu/ls.ld ${SOFTCELL_CHECK_BUDGET}
    VERBATIM COMMENT "Linking SPU executable ${name}")
  add_custom_target(${name}_spu_elf ALL DEPENDS ${elf})
  set_target_properties(${name}_spu_elf PROPERTIES SOFTCELL_IMAGE ${elf})
endfunction()
