#ifndef SOFTCELL_PSL1GHT_SYS_PROCESS_H
#define SOFTCELL_PSL1GHT_SYS_PROCESS_H
/* The program as lv2's process. [PSL1GHT, sys/process.h] documented */

#include <ppu-types.h>
#include <unistd.h>

/* Priority and stack of the console's main thread; the PC's are what they are. */
#define SYS_PROCESS_PARAM(priority, stack_bytes) \
  enum { softcell_process_priority = (priority), softcell_process_stack_bytes = (stack_bytes) };

static __inline__ void sysProcessExit(s32 status) { exit(status); }
static __inline__ sys_pid_t sysProcessGetPid(void) { return (sys_pid_t)getpid(); }

#endif
