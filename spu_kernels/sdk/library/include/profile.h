#pragma once
// Marks for IBM's simulator, which mean nothing to others. [SDK for Multicore Acceleration, profile checkpoints] documented

#define prof_start() ((void)0)
#define prof_stop() ((void)0)
#define prof_clear() ((void)0)
#define prof_cp(number) ((void)(number))
#define prof_cp0() ((void)0)
#define prof_cp1() ((void)0)
#define prof_cp2() ((void)0)
#define prof_cp3() ((void)0)
#define prof_cp4() ((void)0)
#define prof_cp5() ((void)0)
#define prof_cp6() ((void)0)
#define prof_cp7() ((void)0)
#define prof_cp8() ((void)0)
#define prof_cp9() ((void)0)
