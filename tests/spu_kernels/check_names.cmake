# cmake -DCHECK=<sdk/check> -DTESTS=<this folder> -P check_names.cmake
# Every name that a real SPU compiler's headers define (as sdk/check lists them) must occur in a test of the host's headers,
# except those that make no sense in a kernel for the host.

set(not_on_the_host
  si_lqr si_stqr          # relative to the program counter
  spu_bisled spu_bisled_d spu_bisled_e  # branches to an interrupt's handler
  spu_ienable spu_mffpscr spu_mtfpscr spu_mfspr spu_mtspr si_fscrrd si_fscrwr si_mfspr si_mtspr)  # refused: host_refused/

file(GLOB headers ${CHECK}/*.h)
file(GLOB tests ${TESTS}/intrinsics_*_test.cpp)
set(text "")
foreach(test IN LISTS tests)
  file(READ ${test} one)
  string(APPEND text "${one}")
endforeach()
string(REGEX MATCHALL "(si|spu|mfc)_[a-z0-9_]+" used "${text}")
list(REMOVE_DUPLICATES used)

set(names)
foreach(header IN LISTS headers)
  file(READ ${header} one)
  string(REGEX MATCHALL "#define (si|spu|mfc)_[a-z0-9_]+\\(" definitions "${one}")
  foreach(definition IN LISTS definitions)
    string(REGEX MATCH "(si|spu|mfc)_[a-z0-9_]+" name "${definition}")
    list(APPEND names ${name})
  endforeach()
endforeach()
list(LENGTH names count)
if(count LESS 300)
  message(FATAL_ERROR "found only ${count} names in ${CHECK}")
endif()
list(REMOVE_ITEM names ${used} ${not_on_the_host})
if(names)
  list(JOIN names " " missing)
  message(FATAL_ERROR "no test of the host's headers uses: ${missing}")
endif()
