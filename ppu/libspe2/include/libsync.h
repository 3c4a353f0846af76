/* Objects in main storage by which the PPU side and SPEs synchronise, as inline functions: there is no -lsync. softcell_sync.h says what
 * they are and what the functions do. */
#ifndef SOFTCELL_LIBSYNC_H
#define SOFTCELL_LIBSYNC_H
#if defined(__INCLUDE_LEVEL__) && __INCLUDE_LEVEL__ > 0
#pragma GCC system_header /* as on a Cell: no warnings of it, whatever standard the program asks for */
#endif

#include <softcell_sync.h>
#include <stdint.h>

#define SOFTCELL_SYNC_INLINE static __inline__ __attribute__((unused))

/* ---- words, and waits for them */

SOFTCELL_SYNC_INLINE volatile unsigned int* softcell_sync_word(eaddr_t ea) {
  return (volatile unsigned int*)(uintptr_t)ea;
}
SOFTCELL_SYNC_INLINE unsigned int softcell_sync_load(eaddr_t ea) {
  return __atomic_load_n(softcell_sync_word(ea), __ATOMIC_SEQ_CST);
}
SOFTCELL_SYNC_INLINE void softcell_sync_store(eaddr_t ea, unsigned int value) {
  __atomic_store_n(softcell_sync_word(ea), value, __ATOMIC_SEQ_CST);
}
/* Whether the word was `before` and is `after` now. */
SOFTCELL_SYNC_INLINE int softcell_sync_change(eaddr_t ea, unsigned int before, unsigned int after) {
  return __atomic_compare_exchange_n(softcell_sync_word(ea), &before, after, 0, __ATOMIC_SEQ_CST,
                                     __ATOMIC_SEQ_CST);
}

/* The C library's functions by names of ours, as its headers hide them from a program of strict C. */
struct softcell_sync_time {
  long seconds, nanoseconds;
};
extern int softcell_sync_yield(void) __asm__("sched_yield");
extern int softcell_sync_sleep(const struct softcell_sync_time* duration,
                               struct softcell_sync_time* left) __asm__("nanosleep");
/* Between two looks at a word: an SPE that changes it wakes no thread of the PPU, and it needs a processor of the PC for that. */
SOFTCELL_SYNC_INLINE void softcell_sync_give_way(unsigned int* looks) {
  const struct softcell_sync_time nap = {0, 50000};
  if (*looks < 100) {
    __builtin_ia32_pause();
  } else if (*looks < 200) {
    softcell_sync_yield();
  } else {
    softcell_sync_sleep(&nap, 0);
    return;
  }
  ++*looks;
}

/* ---- counters */

SOFTCELL_SYNC_INLINE int atomic_read(atomic_ea_t ea) { return (int)softcell_sync_load(ea); }
SOFTCELL_SYNC_INLINE void atomic_set(atomic_ea_t ea, int value) {
  softcell_sync_store(ea, (unsigned int)value);
}
SOFTCELL_SYNC_INLINE int atomic_add_return(int value, atomic_ea_t ea) {
  return (int)__atomic_fetch_add(softcell_sync_word(ea), (unsigned int)value, __ATOMIC_SEQ_CST);
}
SOFTCELL_SYNC_INLINE int atomic_sub_return(int value, atomic_ea_t ea) {
  return (int)__atomic_fetch_sub(softcell_sync_word(ea), (unsigned int)value, __ATOMIC_SEQ_CST);
}
SOFTCELL_SYNC_INLINE int atomic_inc_return(atomic_ea_t ea) { return atomic_add_return(1, ea); }
SOFTCELL_SYNC_INLINE int atomic_dec_return(atomic_ea_t ea) { return atomic_sub_return(1, ea); }
SOFTCELL_SYNC_INLINE void atomic_add(int value, atomic_ea_t ea) { atomic_add_return(value, ea); }
SOFTCELL_SYNC_INLINE void atomic_sub(int value, atomic_ea_t ea) { atomic_sub_return(value, ea); }
SOFTCELL_SYNC_INLINE void atomic_inc(atomic_ea_t ea) { atomic_add_return(1, ea); }
SOFTCELL_SYNC_INLINE void atomic_dec(atomic_ea_t ea) { atomic_sub_return(1, ea); }
SOFTCELL_SYNC_INLINE int atomic_sub_and_test(int value, atomic_ea_t ea) {
  return atomic_sub_return(value, ea) == value;
}
SOFTCELL_SYNC_INLINE int atomic_dec_and_test(atomic_ea_t ea) { return atomic_sub_return(1, ea) == 1; }
SOFTCELL_SYNC_INLINE int atomic_dec_if_positive(atomic_ea_t ea) {
  for (;;) {
    const int before = atomic_read(ea);
    if (before <= 0 || softcell_sync_change(ea, (unsigned int)before, (unsigned int)before - 1))
      return before - 1;
  }
}

