#ifndef SOFTCELL_SYNC_H
#define SOFTCELL_SYNC_H
/* What both sides have in common in libsync.h: the types, the words in main storage, and the SDK's names of inlined functions. The
 * functions themselves differ, because an SPE reaches main storage only through its MFC: <libsync.h> of the SPU side declares functions
 * of the C library of the local store, which use getllar and putllc, and <libsync.h> of the PPU side has inline functions, which use
 * atomic operations of the PC. [SDK for Multicore Acceleration, sync library] documented
 *
 * Each object is an aligned word of 32 bits, 0 at the beginning:
 *   counter           its value
 *   mutex             0: free; 1: locked
 *   condition         low half: how many wait, 65535 at most; high half: how many of them may go on
 *   completion        0: nothing is complete; above 0: one may pass; below 0: all may pass
 *   reader/writer     0: free; above 0: the number of readers; below 0: a writer has it. Readers do not wait for writers that wait.
 *
 * What the functions return:
 *   atomic_add_return() and its like               the word before
 *   atomic_sub_and_test(), atomic_dec_and_test()   whether the word has become 0
 *   atomic_dec_if_positive()                       the word less 1: below 0 if nothing was left, and then the word has not changed
 *   mutex_trylock(), read_trylock(), write_trylock()   1: the caller has the lock now; 0: it does not
 * cond_wait() unlocks the mutex, waits for a signal that comes after that, and locks the mutex again. It never returns without a signal.
 * cond_signal() lets one of those who wait go on, if there are any; cond_broadcast() lets all go on. complete() lets one caller of
 * wait_for_completion() pass, now or later: one, however often it is called before that. complete_all() lets all pass from then on. */

/* Effective addresses; on the PPU side they are pointers of the program: (mutex_ea_t)(uintptr_t)&word. */
typedef unsigned long long eaddr_t; /* of a reader/writer lock */
typedef unsigned long long atomic_ea_t;
typedef unsigned long long mutex_ea_t;
typedef unsigned long long cond_ea_t;
typedef unsigned long long completion_ea_t;
/* Room for a condition, which is the first word. */
typedef struct {
  unsigned int word, others[31];
} __attribute__((aligned(128))) condition_variable_t;

#define _atomic_read atomic_read
#define _atomic_set atomic_set
#define _atomic_add atomic_add
#define _atomic_sub atomic_sub
#define _atomic_inc atomic_inc
#define _atomic_dec atomic_dec
#define _atomic_add_return atomic_add_return
#define _atomic_sub_return atomic_sub_return
#define _atomic_inc_return atomic_inc_return
#define _atomic_dec_return atomic_dec_return
#define _atomic_sub_and_test atomic_sub_and_test
#define _atomic_dec_and_test atomic_dec_and_test
#define _atomic_dec_if_positive atomic_dec_if_positive
#define _mutex_init mutex_init
#define _mutex_lock mutex_lock
#define _mutex_trylock mutex_trylock
#define _mutex_unlock mutex_unlock
#define _cond_init cond_init
#define _cond_wait cond_wait
#define _cond_signal cond_signal
#define _cond_broadcast cond_broadcast
#define _init_completion init_completion
#define _wait_for_completion wait_for_completion
#define _complete complete
#define _complete_all complete_all
#define _rwlock_init rwlock_init
#define _read_lock read_lock
#define _read_trylock read_trylock
#define _read_unlock read_unlock
#define _write_lock write_lock
#define _write_trylock write_trylock
#define _write_unlock write_unlock

#endif
