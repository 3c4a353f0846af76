# Installs the build tree, then builds and tests the examples with nothing but what was installed.

include(${CMAKE_CURRENT_LIST_DIR}/../support/steps.cmake)

# build_and_test(<example>): in a copy away from our source tree, so that nothing of it is found by chance. With warnings as a strict
# project has them: none is of softcell's headers.
function(build_and_test example)
  file(COPY ${EXAMPLES}/${example} DESTINATION ${SCRATCH})
  set(build ${SCRATCH}/${example}/build)
  step("configuring ${example}" ${CMAKE_COMMAND} -S ${SCRATCH}/${example} -B ${build} -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${prefix}
    -DCMAKE_CXX_COMPILER=${COMPILER} -DCMAKE_BUILD_TYPE=${BUILD_TYPE}
    "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wconversion -Wsign-conversion -Wshadow -Werror")
  step("building ${example}" ${CMAKE_COMMAND} --build ${build} --parallel 2)
  step("testing ${example}" ${CMAKE_CTEST_COMMAND} --test-dir ${build} --output-on-failure)
endfunction()

set(prefix ${SCRATCH}/prefix)
file(REMOVE_RECURSE ${SCRATCH})
step("cmake --install" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${prefix})
foreach(example hello_kernel saxpy ping_pong jelly_3d tyre_3d vase_3d jelly_2d jelly_on_spes)
  build_and_test(${example})
endforeach()
set(copy ${SCRATCH}/saxpy)
set(build ${copy}/build)

# Soft bodies: the box comes to rest on the jelly.
says(0 "4\\.0 s: the box is at height 1\\.[01]" ${SCRATCH}/jelly_3d/build/jelly_3d ${SCRATCH}/jelly_3d/jelly.obj)
says(1 "no_such.obj: there is no such file" ${SCRATCH}/jelly_3d/build/jelly_3d no_such.obj)
says(0 "1\\.50 s: the axle is at [34]\\." ${SCRATCH}/tyre_3d/build/tyre_3d)
says(0 "the vase of ([0-9.]+) kg lies in [1-9][0-9]+ pieces of [0-9.]+ kg together" ${SCRATCH}/vase_3d/build/vase_3d)
says(0 "4\\.0 s: the box is at height 1\\.[0-3]" ${SCRATCH}/jelly_2d/build/jelly_2d)

# SPEs make a picture of a textured jelly. Without its texture it would have the one colour that it is multiplied with.
set(jelly ${SCRATCH}/jelly_on_spes)
says(0 "" ${jelly}/build/jelly_on_spes ${jelly}/jelly.obj ${SCRATCH}/jelly.png)
file(SIZE ${SCRATCH}/jelly.png picture_bytes)
if(picture_bytes LESS 50000)
  message(FATAL_ERROR "${SCRATCH}/jelly.png has ${picture_bytes} bytes only; a picture was expected")
endif()
says(1 "expected a mesh and a picture" ${jelly}/build/jelly_on_spes)
file(READ ${EXAMPLES}/jelly_on_spes/jelly_on_spes.cpp text)
string(REGEX REPLACE "[^\n]" "" line_ends "${text}")
string(LENGTH "${line_ends}" count)
if(NOT count LESS 80)
  message(FATAL_ERROR "jelly_on_spes.cpp has ${count} lines; fewer than 80 were promised")
endif()

# Each program links what it has a use for and nothing else.
function(links_none_of libraries program)
  execute_process(COMMAND ldd ${program} RESULT_VARIABLE status OUTPUT_VARIABLE linked)
  if(NOT status EQUAL 0 OR NOT linked MATCHES "libc\\.so" OR linked MATCHES "${libraries}")
    message(FATAL_ERROR "${program} links what it has no use for, one of ${libraries}:\n${linked}")
  endif()
endfunction()
links_none_of("Bullet|LinearMath|assimp|boost|libdw" ${SCRATCH}/jelly_2d/build/jelly_2d)
links_none_of("box2d|boost|libdw" ${SCRATCH}/jelly_3d/build/jelly_3d)

# A component that there is not is refused in one sentence with those that there are.
file(WRITE ${SCRATCH}/wrong/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)\nproject(wrong LANGUAGES CXX)\n"
  "find_package(softcell REQUIRED COMPONENTS box2d bodies)\n")
