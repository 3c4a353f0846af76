# The declarations of a real SPU compiler, spu_kernels/sdk/check, with the compiler of the project:
#   refused/*.cpp   must not compile, and the compiler must say what the first line expects: `// refused: <regular expression>`
#   accepted/*.cpp  must compile; where the first line names the host, with the host's headers as well: `// sdk: check host`

file(GLOB refused CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/refused/*.cpp)
file(GLOB accepted CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/accepted/*.cpp)
set(host_flags ${SOFTCELL_KERNEL_FLAGS} -fsyntax-only
  -include ${SOFTCELL_SDK_DIR}/host/softcell_entry.h -I ${SOFTCELL_SDK_DIR}/host -I ${SOFTCELL_SDK_DIR}/..)

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
