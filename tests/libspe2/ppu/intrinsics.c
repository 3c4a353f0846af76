/* The PPU's intrinsics on the PC, and the SDK's library misc. */
#define N 1024
#include <libmisc.h>
#include <ppu_intrinsics.h>
#include <stdint.h>

#include "run_in_thread.h"

static uint32_t counter;
static uint64_t wide;

static void* count(void* unused) {
  int i;
  for (i = 0; i < 10000; ++i) {
    do {
    } while (!__stwcx(&counter, __lwarx(&counter) + 1));
    do {
    } while (!__stdcx(&wide, __ldarx(&wide) + 0x100000001ull));
  }
  return unused;
}

static void reservations(void) {
  pthread_t threads[4];
  uint32_t other = 0;
  int i;
  for (i = 0; i < 4; ++i) CHECK(pthread_create(&threads[i], NULL, count, NULL) == 0);
  for (i = 0; i < 4; ++i) CHECK(pthread_join(threads[i], NULL) == 0);
  CHECK(counter == 40000 && wide == 40000 * 0x100000001ull);
  CHECK(__lwarx(&counter) == 40000);
  CHECK(__stwcx(&other, 1) == 0 && other == 0);         /* of another place, */
  CHECK(__stwcx(&counter, 1) == 0 && counter == 40000); /* and it is lost then */
}

static void memory(void) {
  static unsigned char lines[384] __attribute__((aligned(128)));
  char* block = (char*)malloc_align(1000, 7);
  CHECK(block != NULL && (uintptr_t)block % 128 == 0);
  free_align(block);
  block = (char*)calloc_align(10, 100, 7);
  CHECK(block != NULL && ((uintptr_t)block & 127) == 0 && block[0] == 0 && block[999] == 0);
  block[999] = 5;
  block = (char*)realloc_align(block, 100000, 12);
  CHECK(block != NULL && ((uintptr_t)block & 4095) == 0 && block[999] == 5);
  free_align(block);
  CHECK(calloc_align((size_t)-1, 16, 7) == NULL);
  memset(lines, 1, sizeof lines);
  __dcbt(lines);
  __dcbtst(lines);
  __dcbz(lines + 200);
  __dcbst(lines);
  __dcbf(lines);
  __icbi(lines);
  CHECK(lines[127] == 1 && lines[128] == 0 && lines[255] == 0 && lines[256] == 1);
  __sync();
  __lwsync();
  __eieio();
  __isync();
}

static void numbers(void) {
  uint64_t word = 0x0102030405060708ull, swapped;
  CHECK(__cntlzw(0) == 32 && __cntlzw(1) == 31 && __cntlzd(0) == 64 && __cntlzd(1ull << 40) == 23);
  CHECK(__mulhw(-1, 1) == -1 && __mulhwu(0xFFFFFFFF, 2) == 1);
  CHECK(__fabs(-2) == 2 && __fabsf(-2) == 2 && __fnabs(2) == -2 && __fsqrt(9) == 3 && __fsqrts(4) == 2 &&
        __fsel(-1, 5, 6) == 6);
  CHECK(__ldbrx(&word) == 0x0807060504030201ull && __lwbrx(&word) == 0x08070605 && __lhbrx(&word) == 0x0807);
  __stdbrx(&swapped, word);
  CHECK(swapped == 0x0807060504030201ull);
  __stwbrx(&swapped, 1);
  __sthbrx((char*)&swapped + 4, 1);
  CHECK((uint32_t)swapped == 0x01000000 && (uint16_t)(swapped >> 32) == 0x0100);
}

static void waiting(void) {
  const struct timespec a_tenth = {0, 100000000};
  const uint64_t before = __mftb();
  uint64_t passed;
  nanosleep(&a_tenth, NULL);
  passed = __mftb() - before;
  CHECK(passed >= 7980000 && passed < 100 * 7980000ull);
  __nop();
  __cctpl();
  __cctpm();
  __cctph();
  __db8cyc();
  __db10cyc();
  __db12cyc();
  __db16cyc();
}

int main(void) {
  reservations();
  memory();
  numbers();
  waiting();
  CHECK(N == 1024);
  puts("ok");
  return 0;
}
