# Builds a Makefile project out of our tree with the commands of the toolchain and runs it.
include(${CMAKE_CURRENT_LIST_DIR}/../support/steps.cmake)
file(REMOVE_RECURSE ${SCRATCH})
file(COPY ${CMAKE_CURRENT_LIST_DIR}/lab DESTINATION ${SCRATCH})
set(lab ${SCRATCH}/lab)
set(tools SPU_CC=${BIN}/softcell-spu-gcc SPU_CXX=${BIN}/softcell-spu-g++ SPU_AR=${BIN}/softcell-spu-ar SPU_SIZE=${BIN}/softcell-spu-size
  PPU_EMBEDSPU=${BIN}/softcell-embedspu PPU_CC=gcc "PPU_CFLAGS=-O2 -Wall -I${INCLUDE}" "PPU_LDFLAGS=-L${LIB} -Wl,-rpath,${LIB}")
says(0 "note: without meaning on a PC: -mbranch-hints -funroll-loops" make -C ${lab} ${tools})
says(0 "the SPU says: 3\nthe PPU says: 189" ${CMAKE_COMMAND} -E env SOFTCELL_DMA=lazy ${lab}/lab)
says(0 "the SPU says: 3\nthe PPU says: 189\n$" ${CMAKE_COMMAND} -E env SOFTCELL_CHECKED=1 ${lab}/lab)
says(0 "" make -C ${lab} ${tools})  # nothing to do

# The same with its wait left out: the checked flavour knows the line.
step("clean" make -C ${lab} clean)
step("make without the wait" make -C ${lab} ${tools} "SPU_CFLAGS=-O2 -DFACTOR=3 -DFORGETS -Ispu")
says(0 "finding: SPE 0, kernel scale, more_help.cpp:5: load-in-flight" ${CMAKE_COMMAND} -E env SOFTCELL_CHECKED=1 SOFTCELL_DMA=lazy ${lab}/lab)

# Other ways to call the commands.
set(gcc ${BIN}/softcell-spu-gcc)
says(0 "^spu\n$" ${gcc} -dumpmachine)
says(0 "softcell-spu-gcc \\(softcell\\)" ${gcc} --version)
says(0 "stack-size=BYTES" ${gcc} --help)
says(0 "value 1" sh -c "echo 'value __SPU__' | ${gcc} -E -P -U__SPU__ -D__SPU__=1 -x c -")
says(0 "main.o: .*help.h" ${gcc} -MM -I${lab}/spu ${lab}/spu/main.c)
step("one call for all" ${gcc} -DFACTOR=2 -I${lab}/spu ${lab}/spu/main.c ${lab}/spu/help.c ${lab}/spu/more_help.cpp
  -Wl,-z,stack-size=8192 -o ${lab}/whole)
says(0 "\nwhole .* 262144\n" ${BIN}/softcell spu budget --checked ${lab}/whole)
step("a partial link" ${BIN}/softcell-spu-ld -r -o ${lab}/part.o ${lab}/spu/help.o ${lab}/spu/more_help.o)
step("a link by ld" ${BIN}/softcell-spu-ld -o ${lab}/by_ld ${lab}/spu/main.o ${lab}/part.o -lm)
says(0 "_end" ${BIN}/softcell-spu-nm ${lab}/by_ld)
says(0 "elf32-x86-64" ${BIN}/softcell-spu-objdump -h ${lab}/by_ld)
file(WRITE ${lab}/options "-c -I${lab}/spu\n'-DFACTOR=4'  ${lab}/spu/more_help.cpp -o ${lab}/from_file.o")
step("options from a file" ${gcc} @${lab}/options)

# What cannot be done is said in one sentence.
file(WRITE ${lab}/code.s "il $3, 1\n")
file(WRITE ${lab}/wrong.c "int main(void) { return undeclared; }\n")
says(2 "there are no input files" ${gcc} -O2)
says(2 "unknown option --frobnicate" ${gcc} --frobnicate a.c)
says(2 "SPU instructions cannot run" ${gcc} -c ${lab}/code.s)
says(2 "-S: there are no SPU instructions here" ${gcc} -S ${lab}/wrong.c)
says(2 "-lnowhere: there is no libnowhere.a" ${gcc} ${lab}/spu/main.o -lnowhere)
says(2 "-o names one file" ${gcc} -c ${lab}/spu/main.c ${lab}/spu/help.c -o ${lab}/x.o)
says(2 "a stack has 16 to 262144 bytes" ${gcc} ${lab}/spu/main.o -Wl,-z,stack-size=1)
says(2 "-x fortran: only C and C\\+\\+" ${gcc} -x fortran a.f)
says(1 "wrong.c:1:25: error: [^\n]*undeclared" ${gcc} -c ${lab}/wrong.c -o ${lab}/wrong.o)
if(EXISTS ${lab}/wrong.o)
  message(FATAL_ERROR "an object was written of a source with an error")
endif()
says(2 "usage: softcell-embedspu" ${BIN}/softcell-embedspu symbol)
says(2 "is no name of a variable" ${BIN}/softcell-embedspu 1st ${lab}/whole ${lab}/e.o)
says(2 "is no ELF file" ${BIN}/softcell-embedspu name ${lab}/Makefile ${lab}/e.o)
says(2 "cannot read" ${BIN}/softcell-embedspu name ${lab}/nothing ${lab}/e.o)
says(2 "-m32: softcell's libspe2 has 64 bits" ${BIN}/softcell-embedspu -m32 name ${lab}/whole ${lab}/e.o)