says(1 "softcell has no component 'bodies'; its components are[ \n]+spu,[ \n]+libspe2,[ \n]+soft_bodies,[ \n]+mesh_import,[ \n]+bullet,[ \n]+box2d,[ \n]+spe_bodies,[ \n]+render\\."
  ${CMAKE_COMMAND} -S ${SCRATCH}/wrong -B ${SCRATCH}/wrong/build -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${prefix}
  -DCMAKE_CXX_COMPILER=${COMPILER})

# Nothing of it can be linked without C++.
file(WRITE ${SCRATCH}/c_only/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)\nproject(c_only LANGUAGES C)\n"
  "find_package(softcell REQUIRED COMPONENTS libspe2)\n")
says(1 "softcell is written in C\\+\\+; enable it in this project, as in[ \n]+project\\(\\.\\.\\.[ \n]+LANGUAGES[ \n]+C[ \n]+CXX\\)\\."
  ${CMAKE_COMMAND} -S ${SCRATCH}/c_only -B ${SCRATCH}/c_only/build -G ${GENERATOR} -DCMAKE_PREFIX_PATH=${prefix})

# Optional ones that there are not, or that lack a library, are no reason to refuse the others.
file(WRITE ${SCRATCH}/optional/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)\nproject(optional LANGUAGES CXX)\n"
  "set(CMAKE_DISABLE_FIND_PACKAGE_assimp ON)\n"
  "find_package(softcell REQUIRED COMPONENTS box2d OPTIONAL_COMPONENTS mesh_import bodies render)\n"
  "foreach(component box2d soft_bodies mesh_import bodies render)\n"
  "  if(TARGET softcell::\${component} AND softcell_\${component}_FOUND)\n    message(STATUS \"has \${component}\")\n  endif()\nendforeach()\n")
says(0 "has box2d\n-- has soft_bodies\n-- has render\n" ${CMAKE_COMMAND} -S ${SCRATCH}/optional -B ${SCRATCH}/optional/build -G ${GENERATOR}
  -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${COMPILER})

# The same by pkg-config, without CMake.
set(ENV{PKG_CONFIG_PATH} ${prefix}/lib/pkgconfig)
function(pkg_config_builds program source)
  execute_process(COMMAND pkg-config --cflags --libs ${ARGN} COMMAND_ERROR_IS_FATAL ANY
    OUTPUT_VARIABLE options OUTPUT_STRIP_TRAILING_WHITESPACE)
  separate_arguments(options UNIX_COMMAND "${options}")
  step("building ${program} with pkg-config" ${COMPILER} -std=c++20 ${source} -o ${SCRATCH}/${program} ${options})
endfunction()
pkg_config_builds(jelly_3d_by_hand ${SCRATCH}/jelly_3d/jelly_3d.cpp softcell-bullet softcell-mesh-import)
says(0 "4\\.0 s: the box is at height 1\\.[01]" ${SCRATCH}/jelly_3d_by_hand ${SCRATCH}/jelly_3d/jelly.obj)
pkg_config_builds(jelly_2d_by_hand ${SCRATCH}/jelly_2d/jelly_2d.cpp softcell-box2d)
says(0 "4\\.0 s: the box is at height 1\\.[0-3]" ${SCRATCH}/jelly_2d_by_hand)
pkg_config_builds(jelly_on_spes_by_hand ${SCRATCH}/jelly_on_spes/jelly_on_spes.cpp
  softcell-bullet softcell-mesh-import softcell-render softcell-spe-bodies)
says(0 "" ${SCRATCH}/jelly_on_spes_by_hand ${SCRATCH}/jelly_on_spes/jelly.obj ${SCRATCH}/jelly_by_hand.png)
file(WRITE ${SCRATCH}/spu.cpp "#include \"softcell/jobs/job_system.h\"\n#include \"skin_job.h\"\n"
  "int main() { softcell::dma::AddressSpace memory; softcell::ls_sim::SpeGroup spes(memory, {.spes = 1}); }\n")
pkg_config_builds(spu_by_hand ${SCRATCH}/spu.cpp softcell-spu softcell-spe-bodies)
says(0 "" ${SCRATCH}/spu_by_hand)

# The library is found where it was installed.
file(WRITE ${SCRATCH}/spes.cpp "#include <libspe2.h>\nint main() { return spe_cpu_info_get(SPE_COUNT_USABLE_SPES, -1) > 0 ? 0 : 1; }\n")
pkg_config_builds(spes_by_hand ${SCRATCH}/spes.cpp softcell-libspe2)
says(0 "" ${SCRATCH}/spes_by_hand)

