#pragma once
// Time of the PPU side: each call that reads the clock or sleeps is served there. There are no time zones: local time is UTC. [C17, 7.27;
// POSIX] For time on the SPE itself see spu_timer.h and the decrementer.

#include <stddef.h>
#include <sys/cdefs.h>

typedef long time_t;  ///< seconds since 1970, of 32 bits
typedef long clock_t;
#define CLOCKS_PER_SEC 1000000L

struct timespec {
  time_t tv_sec;
  long tv_nsec;
};
struct tm {
  int tm_sec, tm_min, tm_hour, tm_mday, tm_mon, tm_year, tm_wday, tm_yday, tm_isdst;
};

__BEGIN_DECLS
time_t time(time_t* also);
/// Microseconds by the clock since the first call.
clock_t clock(void);
double difftime(time_t later, time_t earlier);
struct tm* gmtime(const time_t* when);
struct tm* gmtime_r(const time_t* when, struct tm* to);
struct tm* localtime(const time_t* when);
struct tm* localtime_r(const time_t* when, struct tm* to);
/// Numbers may lie outside of their ranges, and are put right. @return  seconds since 1970
time_t mktime(struct tm* time);
/// In the locale "C". %E and %O, %g, %G and %V are not known.
size_t strftime(char* to, size_t bytes, const char* format, const struct tm* time);
char* asctime(const struct tm* time);
char* asctime_r(const struct tm* time, char* to);
char* ctime(const time_t* when);
int nanosleep(const struct timespec* wanted, struct timespec* left);
__END_DECLS
