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

# The same with its wait left out: the checked image knows the line.
step("clean" make -C ${lab} clean)
step("make without the wait" make -C ${lab} ${tools} "SPU_CFLAGS=-O2 -DFACTOR=3 -DFORGETS -Ispu")
says(0 "finding: SPE 0, kernel scale, more_help.cpp:5: load-in-flight" ${CMAKE_COMMAND} -E env SOFTCELL_CHECKED=1 SOFTCELL_DMA=lazy ${lab}/lab)

# Other ways to call the commands.
set(gcc ${BIN}/softcell-spu-gcc)
says(0 "version" ${gcc} -v)
says(0 "#define __SPU__ 1\n" sh -c "${gcc} -E -dM -x c /dev/null")
says(1 "undeclared" sh -c "printf 'int a = undeclared\\073\n' | ${gcc} -fsyntax-only -x c -")
says(0 "^$" sh -c "cd ${lab} && ${gcc} -fsyntax-only -Ispu -DFACTOR=2 spu/main.c && test ! -e a.out -a ! -e main.o")
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

file(WRITE ${lab}/constant.c "int main(void) { return sizeof(L'a'); }\n")
step("an option that changes the language" ${gcc} -fshort-wchar ${lab}/constant.c -o ${lab}/constant)
says(1 "ended with status 2" ${BIN}/softcell spu run ${lab}/constant)

says(0 "^$" sh -c "printf '#include \"spu/help.h\"\nint main(void) { return 7\\073 }\n' | ${gcc} -I${lab} -x c - -o ${lab}/of_input")
says(1 "ended with status 7" ${BIN}/softcell spu run --checked ${lab}/of_input)
file(WRITE ${lab}/unchecked.c "#ifdef SOFTCELL_CHECKED\nint nowhere(void);\n#else\nint nowhere(void) { return 0; }\n#endif\n"
  "int main(void) { return nowhere(); }\n")
says(0 "undefined[^\n]*nowhere.*gets no checked image: it does not link\n$" ${gcc} ${lab}/unchecked.c -o ${lab}/unchecked)

# Options for symbols hold for both images, and those of the preprocessor for the preprocessor only.
file(WRITE ${lab}/symbols.c "#include <stdlib.h>\nextern char place[]; void *__real_malloc(size_t); static int count;\n"
  "void *__wrap_malloc(size_t n) { count += MORE; return __real_malloc(n); }\n"
  "int main(void) { free(malloc(3)); return ((unsigned)place & 0x3ffff) + count; }\n")
says(0 "^$" ${gcc} -Wp,-MMD,${lab}/symbols.of_wp -Xpreprocessor -DMORE=5 ${lab}/symbols.c -Wl,--defsym=place=0x20 -Wl,--wrap,malloc
  -o ${lab}/symbols)
says(0 "symbols: .*symbols.c" ${CMAKE_COMMAND} -E cat ${lab}/symbols.of_wp)
foreach(image "" --checked)
  says(1 "ended with status 37" ${BIN}/softcell spu run ${image} ${lab}/symbols)
endforeach()

file(WRITE ${lab}/assembly.c "int main(void) {\n  int x = 1;\n  __asm__ volatile(\"ai %0,%0,1\" : \"+r\"(x));\n  return x;\n}\n")
says(1 "assembly.c:3: Error.*assembly.c: its inline assembly has SPU instructions, which cannot run" ${gcc} -g -c ${lab}/assembly.c
  -o ${lab}/assembly.o)
step("no object of it" test ! -e ${lab}/assembly.o)
file(WRITE ${lab}/empty.c "void f(void) { __asm__ volatile(\"\" : : : \"memory\"); }\n")
says(0 "^$" ${gcc} -c ${lab}/empty.c -o ${lab}/empty.o)

