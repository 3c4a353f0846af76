#pragma once
// Words in main storage that SPEs and the PPU side share: counters, locks, conditions and completions. [SDK for Multicore Acceleration,
// sync library] documented
//
// Each function takes the effective address of an aligned word and works on its line by getllar and putllc, so that at most one
// reservation is used. What waits sleeps until the reservation is lost. ppu/libspe2/include/libsync.h works on the same words.

#include <sys/cdefs.h>

typedef unsigned long long atomic_ea_t;
typedef unsigned long long mutex_ea_t;
typedef unsigned long long cond_ea_t;
typedef unsigned long long completion_ea_t;
/// Of a reader/writer lock.
typedef unsigned long long eaddr_t;
/// Room for a condition, which is the first word.
typedef struct {
  unsigned int word, others[31];
} __attribute__((aligned(128))) condition_variable_t;

__BEGIN_DECLS
int atomic_read(atomic_ea_t ea);
void atomic_set(atomic_ea_t ea, int value);
void atomic_add(int value, atomic_ea_t ea);
void atomic_sub(int value, atomic_ea_t ea);
void atomic_inc(atomic_ea_t ea);
void atomic_dec(atomic_ea_t ea);
/// These return what the word was before.
int atomic_add_return(int value, atomic_ea_t ea);
int atomic_sub_return(int value, atomic_ea_t ea);
int atomic_inc_return(atomic_ea_t ea);
int atomic_dec_return(atomic_ea_t ea);
/// Whether the word has become 0.
int atomic_sub_and_test(int value, atomic_ea_t ea);
int atomic_dec_and_test(atomic_ea_t ea);
/// Takes one away if something is left. @return  the word less one, negative if nothing was left.
int atomic_dec_if_positive(atomic_ea_t ea);

/// A lock is a word, 0 when it is free.
void mutex_init(mutex_ea_t lock);
void mutex_lock(mutex_ea_t lock);
/// @return  1 when the lock was free and is the caller's now, else 0.
int mutex_trylock(mutex_ea_t lock);
void mutex_unlock(mutex_ea_t lock);

/// A condition is a word, 0 when nobody waits; at most 65535 may.
void cond_init(cond_ea_t cond);
/// Unlocks the mutex, waits for a signal that is given after that, and locks the mutex again. Without a signal nobody goes on.
void cond_wait(cond_ea_t cond, mutex_ea_t mutex);
/// Lets one of those who wait go on, if any do; the other lets all.
void cond_signal(cond_ea_t cond);
void cond_broadcast(cond_ea_t cond);

/// A completion is a word, 0 while there is nothing complete.
void init_completion(completion_ea_t completion);
void wait_for_completion(completion_ea_t completion);
/// Lets one pass who waits or will wait: one, however often it is called before that.
void complete(completion_ea_t completion);
/// Lets all pass from now on.
void complete_all(completion_ea_t completion);

/// A lock for readers or a writer is a word, 0 when it is free, else how many read, or below 0. Readers do not wait for writers that wait.
void rwlock_init(eaddr_t lock);
void read_lock(eaddr_t lock);
/// @return  1 when the lock is the caller's now, else 0.
int read_trylock(eaddr_t lock);
void read_unlock(eaddr_t lock);
void write_lock(eaddr_t lock);
int write_trylock(eaddr_t lock);
void write_unlock(eaddr_t lock);
__END_DECLS

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
