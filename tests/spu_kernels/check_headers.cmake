# The declarations of a real SPU compiler, spu_kernels/sdk/check, with the compiler of the project:
#   refused/*.cpp   must not compile, and the compiler must say what the first line expects: `// refused: <regular expression>`
#   accepted/*.cpp  must compile; where the first line names the host, with the host's headers as well: `// sdk: check host`

file(GLOB refused CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/refused/*.cpp)
file(GLOB accepted CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/accepted/*.cpp)
set(host_flags ${SOFTCELL_KERNEL_FLAGS} -fsyntax-only
  -I ${SOFTCELL_SDK_DIR}/host -I ${SOFTCELL_SDK_DIR}/..)

# A real compiler, where there is one, says the same of these sources, but for two that it takes.
set(taken_by_the_compiler scale_not_constant immediate_misaligned)
if(SOFTCELL_SPU_CXX)
  set(spu_flags ${SOFTCELL_SPU_CXX_FLAGS} -Wno-unused-parameter -I ${SOFTCELL_SDK_DIR}/.. -I ${SOFTCELL_SDK_DIR}/shared -c -o /dev/null)
  foreach(source IN LISTS accepted refused)
    cmake_path(GET source STEM stem)
    add_test(NAME spu_check.the_compiler_agrees.${stem} COMMAND ${SOFTCELL_SPU_CXX} ${spu_flags} ${source})
    if(source IN_LIST refused AND NOT stem IN_LIST taken_by_the_compiler)
      set_tests_properties(spu_check.the_compiler_agrees.${stem} PROPERTIES WILL_FAIL ON)
    endif()
  endforeach()
endif()

foreach(source IN LISTS refused)
  cmake_path(GET source STEM stem)
  add_test(NAME spu_check.refuses.${stem}
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${source} -P ${CMAKE_CURRENT_LIST_DIR}/check_refused.cmake --
      ${CMAKE_CXX_COMPILER} ${SOFTCELL_SPU_CHECK_FLAGS} ${source})
endforeach()

foreach(source IN LISTS accepted)
  cmake_path(GET source STEM stem)
  add_test(NAME spu_check.accepts.${stem} COMMAND ${CMAKE_CXX_COMPILER} ${SOFTCELL_SPU_CHECK_FLAGS} ${source})
  file(STRINGS ${source} first_line LIMIT_COUNT 1)
  if(first_line MATCHES "^// sdk: check host$")
    add_test(NAME spu_check.host_accepts.${stem} COMMAND ${CMAKE_CXX_COMPILER} ${host_flags} ${source})
  elseif(NOT first_line STREQUAL "// sdk: check")
    message(FATAL_ERROR "${source}: the first line must name its SDK headers, `// sdk: check` or `// sdk: check host`")
  endif()
endforeach()
