#pragma once
// Words in main storage that SPEs and the PPU side share: counters and locks. [SDK for Multicore Acceleration, sync library] documented
//
// Each function takes the effective address of an aligned word and works on its line by getllar and putllc, so that at most one
// reservation is used.

#include <sys/cdefs.h>

typedef unsigned long long atomic_ea_t;
typedef unsigned long long mutex_ea_t;

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