# A Makefile's project and the programs of the tests with the installed commands of an SPU toolchain.
set(lab ${SCRATCH}/lab)
file(COPY ${EXAMPLES}/../tests/toolchain/lab DESTINATION ${SCRATCH})
step("a Makefile's project" make -C ${lab} SPU_CC=${prefix}/bin/softcell-spu-gcc SPU_CXX=${prefix}/bin/softcell-spu-g++
  SPU_AR=${prefix}/bin/softcell-spu-ar SPU_SIZE=${prefix}/bin/softcell-spu-size PPU_EMBEDSPU=${prefix}/bin/softcell-embedspu PPU_CC=gcc
  "PPU_CFLAGS=-O2 -Wall -I${prefix}/include" "PPU_LDFLAGS=-L${prefix}/lib -Wl,-rpath,${prefix}/lib")
says(0 "the SPU says: 3\nthe PPU says: 189" ${lab}/lab)
foreach(program characters simd calendar text_numbers)
  step("program ${program}" ${prefix}/bin/softcell-spu-gcc -Wall ${EXAMPLES}/../tests/programs/sources/${program}.c -lm -o ${SCRATCH}/${program})
endforeach()
says(0 "" ${prefix}/bin/softcell spu run ${SCRATCH}/characters)
says(0 "" ${prefix}/bin/softcell spu run ${SCRATCH}/simd)

# What comes with it.
foreach(file share/doc/softcell/LICENSE share/doc/softcell/README.md share/doc/softcell/examples/saxpy/CMakeLists.txt
    share/man/man1/softcell.1 share/bash-completion/completions/softcell share/zsh/site-functions/_softcell
    share/fish/vendor_completions.d/softcell.fish)
  if(NOT EXISTS ${prefix}/${file})
    message(FATAL_ERROR "${file} was not installed")
  endif()
endforeach()

# Installed headers include installed headers.
file(GLOB_RECURSE headers ${prefix}/include/softcell/*.h)
foreach(header IN LISTS headers)
  file(STRINGS ${header} lines REGEX "^#include \"softcell/")
  foreach(line IN LISTS lines)
    string(REGEX REPLACE "^#include \"([^\"]*)\".*" "\\1" included "${line}")
    if(NOT EXISTS ${prefix}/include/${included})
      message(FATAL_ERROR "${header} includes ${included}, which was not installed")
    endif()
  endforeach()
endforeach()
if(EXISTS ${prefix}/include/softcell/dma/mfc_rules.h)
  message(FATAL_ERROR "headers of softcell's own layers were installed")
endif()

find_program(PYTHON python3 REQUIRED)
step("links of the installed pages" ${PYTHON} ${EXAMPLES}/../tests/docs/check_pages.py --links ${prefix}/share/doc/softcell)

# The installed command on the example's kernels: the right one, and the broken one.
string(REPEAT "0123456789abcdef" 256 bytes)  # 1024 floats
file(WRITE ${SCRATCH}/x.bin "${bytes}")
set(task --in x=${SCRATCH}/x.bin --out y=${SCRATCH}/y.bin:4096 --arg f32:2 @x @y 1024 1 0)
says(0 "put +1 +4096" ${prefix}/bin/softcell spu run ${build}/saxpy.spu.elf ${task})
says(0 "the same outcome under 10 seeds" ${prefix}/bin/softcell spu explore ${build}/saxpy.spu.elf --seeds 10 ${task})
says(1 "buffer y, byte [0-9]+:" ${prefix}/bin/softcell spu explore ${build}/saxpy_no_wait.spu.elf ${task})

file(STRINGS ${copy}/saxpy_no_wait.cpp lines)
set(line 1)
foreach(text IN LISTS lines)
  if(text MATCHES "// too early")
    break()
  endif()
  math(EXPR line "${line} + 1")
endforeach()
says(0 "status 0" ${prefix}/bin/softcell spu run --checked ${build}/saxpy.spu.elf ${task})
says(3 "saxpy_no_wait.cpp:${line}: load-in-flight" ${prefix}/bin/softcell spu run --checked ${build}/saxpy_no_wait.spu.elf ${task})

# The installed files name no file of the source tree.
file(GLOB_RECURSE package ${prefix}/lib/cmake/*.cmake ${prefix}/share/*.cmake)
cmake_path(GET EXAMPLES PARENT_PATH source)
foreach(file IN LISTS package)
  file(READ ${file} text)
  string(FIND "${text}" "${source}/" found)
  if(NOT found EQUAL -1)
    message(FATAL_ERROR "${file} refers to the source tree ${source}")
  endif()
endforeach()