says(0 "^[0-9.]+\n$" ${gcc} -dumpversion)
says(0 "^libgcc.a\n$" ${gcc} -print-libgcc-file-name)
says(0 "^crt1.o\n$" ${gcc} -print-file-name=crt1.o)
says(0 "note: without meaning on a PC: --param=max-inline-insns-auto=5 -save-temps -pg" ${gcc} --param=max-inline-insns-auto=5 -save-temps
  -pg -DFACTOR=2 -I${lab}/spu -c ${lab}/spu/main.c -o ${lab}/main.o)
says(2 "main.o is an object that was not linked; link it with softcell-spu-gcc" ${BIN}/softcell-embedspu name ${lab}/main.o ${lab}/x.o)
says(2 "softcell is no SPU program; embed what softcell-spu-gcc has linked" ${BIN}/softcell-embedspu name ${BIN}/softcell ${lab}/x.o)
file(WRITE ${lab}/old.cpp "int f() { register int i = 3; return i; }\n")
says(0 "note: -std=gnu\\+\\+98: C\\+\\+ is compiled as C\\+\\+17 here" ${BIN}/softcell-spu-g++ -Werror -std=gnu++98 -c ${lab}/old.cpp -o ${lab}/old.o)
says(0 "note: -fexceptions: programs have no exceptions" ${BIN}/softcell-spu-g++ -fexceptions -c ${lab}/old.cpp -Wno-register -o ${lab}/old.o)

# The headers of the PPU side have no warnings of their own.
file(WRITE ${lab}/pedantic.c "#include <cbea_map.h>\n#include <libspe2.h>\n#include <libsync.h>\n#include <ppu_intrinsics.h>\nint main(void) { return 0; }\n")
foreach(standard -std=c99 -ansi)
  says(0 "^$" gcc ${standard} -pedantic -Wall -Wextra -Werror -I${INCLUDE} -I${SHARED} -c ${lab}/pedantic.c -o ${lab}/pedantic.o)
endforeach()

# Warnings are those that the program asks for.
file(WRITE ${lab}/warned.cpp "struct s { int a, b, c; };\nint b;\nint f(int b, unsigned u) { struct s q = {1}; return b < u ? q.a : 0; }\n")
foreach(compiler ${gcc} ${BIN}/softcell-spu-g++)
  says(0 "^$" ${compiler} -Werror -c ${lab}/warned.cpp -o ${lab}/warned.o)
endforeach()
says(1 "Werror=shadow" ${BIN}/softcell-spu-g++ -Werror -Wshadow -c ${lab}/warned.cpp -o ${lab}/warned.o)
says(1 "Werror=unused-parameter" sh -c "printf 'int f(int a) { return 1\\073 }\n' | ${gcc} -Wall -Wextra -Werror -c -x c - -o ${lab}/warned.o")

