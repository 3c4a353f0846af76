# The examples in one project with softcell, by add_subdirectory: no installed softcell is needed, and none of its programs is built.
# Compiled in groups of sources, as that is quick, with assertions, and without optimisation, so that `ci/test --all` can go on in BUILD with
# scenes that are not optimised.
include(${CMAKE_CURRENT_LIST_DIR}/../support/steps.cmake)
set(project ${SCRATCH}/project)
set(build ${BUILD})
file(REMOVE_RECURSE ${SCRATCH} ${BUILD})
set(text "cmake_minimum_required(VERSION 3.25)\nproject(around LANGUAGES CXX ASM)\nenable_testing()\n"
  "add_subdirectory(${SOURCE} softcell EXCLUDE_FROM_ALL)\n")
foreach(example hello_kernel saxpy ping_pong jelly_3d tyre_3d vase_3d jelly_2d jelly_on_spes)
  file(COPY ${SOURCE}/examples/${example} DESTINATION ${project})
  list(APPEND text "add_subdirectory(${example})\n")
endforeach()
file(WRITE ${project}/CMakeLists.txt ${text})

# Packages that are installed on this machine are no help.
step("configuring" ${CMAKE_COMMAND} -S ${project} -B ${build} -G ${GENERATOR} -DCMAKE_DISABLE_FIND_PACKAGE_softcell=ON
  -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER} -DSOFTCELL_BUILD_TESTS=OFF
  -DSOFTCELL_UNITY_BUILD=ON -DSOFTCELL_PRECOMPILED_HEADERS=ON)
step("building" ${CMAKE_COMMAND} --build ${build} --parallel 2)
# These three would run for minutes. The installed ones are run.
step("testing" ${CMAKE_CTEST_COMMAND} --test-dir ${build} --output-on-failure -E "^(jelly|tyre|vase)_3d$")
file(GLOB_RECURSE pictures ${build}/jelly_on_spes/*.png)
if(NOT pictures)
  message(FATAL_ERROR "jelly_on_spes has left no picture in ${build}/jelly_on_spes")
endif()
file(GLOB_RECURSE command ${build}/softcell)
if(command)
  message(FATAL_ERROR "the project has built the command softcell: ${command}")
endif()
