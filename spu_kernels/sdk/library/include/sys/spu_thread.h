#pragma once
// PSL1GHT's interface of an SPU thread: where its group's threads lie in the address space, and how it ends. [PSL1GHT, sys/spu_thread.h]
// documented

#include <sys/cdefs.h>

#define SPU_THREAD_BASE 0xF0000000ULL
#define SPU_THREAD_OFFSET 0x00100000ULL
#define SPU_THREAD_Sig_Notify_1 0x5400C
#define SPU_THREAD_Sig_Notify_2 0x5C00C

__BEGIN_DECLS
/// Ends the thread: the status goes to the outbound mailbox, the stop code is 0x102.
void spu_thread_exit(int status) __attribute__((noreturn));
/// Gives way to other thread groups: here all run at the same time.
void spu_thread_group_yield(void);
/// Ends the threads of the group: the stop code is 0x101.
void spu_thread_group_exit(int status) __attribute__((noreturn));
__END_DECLS
