# softcell_suppress_mesa_reports(<test program>)
# For a program that draws, added by softcell_add_test in the same folder: its cases run with the suppressions of this
# folder, which cover what the sanitizers report of Mesa and LLVM. Not for other programs: they suppress too much.
#
# intercept_tls_get_addr=0: the leak sanitizer guesses where threads of such libraries, loaded later, have their variables, and
# now and then reads at an address that is none (g++ 12: "Tracer caught signal 11"). It need not look there for pointers.

set(SOFTCELL_SUPPRESSIONS_DIR ${CMAKE_CURRENT_LIST_DIR})

function(softcell_suppress_mesa_reports test)
  # Cases are discovered when ctest runs; the discovery leaves their names in <test>_TESTS, for scripts that come after it.
  set(script ${CMAKE_CURRENT_BINARY_DIR}/${test}_suppressions.cmake)
  file(CONFIGURE OUTPUT ${script} @ONLY CONTENT [[
set_tests_properties(${@test@_TESTS} PROPERTIES ENVIRONMENT
  "LSAN_OPTIONS=suppressions=@SOFTCELL_SUPPRESSIONS_DIR@/lsan.supp:print_suppressions=0:intercept_tls_get_addr=0;TSAN_OPTIONS=suppressions=@SOFTCELL_SUPPRESSIONS_DIR@/tsan.supp:print_suppressions=0")
]])
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${script})
endfunction()
