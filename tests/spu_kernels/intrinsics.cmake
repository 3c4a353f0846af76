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
  intrinsics_specific_test.cpp)
target_include_directories(spu_intrinsics_tests PRIVATE ${SOFTCELL_SDK_DIR}/host)
target_compile_options(spu_intrinsics_tests PRIVATE -mavx2 -mfma -frounding-math)
