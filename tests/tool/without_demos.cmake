# The command without demos: configured where none of their libraries can be found, built, and run.
# Compiled without optimisation and in groups of sources, as that is quick. BUILD is emptied at first, so that nothing of an earlier run helps.

include(${CMAKE_CURRENT_LIST_DIR}/../support/steps.cmake)

file(REMOVE_RECURSE ${BUILD})
set(cache "set(SOFTCELL_COMPONENTS spu CACHE STRING \"\")\nset(SOFTCELL_BUILD_DEMOS OFF CACHE BOOL \"\")\n")
foreach(package Eigen3 assimp BulletFloat Bullet box2d SDL2 PNG PkgConfig)
  string(APPEND cache "set(CMAKE_DISABLE_FIND_PACKAGE_${package} ON CACHE BOOL \"\")\n")
endforeach()
file(WRITE ${BUILD}/without_demos.cmake "${cache}")
says(0 "" ${CMAKE_COMMAND} -C ${BUILD}/without_demos.cmake -S ${SOURCE} -B ${BUILD} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DSOFTCELL_BUILD_TESTS=OFF -DSOFTCELL_UNITY_BUILD=ON)
says(0 "" ${CMAKE_COMMAND} --build ${BUILD} --parallel 2 --target softcell)

# A kernel of jobs is measured; one that takes a lattice to be run cannot be.
says(0 "\nskin[^\n]* - [^\n]*%.*\ntransfers[^\n]* [0-9]+ [^\n]*%" ${BUILD}/softcell spu budget)
says(2 "this softcell is built without demos: it has no command 'demo'; there are: spu, run, report, help, completion, man"
  ${BUILD}/softcell demo 3d --headless)
says(2 "softcell has no command 'dmo'; there are: spu, run, report" ${BUILD}/softcell dmo)
