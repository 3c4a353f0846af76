# softcell_suppress_mesa_reports(<test program>)
# For a program that draws, added by softcell_add_test in the same folder of a build with sanitizers: its cases run with the suppressions of
# this folder, which cover what the sanitizers report of Mesa and LLVM. Not for other programs: they suppress too much.
#
# intercept_tls_get_addr=0: the leak sanitizer guesses where threads of such libraries, loaded later, have their variables, and
# now and then reads at an address that is none (g++ 12: "Tracer caught signal 11"). It need not look there for pointers.

set(SOFTCELL_SUPPRESSIONS_DIR ${CMAKE_CURRENT_LIST_DIR})

function(softcell_suppress_mesa_reports test)
  if(NOT SOFTCELL_SANITIZE)
    return()
  endif()
  set(environment
    "LSAN_OPTIONS=suppressions=${SOFTCELL_SUPPRESSIONS_DIR}/lsan.supp:print_suppressions=0:intercept_tls_get_addr=0"
    "TSAN_OPTIONS=suppressions=${SOFTCELL_SUPPRESSIONS_DIR}/tsan.supp:print_suppressions=0")
  foreach(number RANGE 1 4)
    set_property(TEST ${test}.${number}_of_4 APPEND PROPERTY ENVIRONMENT ${environment})
  endforeach()
endfunction()
