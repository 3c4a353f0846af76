#pragma once
// The PPU side's clock to the microsecond. [POSIX]

#include <sys/cdefs.h>
#include <time.h>

struct timeval {
  time_t tv_sec;
  long tv_usec;
};

__BEGIN_DECLS
/// @param zone  without effect
int gettimeofday(struct timeval* now, void* zone);
__END_DECLS
