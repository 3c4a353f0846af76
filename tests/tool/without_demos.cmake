# The command without demos: configured where none of their libraries can be found, built, and run.
# Compiled without optimisation, as that is quick. BUILD is emptied at first, so that nothing of an earlier run helps.

# run(<status> <regular expression> <command>...): the command ends with that status and prints that.
function(run expected_status expected)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT status EQUAL expected_status OR NOT output MATCHES "${expected}")
    message(FATAL_ERROR "expected status ${expected_status} and \"${expected}\" of ${ARGN}, got ${status}:\n${output}")
  endif()
endfunction()

file(REMOVE_RECURSE ${BUILD})
set(cache "set(SOFTCELL_COMPONENTS spu CACHE STRING \"\")\nset(SOFTCELL_BUILD_DEMOS OFF CACHE BOOL \"\")\n")
foreach(package Eigen3 assimp BulletFloat Bullet box2d SDL2 PNG PkgConfig)
  string(APPEND cache "set(CMAKE_DISABLE_FIND_PACKAGE_${package} ON CACHE BOOL \"\")\n")
endforeach()
file(WRITE ${BUILD}/without_demos.cmake "${cache}")
run(0 "" ${CMAKE_COMMAND} -C ${BUILD}/without_demos.cmake -S ${SOURCE} -B ${BUILD} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DSOFTCELL_BUILD_TESTS=OFF -DSOFTCELL_PRECOMPILED_HEADERS=OFF)
run(0 "" ${CMAKE_COMMAND} --build ${BUILD} --parallel 2 --target softcell)

# A kernel of jobs is measured; one that takes a lattice to be run cannot be.
run(0 "skin[^\n]* - [^\n]*%[^\n]*\ntransfers[^\n]* [0-9]+ [^\n]*%" ${BUILD}/softcell spu budget)
run(2 "this softcell is built without demos: it has no command 'demo'; there are: spu, report, help, completion, man"
  ${BUILD}/softcell demo 3d --headless)
run(2 "softcell has no command 'dmo'; there are: spu, report" ${BUILD}/softcell dmo)
