# The host's intrinsics, spu_kernels/sdk/host, each against a plain definition from the instruction set.

softcell_add_test(spu_intrinsics_tests SOURCES
  intrinsics_bytes_test.cpp
  intrinsics_channels_test.cpp
  intrinsics_convert_test.cpp
  intrinsics_double_test.cpp
  intrinsics_estimate_test.cpp
  intrinsics_integer_test.cpp
  intrinsics_logic_test.cpp
  intrinsics_single_test.cpp
  intrinsics_specific_test.cpp
  SHORT_CASES)
target_include_directories(spu_intrinsics_tests PRIVATE ${SOFTCELL_SDK_DIR}/host)
target_compile_options(spu_intrinsics_tests PRIVATE -mavx2 -mfma -frounding-math)
set_target_properties(spu_intrinsics_tests PROPERTIES DISABLE_PRECOMPILE_HEADERS ON)  # they are compiled with other options

# Every documented name has a test.
add_test(NAME spu_intrinsics.every_documented_name_is_tested
  COMMAND ${CMAKE_COMMAND} -DCHECK=${SOFTCELL_SDK_DIR}/check -DTESTS=${CMAKE_CURRENT_LIST_DIR}
    -P ${CMAKE_CURRENT_LIST_DIR}/check_names.cmake)

# What no declaration shows: where a host's compiler and an SPU's read the same source otherwise.
find_program(SOFTCELL_SYSTEM_PYTHON python3 PATHS /usr/bin NO_DEFAULT_PATH REQUIRED)
add_test(NAME spu_syntax.sources_mean_the_same
  COMMAND ${SOFTCELL_SYSTEM_PYTHON} -B ${CMAKE_CURRENT_LIST_DIR}/check_sources.py
    ${PROJECT_SOURCE_DIR}/spu_kernels ${PROJECT_SOURCE_DIR}/examples/saxpy ${PROJECT_SOURCE_DIR}/tests/zoo)
set_tests_properties(spu_syntax.sources_mean_the_same PROPERTIES LABELS kernel)

# host_refused/*.cpp must not compile with the host's headers, for the reason in their first line.
file(GLOB host_refused CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/host_refused/*.cpp)
foreach(source IN LISTS host_refused)
  cmake_path(GET source STEM stem)
  add_test(NAME spu_intrinsics.refuses.${stem}
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${source} -P ${CMAKE_CURRENT_LIST_DIR}/check_refused.cmake --
      ${CMAKE_CXX_COMPILER} ${SOFTCELL_KERNEL_FLAGS} -S -o /dev/null -I ${SOFTCELL_SDK_DIR}/host ${source})
endforeach()

# host_code/*.cpp must compile to few instructions.
file(GLOB host_code CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/host_code/*.cpp)
foreach(source IN LISTS host_code)
  cmake_path(GET source STEM stem)
  add_test(NAME spu_intrinsics.code.${stem}
    COMMAND ${CMAKE_COMMAND} -DSOURCE=${source} -P ${CMAKE_CURRENT_LIST_DIR}/check_code.cmake --
      ${CMAKE_CXX_COMPILER} ${SOFTCELL_KERNEL_FLAGS} -I ${SOFTCELL_SDK_DIR}/host)
endforeach()