# Findings of calls of the C library have the line of the program.
file(WRITE ${lab}/early.c "#include <spu_mfcio.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
static char text[128] __attribute__((aligned(128))); static uint64_t place[1] __attribute__((aligned(16)));
int main(uint64_t spe, uint64_t argp, uint64_t envp) {
  mfc_get(place, argp, 8, 0, 0, 0); mfc_write_tag_mask(1); mfc_read_tag_status_all(); argp = place[0]; mfc_get(text, argp, 128, 0, 0, 0);
  int n = strlen(text);
  puts(text);
  char *copy = strdup(text);
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();
  free(copy);
  return n > 1000;
}
")
step("a program that reads too early" ${gcc} -g ${lab}/early.c -o ${lab}/early)
step("512 zeros" sh -c "head -c 512 /dev/zero > ${lab}/zeros")
foreach(found "early.c:8 \\(strlen\\): load-in-flight: load of 1 byte at text" "early.c:9 \\(puts\\): load-in-flight" "early.c:10 \\(strdup\\): load-in-flight")
  says(3 "${found}" ${BIN}/softcell spu run --checked ${lab}/early --inout z=${lab}/zeros --arg @z)
endforeach()

says(0 "" ${BIN}/softcell spu run ${lab}/early --inout z=${lab}/zeros --arg @z --coverage ${lab}/early.info)
says(0 "^SF:[^\n]*early.c\n$" grep "^SF:" ${lab}/early.info)

# The blocks of the heap are objects like variables.
file(WRITE ${lab}/heap.c "#include <malloc.h>
#include <spu_mfcio.h>
#include <stdlib.h>
#include <string.h>
volatile unsigned sink;
static unsigned variable; static uint64_t place[1] __attribute__((aligned(16)));
int main(uint64_t spe, uint64_t argp, uint64_t envp) {
  volatile unsigned *b = malloc(40), *c = memalign(128, 128); mfc_get(place, argp, 8, 0, 0, 0); mfc_write_tag_mask(1); mfc_read_tag_status_all(); argp = place[0];
  b = realloc((void *)b, 64);
  memset((void *)b, 0, 64);
#if CASE == 1
  b[16] = 5;
#elif CASE == 2
  free((void *)b); sink = b[2];
#elif CASE == 3
  free((void *)b); free((void *)b); b = NULL;
#elif CASE == 4
  mfc_get(c, argp, 256, 0, 0, 0); mfc_write_tag_mask(1); mfc_read_tag_status_all();
#elif CASE == 5
  free(&variable);
#elif CASE == 6
  mfc_put(b, argp, 64, 0, 0, 0); free((void *)b); mfc_write_tag_mask(1); mfc_read_tag_status_all(); b = NULL;
#else
  free(malloc(0)); free(calloc(3, 5)); free(NULL);
  mfc_get(c, argp, 128, 0, 0, 0); mfc_write_tag_mask(1); mfc_read_tag_status_all();
  b = realloc((void *)b, 4000); b[999] = 1; b = realloc((void *)b, 32); b[7] = 2;
  char *copy = strdup(\"block\"); copy[5] = 0; free(copy);
#endif
  if (CASE != 2) free((void *)b);
  free((void *)c);
  return 0;
}
")
set(findings "^$" "heap.c:12: outside-objects: store of 4 bytes at the heap [^\n]*: it lies behind a block of 64 bytes"
  "heap.c:14: outside-objects: load of 4 bytes at the heap [^\n]*: it lies in a block of 64 bytes that was freed"
  "heap.c:16: outside-objects: free of the heap [^\n]*: the block was freed before"
  "heap.c:18: outside-objects: get tag 0[^\n]*: it passes the end of a block of 128 bytes"
  "heap.c:20: outside-objects: free of variable [^\n]*: no block of the heap begins there"
  "heap.c:22: store-in-flight: free of the heap [^\n]*, and whoever gets these bytes next stores there. in flight: put of 64 bytes[^\n]*heap.c:22")
set(case 0)
foreach(found IN LISTS findings)
  step("case ${case} of the heap" ${gcc} -g -DCASE=${case} ${lab}/heap.c -o ${lab}/heap)
  set(status 3)
  if(case EQUAL 0)
    set(status 0)
    set(found "")
  endif()
  says(${status} "${found}" ${BIN}/softcell spu run --checked ${lab}/heap --inout z=${lab}/zeros --arg @z)
  math(EXPR case "${case} + 1")
endforeach()

# A cache in software: 64 KB of words through 4 KB of lines, and beside it one for reading.
file(WRITE ${lab}/cached.c "#include <spu_mfcio.h>
#define CACHE_NAME words
#define CACHED_TYPE unsigned int
#define CACHE_LOG2NSETS 3
#include <cache-api.h>
#undef CACHE_NAME
#undef CACHED_TYPE
#undef CACHE_LOG2NSETS
#define CACHE_NAME vectors
#define CACHED_TYPE vec_uint4
#define CACHE_TYPE CACHE_TYPE_RO
#define CACHE_LOG2NSETS 2
#define CACHE_LOG2NWAY 0
#define CACHELINE_LOG2SIZE 8
#include <cache-api.h>
enum { COUNT = 16384 };
static unsigned int block[COUNT / 4] __attribute__((aligned(128)));
static uint64_t place[1] __attribute__((aligned(16)));
int main(uint64_t spe, uint64_t argp, uint64_t envp) {
  unsigned int i, wrong = 0, *kept;
  (void)spe, (void)envp;
  mfc_get(place, argp, 8, 0, 0, 0); mfc_write_tag_mask(1); mfc_read_tag_status_all(); argp = place[0];
  for (i = 0; i < COUNT; ++i) cache_wr(words, argp + 4 * (i * 5 % COUNT), i);
  for (i = 0; i < COUNT; i += 7) wrong += cache_rd(words, argp + 4 * (i * 5 % COUNT)) != i;
  kept = cache_rw(words, argp + 400);
  cache_lock(words, kept);
  for (i = 0; i < COUNT; i += 32) cache_wr(words, argp + 4 * i + 16, cache_rd(words, argp + 4 * i + 16) + 1000000);
  *kept = 77;
  cache_unlock(words, kept);
  for (i = 0; i < 16; ++i) cache_touch(words, argp + 128 * i);
  cache_wait(words, cache_touch(words, argp + 128));
  cache_flush(words);
  for (i = 0; i < COUNT; i += 64) wrong += spu_extract(cache_rd(vectors, argp + 4 * i), 0) * 5 % COUNT != i;
  for (i = 0; i < 4; ++i) {
    unsigned int k;
    mfc_get(block, argp + sizeof block * i, sizeof block, 9, 0, 0);
    mfc_write_tag_mask(1 << 9);
    mfc_read_tag_status_all();
    for (k = 0; k < COUNT / 4; ++k) {
      const unsigned int at = COUNT / 4 * i + k, expected = at == 100 ? 77 : at % 32 == 4 ? block[k] - 1000000 : block[k];
      wrong += at == 100 ? block[k] != 77 : expected * 5 % COUNT != at;
    }
  }
  return wrong != 0;
}
")
step("64 KB of zeros" sh -c "head -c 65536 /dev/zero > ${lab}/main_storage")
foreach(compiler "${gcc};-std=c99" "${BIN}/softcell-spu-g++;-x;c++")
  step("a cache in software" ${compiler} -Wall -Wextra -Werror -g -O2 ${lab}/cached.c -o ${lab}/cached)
  foreach(way --checked "--dma;lazy" "--dma;random:3")
    says(0 "" ${BIN}/softcell spu run ${way} ${lab}/cached --inout x=${lab}/main_storage --arg @x)
  endforeach()
endforeach()
says(1 "define CACHE_NAME, the name of a cache" sh -c "echo '#include <cache-api.h>' | ${gcc} -c -x c - -o ${lab}/x.o")

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
file(WRITE ${lab}/fpscr.c "#include <spu_intrinsics.h>\nint main(void) { return (int)spu_extract(spu_mffpscr(), 0); }\n")
says(1 "fpscr.c:2:[0-9]+: error: [^\n]*FPSCR is not modelled on the host" ${gcc} -c ${lab}/fpscr.c -o ${lab}/fpscr.o)
file(WRITE ${lab}/folders.c "#include <sys/stat.h>\n#include <unistd.h>\nint main(void) {\n  char text[9];\n  mkdir(\"a\", 0700);\n  return getcwd(text, 9) == 0;\n}\n")
says(1 "folders.c:5:[0-9]+: error: [^\n]*mkdir\\(\\) is not served here: the PPU side may call it for its SPEs" ${gcc} -c ${lab}/folders.c -o ${lab}/folders.o)
says(1 "folders.c:6:[0-9]+: error: [^\n]*getcwd\\(\\) is not served here" ${gcc} -c ${lab}/folders.c -o ${lab}/folders.o)
file(WRITE ${lab}/fdopen.c "#include <stdio.h>\nint main(void) { return fdopen(1, \"w\") == NULL; }\n")
says(1 "fdopen.c:2:[0-9]+: error: [^\n]*fdopen\\(\\) is no call of the PPU side: open the file with fopen\\(\\)" ${gcc} -c ${lab}/fdopen.c -o ${lab}/fdopen.o)
file(WRITE ${lab}/ea.c "extern __ea int counter;\nint main(void) { return 0; }\n")
file(WRITE ${lab}/ea_cache.c "#include <ea.h>\nint main(void) { return 0; }\n")
says(1 "ea.c:1:[0-9]+: error: [^\n]*there is no address space __ea here" ${gcc} -c ${lab}/ea.c -o ${lab}/ea.o)
says(1 "ea_cache.c:1:\n[^\n]*#error there is no address space __ea here" ${gcc} -c ${lab}/ea_cache.c -o ${lab}/ea.o)
file(WRITE ${lab}/large.c "static char bytes[262144]; int main(void) { bytes[1] = 1; return bytes[2]; }\n")
says(1 "does not fit into the local store: code and data take 262[0-9]+ bytes and the stack 4096, [0-9]+ more than its 262144\n$" ${gcc} ${lab}/large.c -o ${lab}/large)
says(1 "and the stack 262144, [0-9]+ more" ${gcc} ${lab}/spu/main.o ${lab}/part.o -Wl,-z,stack-size=262144 -o ${lab}/large)

# What several sources of a program define.
file(WRITE ${lab}/one.c "int chosen(void) { return 1; }\n")
file(WRITE ${lab}/two.c "int chosen(void) { return 2; }\n")
file(WRITE ${lab}/calls.c "int chosen(void); int main(void) { return chosen(); }\n")
foreach(sources "one.c;two.c" "two.c;one.c")
  list(TRANSFORM sources PREPEND ${lab}/)
  says(1 "multiple definition of `chosen'[^\n]*first defined here\n$" ${gcc} ${sources} ${lab}/calls.c -o ${lab}/twice)
endforeach()
file(WRITE ${lab}/old.c "int shared; int other(void); int main(void) { return shared + other(); }\n")
file(WRITE ${lab}/value.c "int shared = 5; int other(void) { return 0; }\n")
foreach(sources "old.c;value.c" "value.c;old.c")
  list(TRANSFORM sources PREPEND ${lab}/)
  step("a variable that two sources of old C define" ${gcc} ${sources} -o ${lab}/old)
  says(1 "ended with status 5" ${BIN}/softcell spu run ${lab}/old)
endforeach()
file(WRITE ${lab}/own.c "#include <stdlib.h>\n#include <string.h>\nstatic char pool[64];\nvoid* malloc(size_t n) { return pool; }\n"
  "int main(void) { return strdup(\"a\") == pool && calloc(1, 1) != NULL ? 7 : 8; }\n")
step("a function of the library's name" ${gcc} -w ${lab}/own.c -o ${lab}/own)
says(1 "ended with status 7" ${BIN}/softcell spu run ${lab}/own)
says(1 "ended with status 7" ${BIN}/softcell spu run --checked ${lab}/own)

# A standard stream that a program reopens is its own, and not that of the figures.
file(WRITE ${lab}/reopens.c "#include <stdio.h>\nint main(void) { freopen(\"reopened.txt\", \"w\", stdout); puts(\"in a file\"); return 0; }\n")
step("a program that reopens standard output" ${gcc} ${lab}/reopens.c -o ${lab}/reopens)
says(0 "local store: text[^\n]*\nin a file\n$" sh -c "cd ${lab} && ${BIN}/softcell spu run reopens && cat reopened.txt")

# A main in an archive, and none.
file(WRITE ${lab}/main_of_archive.c "int main(void) { return 6; }\n")
step("an object with a main" ${gcc} -c ${lab}/main_of_archive.c -o ${lab}/main_of_archive.o)
step("an archive with a main" ${BIN}/softcell-spu-ar rcs ${lab}/libmain.a ${lab}/main_of_archive.o)
step("a main in an archive" ${gcc} ${lab}/value.c -L${lab} -lmain -o ${lab}/main_of_archive)
says(1 "ended with status 6" ${BIN}/softcell spu run ${lab}/main_of_archive)
says(1 "^[^\n]*there is no main\n$" ${gcc} ${lab}/value.c -o ${lab}/no_main)

# The SPU's compilers know no operating system.
file(WRITE ${lab}/system.c "struct systems { int linux, unix; };\n#if defined(__linux__) || defined(__unix__)\n#error a system\n#endif\n")
step("a source with names of systems" ${gcc} -c ${lab}/system.c -o ${lab}/system.o)

# Variables of a thread, of which there is one.
file(WRITE ${lab}/threads.c "static __thread int a = 3; _Thread_local int b;\n"
  "int main(void) { static __thread int c = 1; b += 2; a += 2; return a + b + c; }\n")
step("variables of a thread" ${gcc} ${lab}/threads.c -o ${lab}/threads)
says(1 "ended with status 8" ${BIN}/softcell spu run ${lab}/threads)
file(WRITE ${lab}/threads.cpp "int main() {\n  thread_local int a = 3;\n  return ++a;\n}\n")
says(1 "threads.cpp:2:[0-9]+: error: one thread runs in a local store: leave out thread_local" ${BIN}/softcell-spu-g++ ${lab}/threads.cpp -o ${lab}/threads)
says(1 "one thread runs in a local store: leave out thread_local" ${BIN}/softcell-spu-g++ -Uthread_local ${lab}/threads.cpp -o ${lab}/threads)

# C++ as the SPU's compiler takes it: a main without a return returns 0 and a function without one is a warning. (Clang refuses both.)
set(gxx ${BIN}/softcell-spu-g++)
if(COMPILER STREQUAL "GNU")
  file(WRITE ${lab}/no_return.cpp "#include <stdio.h>\n#include <spu_intrinsics.h>\nint main(PARAMETERS) { printf(\"hello\\n\"); }\n")
  foreach(parameters "" "unsigned long long, unsigned long long, unsigned long long" "vec_uint4, vec_uint4, vec_uint4" "int, char**")
    says(0 "^$" ${gxx} "-DPARAMETERS=${parameters}" ${lab}/no_return.cpp -o ${lab}/no_return)
    says(0 "hello\n" ${BIN}/softcell spu run ${lab}/no_return)
    says(0 "hello\n" ${BIN}/softcell spu run --checked ${lab}/no_return)
  endforeach()
  file(WRITE ${lab}/enumeration.cpp "enum Shape { kRound, kFlat };\n"
    "static int area(Shape shape) { switch (shape) { case kRound: return 1; case kFlat: return 2; } }\n"
    "int main() { volatile Shape shape = kFlat; return area(shape); }\n")
  says(0 "warning: [^\n]*\\[-Wreturn-type\\]" ${gxx} ${lab}/enumeration.cpp -o ${lab}/enumeration)
  says(0 "^$" ${gxx} -w ${lab}/enumeration.cpp -o ${lab}/enumeration)
  says(1 "ended with status 2" ${BIN}/softcell spu run ${lab}/enumeration)
endif()

# Dependencies of programs that one call compiles and links.
file(MAKE_DIRECTORY ${lab}/depends)
file(WRITE ${lab}/depends/n.h "#define N 3\n")
file(WRITE "${lab}/depends/a b.c" "#include \"n.h\"\nint other(void) { return N; }\n")
file(WRITE ${lab}/depends/main.c "#include \"n.h\"\nint other(void);\nint main(void) { return other() - N; }\n")
set(gcc_there cd ${lab}/depends && ${gcc})
string(REPLACE ";" " " gcc_there "${gcc_there}")
set(rules "^p.elf: main.c n.h\np.elf: a\\\\ b.c n.h\n$")
says(0 "${rules}" sh -c "${gcc_there} -MMD main.c 'a b.c' -o p.elf && cat p.d")
says(0 "${rules}" sh -c "${gcc_there} -MD -MF z.d main.c 'a b.c' -o p.elf && cat z.d")
says(0 "^a\\\\ b.o: a\\\\ b.c n.h\n$" sh -c "${gcc_there} -MMD -c 'a b.c' && cat 'a b.d'")
says(0 "^mine: main.c n.h\n" sh -c "${gcc_there} -MMD -MT mine main.c 'a b.c' && cat main.d")

# Another make of compiler than softcell was built with.
set(other clang++)
set(refusal "which is Clang; this softcell was built with GCC: name a g[+][+]")
if(COMPILER STREQUAL Clang)
  set(other g++)
  set(refusal "which is no Clang; this softcell was built with Clang: name a clang[+][+]")
endif()
says(1 "^softcell-spu-gcc: SOFTCELL_CXX is [a-z+]*, ${refusal}\n$" ${CMAKE_COMMAND} -E env SOFTCELL_CXX=${other} ${gcc} ${lab}/value.c -c
  -o ${lab}/value.o)

# Folders that are not there.
says(0 "^$" sh -c "cd ${lab} && TMPDIR=${lab}/nowhere ${gcc} value.c main_of_archive.c -o value")
says(1 "^softcell-spu-gcc: cannot write ${lab}/nowhere/value: No such file or directory\n$" ${gcc} ${lab}/value.c ${lab}/main_of_archive.c
  -o ${lab}/nowhere/value)

# What the C library's calls of the PPU side read and write.
file(WRITE ${lab}/prints.c "#include <spu_mfcio.h>\n#include <stdio.h>\nchar text[128] __attribute__((aligned(128)));\n"
  "int main(unsigned long long spe, unsigned long long argp) {\n  static unsigned long long ea[2] __attribute__((aligned(16)));\n"
  "  mfc_write_tag_mask(2);\n  mfc_get(ea, argp, 16, 1, 0, 0);\n  mfc_read_tag_status_all();\n  mfc_get(text, ea[0], 128, 1, 0, 0);\n  if (GETS) printf(\"%s\\n\", text);\n  mfc_read_tag_status_all();\n"
  "  mfc_put(text, ea[0], 128, 1, 0, 0);\n  if (!GETS) sprintf(text, \"NEW\");\n  mfc_read_tag_status_all();\n  return 0;\n}\n")
file(WRITE ${lab}/128.bin "FRESH")
foreach(i RANGE 1 123)
  file(APPEND ${lab}/128.bin "\n")
endforeach()
foreach(gets 1 0)
  step("a program that prints" ${gcc} -g -DGETS=${gets} ${lab}/prints.c -o ${lab}/prints)
  set(rule "load-in-flight: load of [0-9]+ bytes? at text")
  if(NOT gets)
    set(rule "store-in-flight: store of [0-9]+ bytes? at text")
  endif()
  says(3 "${rule} [^\n]*in flight: [a-z]+ of 128 bytes, tag 1, issued at prints.c:" ${BIN}/softcell spu run --checked ${lab}/prints
    --inout b=${lab}/128.bin --arg @b 0)
endforeach()

# The names that an SPU's linker gives to the ends of code and data.
file(WRITE ${lab}/ends.c "extern char __etext, _etext, etext, _edata, edata, __bss_start, _end, end;\n"
  "const int constant = 7; int data = 5, zero[40];\n"
  "#define RISE(a, b) ((char*)(a) <= (char*)(b))\n"
  "int main(void) {\n"
  "  int ok = &_etext == &etext && &_etext == &__etext && &_edata == &edata && &_end == &end;\n"
  "  ok &= RISE(&main, &_etext) && RISE(&_etext, &constant) && RISE(&_etext, &data) && RISE(&data + 1, &_edata);\n"
  "  return ok && RISE(&_edata, &__bss_start) && RISE(&__bss_start, zero) && RISE(zero + 40, &_end) ? 9 : 1;\n}\n")
step("a program that asks where things end" ${gcc} ${lab}/ends.c -o ${lab}/ends)
says(1 "ended with status 9" ${BIN}/softcell spu run ${lab}/ends)
says(1 "ended with status 9" ${BIN}/softcell spu run --checked ${lab}/ends)
file(WRITE ${lab}/own_end.c "int end = 4; static int edata(void) { return end + 1; } int main(void) { return edata(); }\n")
step("names of the linker that a program has itself" ${gcc} ${lab}/own_end.c -o ${lab}/own_end)
says(1 "ended with status 5" ${BIN}/softcell spu run ${lab}/own_end)

# Files that are named relative to where the compiler ran.
file(MAKE_DIRECTORY ${lab}/from ${lab}/headers)
file(WRITE ${lab}/headers/covered.h "static inline int covered(volatile int* number) { return *number * 2; }\n")
file(WRITE ${lab}/headers/also.h "static inline int also(volatile int* number) { return *number * 3; }\n")
file(WRITE ${lab}/covered.c "#include <covered.h>\n#include \"headers/also.h\"\nvolatile int number = 1;\n"
  "int main(void) { return covered(&number) + also(&number); }\n")
step("a program of relative names" sh -c "cd ${lab}/from && ${gcc} -g -I../headers ../covered.c -o ../covered")
says(1 "ended with status 5" ${BIN}/softcell spu run --coverage ${lab}/covered.info ${lab}/covered)
says(0 "SF:${lab}/covered.c\n[^/]*SF:${lab}/headers/also.h\n[^/]*SF:${lab}/headers/covered.h\n" cat ${lab}/covered.info)

# Vectors in headers of -isystem, which give no warnings.
file(WRITE ${lab}/system/first.h "#include <spu_intrinsics.h>\nstatic int unused;\n#define FIRST(v) spu_extract((vec_uchar16)(v), 0)\n"
  "static inline int first(vector unsigned int v) { return spu_extract((vec_uchar16)v, 0) + FIRST(v); }\n")
file(WRITE ${lab}/uses_first.c "#include <first.h>\n"
  "int main(void) { vec_uint4 v = {0x02030405}; return first(v) + FIRST(v); }\n")
foreach(option "-isystem;${lab}/system" "-isystem${lab}/system")
  says(0 "^$" ${gcc} -Wall ${option} ${lab}/uses_first.c -o ${lab}/uses_first)
  says(1 "ended with status 6" ${BIN}/softcell spu run ${lab}/uses_first)
endforeach()

says(2 "usage: softcell-embedspu" ${BIN}/softcell-embedspu symbol)
says(2 "is no name of a variable" ${BIN}/softcell-embedspu 1st ${lab}/whole ${lab}/e.o)
says(2 "is no ELF file" ${BIN}/softcell-embedspu name ${lab}/Makefile ${lab}/e.o)
says(2 "cannot read" ${BIN}/softcell-embedspu name ${lab}/nothing ${lab}/e.o)
says(2 "-m32: softcell's libspe2 has 64 bits" ${BIN}/softcell-embedspu -m32 name ${lab}/whole ${lab}/e.o)

# A signal leaves no temporary files. The compiler waits for a header that nobody writes.
file(WRITE ${lab}/waits.c "#include \"never_written.h\"\nint main(void) { return 0; }\n")
foreach(signal INT TERM HUP)
  step("nothing is left after SIG${signal}" sh -c "cd ${lab} && rm -rf temporary never_written.h && mkdir temporary && mkfifo never_written.h
    TMPDIR=$PWD/temporary timeout -s ${signal} 0.5 ${gcc} waits.c -o waits
    test $? = 124 -a ! -e waits && ls -A temporary && test -z \"$(ls -A temporary)\"")
endforeach()
