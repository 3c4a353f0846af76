#pragma once
// Objects in main storage by which SPEs and the PPU side synchronise. softcell_sync.h says what they are and what the functions do.
//
// Each function works on the line of its word by getllar and putllc, so that it uses at most one reservation. What waits sleeps until the
// reservation is lost.

#include <sys/cdefs.h>

#include "../../shared/softcell_sync.h"

__BEGIN_DECLS
int atomic_read(atomic_ea_t ea);
void atomic_set(atomic_ea_t ea, int value);
void atomic_add(int value, atomic_ea_t ea);
void atomic_sub(int value, atomic_ea_t ea);
void atomic_inc(atomic_ea_t ea);
void atomic_dec(atomic_ea_t ea);
int atomic_add_return(int value, atomic_ea_t ea);
int atomic_sub_return(int value, atomic_ea_t ea);
int atomic_inc_return(atomic_ea_t ea);
int atomic_dec_return(atomic_ea_t ea);
int atomic_sub_and_test(int value, atomic_ea_t ea);
int atomic_dec_and_test(atomic_ea_t ea);
int atomic_dec_if_positive(atomic_ea_t ea);

void mutex_init(mutex_ea_t lock);
void mutex_lock(mutex_ea_t lock);
int mutex_trylock(mutex_ea_t lock);
void mutex_unlock(mutex_ea_t lock);

void cond_init(cond_ea_t cond);
void cond_wait(cond_ea_t cond, mutex_ea_t mutex);
void cond_signal(cond_ea_t cond);
void cond_broadcast(cond_ea_t cond);

void init_completion(completion_ea_t completion);
void wait_for_completion(completion_ea_t completion);
void complete(completion_ea_t completion);
void complete_all(completion_ea_t completion);

void rwlock_init(eaddr_t lock);
void read_lock(eaddr_t lock);
int read_trylock(eaddr_t lock);
void read_unlock(eaddr_t lock);
void write_lock(eaddr_t lock);
int write_trylock(eaddr_t lock);
void write_unlock(eaddr_t lock);
__END_DECLS
