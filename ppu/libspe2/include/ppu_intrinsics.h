/* Intrinsics of the PPU for programs of the PC: what has a meaning there does what the console's instruction does. Those of AltiVec, of
 * special registers and of the floating-point status are not there. [LEXT, PPU-specific intrinsics] documented */
#ifndef SOFTCELL_PPU_INTRINSICS_H
#define SOFTCELL_PPU_INTRINSICS_H
#if defined(__INCLUDE_LEVEL__) && __INCLUDE_LEVEL__ > 0
#pragma GCC system_header /* as on a Cell: no warnings of it, whatever standard the program asks for */
#endif

#include <stdint.h>
#include <string.h>
#include <time.h>

#define SOFTCELL_PPU_INLINE static __inline__ __attribute__((unused))
/* Names of one letter end in an underscore: a program may have macros such as N. */

/* ---- order of memory accesses, between threads and between the program and SPEs */

SOFTCELL_PPU_INLINE void __sync(void) { __sync_synchronize(); }
SOFTCELL_PPU_INLINE void __lwsync(void) { __sync_synchronize(); }
SOFTCELL_PPU_INLINE void __eieio(void) { __sync_synchronize(); }
SOFTCELL_PPU_INLINE void __isync(void) { __sync_synchronize(); }

/* ---- time: the time base of a PlayStation 3 has 79.8 million ticks a second */

#define SOFTCELL_PPU_TIMEBASE 79800000ull
/* The C library's monotonic clock by names of ours, as <time.h> hides it from a program of strict C. */
struct softcell_ppu_time {
  long seconds, nanoseconds;
};
extern int softcell_ppu_clock(int clock, struct softcell_ppu_time* now) __asm__("clock_gettime");
SOFTCELL_PPU_INLINE uint64_t __mftb(void) {
  struct softcell_ppu_time now;
  softcell_ppu_clock(1, &now);
  return (uint64_t)now.seconds * SOFTCELL_PPU_TIMEBASE +
         (uint64_t)now.nanoseconds * (SOFTCELL_PPU_TIMEBASE / 100000) / 10000;
}

/* ---- the cache, whose lines have 128 bytes. Its contents are always those of memory */

SOFTCELL_PPU_INLINE void __dcbt(const volatile void* at) { __builtin_prefetch((const void*)at, 0); }
SOFTCELL_PPU_INLINE void __dcbtst(const volatile void* at) { __builtin_prefetch((const void*)at, 1); }
SOFTCELL_PPU_INLINE void __dcbst(const volatile void* at) { (void)at; }
SOFTCELL_PPU_INLINE void __dcbf(const volatile void* at) { (void)at; }
SOFTCELL_PPU_INLINE void __icbi(const volatile void* at) { (void)at; }
/* The line around the address becomes zero. */
SOFTCELL_PPU_INLINE void __dcbz(volatile void* at) {
  memset((void*)((uintptr_t)at & ~(uintptr_t)127), 0, 128);
}

/* ---- reservations. A thread has one; it is lost when memory has another value than was read, not when it was written. */

static __thread struct {
  const volatile void* place;
  uint64_t value;
} softcell_ppu_reservation __attribute__((unused));

SOFTCELL_PPU_INLINE uint32_t __lwarx(const volatile void* at) {
  const uint32_t value = __atomic_load_n((const volatile uint32_t*)at, __ATOMIC_SEQ_CST);
  softcell_ppu_reservation.place = at;
  softcell_ppu_reservation.value = value;
  return value;
}
SOFTCELL_PPU_INLINE uint64_t __ldarx(const volatile void* at) {
  const uint64_t value = __atomic_load_n((const volatile uint64_t*)at, __ATOMIC_SEQ_CST);
  softcell_ppu_reservation.place = at;
  softcell_ppu_reservation.value = value;
  return value;
}
/* 1: the value was stored. 0: the reservation was lost. */
SOFTCELL_PPU_INLINE int __stwcx(volatile void* at, uint32_t value) {
  uint32_t expected = (uint32_t)softcell_ppu_reservation.value;
  const int reserved = softcell_ppu_reservation.place == at;
  softcell_ppu_reservation.place = 0;
  return reserved && __atomic_compare_exchange_n((volatile uint32_t*)at, &expected, value, 0,
                                                 __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST);
}
SOFTCELL_PPU_INLINE int __stdcx(volatile void* at, uint64_t value) {
  uint64_t expected = softcell_ppu_reservation.value;
  const int reserved = softcell_ppu_reservation.place == at;
  softcell_ppu_reservation.place = 0;
  return reserved && __atomic_compare_exchange_n((volatile uint64_t*)at, &expected, value, 0,
                                                 __ATOMIC_SEQ_CST, __ATOMIC_SEQ_CST);
}

