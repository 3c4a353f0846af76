#pragma once
// The clock of the SPU timer library: ticks of the decrementer since its start. Timers with handlers are interrupts, which programs here do
// not have. [SDK for Multicore Acceleration, SPU timer library] documented

#include <stdint.h>
#include <sys/cdefs.h>

__BEGIN_DECLS
/// Begins to count; a second start is counted, and each needs its stop. @return  0.
int spu_clock_start(void);
/// @return  0, or -1 when the clock was not started.
int spu_clock_stop(void);
/// Ticks since the first start, as long as no 2^32 of them lie between two readings; 0 before it.
uint64_t spu_clock_read(void);
__END_DECLS
