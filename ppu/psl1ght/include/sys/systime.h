#ifndef SOFTCELL_PSL1GHT_SYS_SYSTIME_H
#define SOFTCELL_PSL1GHT_SYS_SYSTIME_H
/* Time. [PSL1GHT, sys/systime.h] documented */
#if defined(__INCLUDE_LEVEL__) && __INCLUDE_LEVEL__ > 0
#pragma GCC system_header /* as on a Cell: no warnings of it, whatever standard the program asks for */
#endif

#include <ppu-types.h>
#include <time.h>
#include <unistd.h>

/* The C library's clocks by names of ours, as <time.h> hides them from a program of strict C. */
struct softcell_time {
  long seconds, nanoseconds;
};
extern int softcell_time_of_clock(int clock, struct softcell_time* now) __asm__("clock_gettime");
extern int softcell_time_sleep(const struct softcell_time* wait,
                               struct softcell_time* left) __asm__("nanosleep");

static __inline__ s32 sysUsleep(u32 microseconds) {
  const struct softcell_time wait = {(long)(microseconds / 1000000), (long)(microseconds % 1000000) * 1000};
  softcell_time_sleep(&wait, 0);
  return 0;
}
static __inline__ s32 sysSleep(u32 seconds) {
  const struct softcell_time wait = {(long)seconds, 0};
  softcell_time_sleep(&wait, 0);
  return 0;
}
static __inline__ s32 sysGetCurrentTime(u64* seconds, u64* nanoseconds) {
  struct softcell_time now;
  softcell_time_of_clock(0, &now);
  *seconds = (u64)now.seconds;
  *nanoseconds = (u64)now.nanoseconds;
  return 0;
}
/* Microseconds of a clock that is never set back. */
static __inline__ s64 sysGetSystemTime(void) {
  struct softcell_time now;
  softcell_time_of_clock(1, &now);
  return (s64)now.seconds * 1000000 + now.nanoseconds / 1000;
}
/* Ticks of the console's time base in a second. */
static __inline__ u64 sysGetTimebaseFrequency(void) { return 79800000; }

#endif