/* ---- numbers */

SOFTCELL_PPU_INLINE int __cntlzw(uint32_t value) { return value == 0 ? 32 : __builtin_clz(value); }
SOFTCELL_PPU_INLINE int __cntlzd(uint64_t value) { return value == 0 ? 64 : __builtin_clzll(value); }
SOFTCELL_PPU_INLINE int __mulhw(int one, int two) { return (int)((int64_t)one * two >> 32); }
SOFTCELL_PPU_INLINE unsigned int __mulhwu(unsigned int one, unsigned int two) {
  return (unsigned int)((uint64_t)one * two >> 32);
}
SOFTCELL_PPU_INLINE double __fabs(double value) { return __builtin_fabs(value); }
SOFTCELL_PPU_INLINE float __fabsf(float value) { return __builtin_fabsf(value); }
SOFTCELL_PPU_INLINE double __fnabs(double value) { return -__builtin_fabs(value); }
SOFTCELL_PPU_INLINE double __fsqrt(double value) {
  __asm__("sqrtsd %1, %0" : "=x"(value) : "x"(value));
  return value;
}
SOFTCELL_PPU_INLINE float __fsqrts(float value) {
  __asm__("sqrtss %1, %0" : "=x"(value) : "x"(value));
  return value;
}
SOFTCELL_PPU_INLINE double __fsel(double choice, double one, double two) { return choice >= 0 ? one : two; }

/* ---- the other byte order: on the PPU these are loads and stores of little-endian numbers, on a PC of big-endian ones */

SOFTCELL_PPU_INLINE uint16_t __lhbrx(const volatile void* at) {
  return __builtin_bswap16(*(const volatile uint16_t*)at);
}
SOFTCELL_PPU_INLINE uint32_t __lwbrx(const volatile void* at) {
  return __builtin_bswap32(*(const volatile uint32_t*)at);
}
SOFTCELL_PPU_INLINE uint64_t __ldbrx(const volatile void* at) {
  return __builtin_bswap64(*(const volatile uint64_t*)at);
}
SOFTCELL_PPU_INLINE void __sthbrx(volatile void* at, uint16_t value) {
  *(volatile uint16_t*)at = __builtin_bswap16(value);
}
SOFTCELL_PPU_INLINE void __stwbrx(volatile void* at, uint32_t value) {
  *(volatile uint32_t*)at = __builtin_bswap32(value);
}
SOFTCELL_PPU_INLINE void __stdbrx(volatile void* at, uint64_t value) {
  *(volatile uint64_t*)at = __builtin_bswap64(value);
}

/* ---- hints for the processor's threads */

SOFTCELL_PPU_INLINE void __nop(void) {}
SOFTCELL_PPU_INLINE void __cctpl(void) {}
SOFTCELL_PPU_INLINE void __cctpm(void) {}
SOFTCELL_PPU_INLINE void __cctph(void) {}
SOFTCELL_PPU_INLINE void __db8cyc(void) { __builtin_ia32_pause(); }
SOFTCELL_PPU_INLINE void __db10cyc(void) { __builtin_ia32_pause(); }
SOFTCELL_PPU_INLINE void __db12cyc(void) { __builtin_ia32_pause(); }
SOFTCELL_PPU_INLINE void __db16cyc(void) { __builtin_ia32_pause(); }

#endif
