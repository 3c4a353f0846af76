#ifndef SOFTCELL_PSL1GHT_SYS_SYSTIME_H
#define SOFTCELL_PSL1GHT_SYS_SYSTIME_H
/* Time. [PSL1GHT, sys/systime.h] documented */

#include <ppu-types.h>
#include <time.h>
#include <unistd.h>

static inline s32 sysUsleep(u32 microseconds) {
  const struct timespec wait = {(time_t)(microseconds / 1000000), (long)(microseconds % 1000000) * 1000};
  nanosleep(&wait, NULL);
  return 0;
}
static inline s32 sysSleep(u32 seconds) {
  const struct timespec wait = {(time_t)seconds, 0};
  nanosleep(&wait, NULL);
  return 0;
}
static inline s32 sysGetCurrentTime(u64* seconds, u64* nanoseconds) {
  struct timespec now;
  clock_gettime(CLOCK_REALTIME, &now);
  *seconds = (u64)now.tv_sec;
  *nanoseconds = (u64)now.tv_nsec;
  return 0;
}
/* Microseconds of a clock that is never set back. */
static inline s64 sysGetSystemTime(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (s64)now.tv_sec * 1000000 + now.tv_nsec / 1000;
}
/* Ticks of the console's time base in a second. */
static inline u64 sysGetTimebaseFrequency(void) { return 79800000; }

#endif
