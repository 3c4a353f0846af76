# Programs of the Cell's Linux as tests: each runs under several orders of its DMA transfers, and checked.

# softcell_test_in_every_order(<prefix> <target> [PASS <regular expression>] [FAIL <regular expression>])
# Tests <prefix>.eager to <prefix>.checked; one passes that prints "ok", or what PASS says, and nothing of FAIL.
function(softcell_test_in_every_order prefix target)
  cmake_parse_arguments(arg "" "PASS;FAIL" "" ${ARGN})
  if(NOT arg_PASS)
    set(arg_PASS "^ok\n$")
  endif()
  add_dependencies(threads_tests ${target})
  foreach(way eager lazy random turns checked)
    add_test(NAME ${prefix}.${way} COMMAND ${target})
    set_tests_properties(${prefix}.${way} PROPERTIES PASS_REGULAR_EXPRESSION "${arg_PASS}" TIMEOUT 60 LABELS threads)
    if(arg_FAIL)
      set_tests_properties(${prefix}.${way} PROPERTIES FAIL_REGULAR_EXPRESSION "${arg_FAIL}")
    endif()
  endforeach()
  set_tests_properties(${prefix}.lazy PROPERTIES ENVIRONMENT SOFTCELL_DMA=lazy)
  set_tests_properties(${prefix}.random PROPERTIES ENVIRONMENT SOFTCELL_DMA=random:11)
  set_tests_properties(${prefix}.turns PROPERTIES ENVIRONMENT "SOFTCELL_DMA=random:3;SOFTCELL_TURNS=1")
  set_tests_properties(${prefix}.checked PROPERTIES ENVIRONMENT "SOFTCELL_CHECKED=1;SOFTCELL_DMA=lazy")
endfunction()

# softcell_sanitize_program(<target>): a program in C that links libspe2, in a build with sanitizers.
function(softcell_sanitize_program target)
  if(SOFTCELL_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${SOFTCELL_SANITIZE})
    target_link_options(${target} PRIVATE -fsanitize=${SOFTCELL_SANITIZE})
    set_target_properties(${target} PROPERTIES LINKER_LANGUAGE CXX)  # libspe2 needs the sanitizers' parts for C++
  endif()
endfunction()