/* ---- locks */

SOFTCELL_SYNC_INLINE void mutex_init(mutex_ea_t lock) { softcell_sync_store(lock, 0); }
SOFTCELL_SYNC_INLINE int mutex_trylock(mutex_ea_t lock) { return softcell_sync_change(lock, 0, 1); }
SOFTCELL_SYNC_INLINE void mutex_lock(mutex_ea_t lock) {
  unsigned int looks = 0;
  while (!mutex_trylock(lock)) softcell_sync_give_way(&looks);
}
SOFTCELL_SYNC_INLINE void mutex_unlock(mutex_ea_t lock) { softcell_sync_store(lock, 0); }

SOFTCELL_SYNC_INLINE void rwlock_init(eaddr_t lock) { softcell_sync_store(lock, 0); }
SOFTCELL_SYNC_INLINE int read_trylock(eaddr_t lock) {
  for (;;) {
    const unsigned int readers = softcell_sync_load(lock);
    if ((int)readers < 0) return 0;
    if (softcell_sync_change(lock, readers, readers + 1)) return 1;
  }
}
SOFTCELL_SYNC_INLINE void read_lock(eaddr_t lock) {
  unsigned int looks = 0;
  while (!read_trylock(lock)) softcell_sync_give_way(&looks);
}
SOFTCELL_SYNC_INLINE void read_unlock(eaddr_t lock) { atomic_dec(lock); }
SOFTCELL_SYNC_INLINE int write_trylock(eaddr_t lock) {
  return softcell_sync_change(lock, 0, (unsigned int)-1);
}
SOFTCELL_SYNC_INLINE void write_lock(eaddr_t lock) {
  unsigned int looks = 0;
  while (!write_trylock(lock)) softcell_sync_give_way(&looks);
}
SOFTCELL_SYNC_INLINE void write_unlock(eaddr_t lock) { softcell_sync_store(lock, 0); }

/* ---- conditions */

SOFTCELL_SYNC_INLINE void cond_init(cond_ea_t cond) { softcell_sync_store(cond, 0); }
SOFTCELL_SYNC_INLINE void cond_wait(cond_ea_t cond, mutex_ea_t mutex) {
  unsigned int looks = 0, word = softcell_sync_load(cond);
  /* One that comes after a signal waits until those that the signal was for have gone on. */
  while (word >> 16 != 0 || !softcell_sync_change(cond, word, word + 1)) {
    softcell_sync_give_way(&looks);
    word = softcell_sync_load(cond);
  }
  mutex_unlock(mutex);
  looks = 0;
  word = softcell_sync_load(cond);
  while (word >> 16 == 0 || !softcell_sync_change(cond, word, word - 0x10001u)) {
    softcell_sync_give_way(&looks);
    word = softcell_sync_load(cond);
  }
  mutex_lock(mutex);
}
SOFTCELL_SYNC_INLINE void cond_signal(cond_ea_t cond) {
  unsigned int word;
  do {
    word = softcell_sync_load(cond);
  } while (word >> 16 != (word & 0xFFFF) && !softcell_sync_change(cond, word, word + 0x10000u));
}
SOFTCELL_SYNC_INLINE void cond_broadcast(cond_ea_t cond) {
  unsigned int word;
  do {
    word = softcell_sync_load(cond);
  } while (!softcell_sync_change(cond, word, (word & 0xFFFF) * 0x10001u));
}

/* ---- completions */

SOFTCELL_SYNC_INLINE void init_completion(completion_ea_t completion) { softcell_sync_store(completion, 0); }
SOFTCELL_SYNC_INLINE void wait_for_completion(completion_ea_t completion) {
  unsigned int looks = 0;
  while (!softcell_sync_change(completion, 1, 0)) {
    if ((int)softcell_sync_load(completion) < 0) return;
    softcell_sync_give_way(&looks);
  }
}
SOFTCELL_SYNC_INLINE void complete(completion_ea_t completion) { softcell_sync_change(completion, 0, 1); }
SOFTCELL_SYNC_INLINE void complete_all(completion_ea_t completion) {
  softcell_sync_store(completion, (unsigned int)-1);
}

#endif
