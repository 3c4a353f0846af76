# softcell as a part of somebody's project, by add_subdirectory: what it leaves alone, and what it says when something is missing.

set(project ${SCRATCH}/somebody)
set(build ${SCRATCH}/build)
file(REMOVE_RECURSE ${SCRATCH})
file(COPY ${CMAKE_CURRENT_LIST_DIR}/subproject/ DESTINATION ${project})

# expect(<what> <0 or 1: it succeeds or fails> <regular expression of what it prints> <command>...)
function(expect purpose expected_status expected)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(status)
    set(status 1)
  endif()
  string(REGEX REPLACE "[ \n]+" " " words "${output}")
  if(NOT status EQUAL expected_status OR NOT words MATCHES "${expected}")
    message(FATAL_ERROR "${purpose}: expected status ${expected_status} and \"${expected}\", got ${status}:\n${output}")
  endif()
endfunction()
set(configure ${CMAKE_COMMAND} -S ${project} -B ${build} -G ${GENERATOR} -DSOFTCELL=${SOURCE} -DCMAKE_CXX_COMPILER=${COMPILER}
  -DCMAKE_BUILD_TYPE=Debug -DCMAKE_CXX_FLAGS_DEBUG=-O0 -DCMAKE_CXX_COMPILER_LAUNCHER=${LAUNCHER})

expect("a component that there is not" 1
  "SOFTCELL_COMPONENTS: softcell has no component 'bodies'; its components are spu, libspe2, soft_bodies, mesh_import, bullet, box2d, spe_bodies, render\\."
  ${configure} "-DSOFTCELL_COMPONENTS=spu\;bodies")
expect("a library that is not installed" 1
  "softcell's component box2d needs Box2D 2\\.4, which was not found; on Debian it is in the package libbox2d-dev\\."
  ${configure} -DSOFTCELL_COMPONENTS=box2d -DCMAKE_DISABLE_FIND_PACKAGE_box2d=ON)
expect("a project without the assembler" 1
  "softcell_embed_spu_images\\(somebody\\): images are embedded by the assembler; enable it, as in project\\(\\.\\.\\. LANGUAGES CXX ASM\\)\\."
  ${configure} -DSOFTCELL_COMPONENTS=spu -DCMAKE_DISABLE_FIND_PACKAGE_box2d=OFF)
expect("a component that is not built" 1
  "softcell is a part of this project, built with SOFTCELL_COMPONENTS \"spu\": without box2d\\."
  ${configure} -DSOFTCELL_COMPONENTS=spu -DWITH_ASSEMBLER=ON "-DFIND_COMPONENTS=COMPONENTS\;spu\;box2d")

foreach(stack 0 abc 300000)
  expect("a stack of ${stack} bytes" 1 "softcell_add_spu_kernel\\(sloppy\\): STACK_BYTES is ${stack}; a whole number from 1 to 262144 was expected"
    ${CMAKE_COMMAND} -S ${project} -B ${SCRATCH}/stack -G ${GENERATOR} -DSOFTCELL=${SOURCE} -DCMAKE_CXX_COMPILER=${COMPILER}
    -DSOFTCELL_COMPONENTS=spu -DWITH_ASSEMBLER=ON -DSTACK_BYTES=${stack})
endforeach()

# All libraries, and nothing else: no tests but the project's own, no programs but the project's own, and warnings stop nobody.
expect("configuring all components" 0 "" ${configure} -DWITH_ASSEMBLER=ON
  "-DSOFTCELL_COMPONENTS=spu\;libspe2\;soft_bodies\;mesh_import\;bullet\;box2d\;spe_bodies" "-DFIND_COMPONENTS=COMPONENTS\;spu\;bullet")
expect("its tests" 0 "Test #1: spu_syntax\\.sloppy\\.sloppy .*Test #2: somebody Total Tests: 2 " ${CMAKE_CTEST_COMMAND} --test-dir ${build} -N)
file(READ ${build}/compile_commands.json commands)
if(NOT commands MATCHES "ppu/spe_bodies/" OR commands MATCHES "-Werror|${SOURCE}/(demos|tool|render|tests)/")
  message(FATAL_ERROR "softcell builds more than its libraries, or makes warnings errors:\n${commands}")
endif()

expect("configuring" 0 "" ${configure} -DSOFTCELL_COMPONENTS=spu -DSOFTCELL_UNITY_BUILD=ON "-DFIND_COMPONENTS=COMPONENTS\;spu\;OPTIONAL_COMPONENTS\;box2d")
expect("building" 0 "unused" ${CMAKE_COMMAND} --build ${build} --parallel 2)
expect("testing" 0 "100% tests passed" ${CMAKE_CTEST_COMMAND} --test-dir ${build} --output-on-failure)
if(NOT EXISTS ${build}/somebody)
  message(FATAL_ERROR "the project's program is not where the project has its programs")
endif()
expect("installing" 0 "" ${CMAKE_COMMAND} --install ${build} --prefix ${SCRATCH}/prefix)
file(GLOB_RECURSE installed RELATIVE ${SCRATCH}/prefix ${SCRATCH}/prefix/*)
if(NOT installed STREQUAL "bin/somebody")
  message(FATAL_ERROR "the project installs: ${installed}")
endif()

# Warnings of one's own kernels are errors for who asks.
expect("configuring with errors" 0 "" ${configure} -DKERNEL_OPTIONS=WARNINGS_AS_ERRORS)
expect("building with errors" 1 "error: unused variable" ${CMAKE_COMMAND} --build ${build} --target sloppy_image)
