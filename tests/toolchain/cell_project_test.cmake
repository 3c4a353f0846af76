# Builds a project of the Cell SDK's build environment out of our tree, and a source in C++ with the SDK's spelling of vectors.
include(${CMAKE_CURRENT_LIST_DIR}/../support/steps.cmake)
file(REMOVE_RECURSE ${SCRATCH})
file(COPY ${CMAKE_CURRENT_LIST_DIR}/cell_project DESTINATION ${SCRATCH})
set(cell ${SCRATCH}/cell_project)
step("make with make.footer" make -j2 -C ${cell} CELL_TOP=${CELL_TOP})
says(0 "^3 7 165 42\n$" ${CMAKE_COMMAND} -E env SOFTCELL_CHECKED=1 ${cell}/simple)
says(0 "^checked\n$" cat ${cell}/more/note)
says(0 "Nothing to be done" make -C ${cell} CELL_TOP=${CELL_TOP})
file(TOUCH ${cell}/spu/other_spu.c)
says(0 "embedspu other_spu other_spu other_spu-embed.o\n.*lib_simple_spu.a.* -o simple\n" make -C ${cell} CELL_TOP=${CELL_TOP})
step("make clean with make.footer" make -C ${cell} CELL_TOP=${CELL_TOP} clean)
foreach(made simple more/note spu/simple_spu spu/lib_simple_spu.a more/libmore.a)
  if(EXISTS ${cell}/${made})
    message(FATAL_ERROR "make clean has left ${made}")
  endif()
endforeach()

# Vectors in C++ as the SPU's compilers spell them.
foreach(level -O2 -fsyntax-only)
  step("vectors by their names ${level}" ${BIN}/softcell-spu-g++ -Wall -Werror ${level} ${CMAKE_CURRENT_LIST_DIR}/spelled/vectors.cpp -o ${SCRATCH}/spelled)
endforeach()
says(0 "" ${BIN}/softcell spu run --checked ${SCRATCH}/spelled)

# GNU C's functions in functions, whose addresses need code on the stack.
file(WRITE ${SCRATCH}/nested.c "static int apply(int (*f)(int), int x) { return f(x); }\n"
  "int main(void) { int k = 5; int added(int x) { return x + k++; } return apply(added, 2) + apply(added, 2) == 15 ? 0 : 1; }\n")
says(0 "^$" ${BIN}/softcell-spu-gcc ${SCRATCH}/nested.c -o ${SCRATCH}/nested)
says(0 "" ${BIN}/softcell spu run --checked ${SCRATCH}/nested)
