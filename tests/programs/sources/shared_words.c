/* libsync.h: each function by itself, on words of the lines at argp. */
#include <atomic_add.h>
#include <mutex_lock.h>
#include <stdint.h>
#include <stdlib.h>

#include "check.h"

int main(uint64_t id, uint64_t argp) {
  const uint64_t other = argp + 4, lock = argp + 8, completion = argp + 128, cond = argp + 132;
  (void)id;
  atomic_set(argp, 5);
  atomic_set(other, 77);
  CHECK(atomic_read(argp) == 5 && atomic_read(other) == 77);
  atomic_add(3, argp);
  atomic_sub(1, argp);
  atomic_inc(argp);
  atomic_dec(argp);
  CHECK(atomic_read(argp) == 7);
  CHECK(atomic_add_return(2, argp) == 7 && atomic_sub_return(4, argp) == 9 && atomic_inc_return(argp) == 5 && atomic_dec_return(argp) == 6);
  CHECK(!atomic_sub_and_test(3, argp) && atomic_read(argp) == 2 && !atomic_dec_and_test(argp) && atomic_dec_and_test(argp));
  CHECK(atomic_dec_if_positive(argp) < 0 && atomic_read(argp) == 0);
  atomic_set(argp, 2);
  CHECK(atomic_sub_and_test(2, argp) && atomic_read(other) == 77);
  atomic_set(argp, 1);
  CHECK(atomic_dec_if_positive(argp) == 0 && atomic_read(argp) == 0);
  mutex_init(lock);
  CHECK(mutex_trylock(lock) == 1 && mutex_trylock(lock) == 0);
  mutex_unlock(lock);
  mutex_lock(lock);
  CHECK(mutex_trylock(lock) == 0);
  mutex_unlock(lock);

  atomic_set(lock, 9);
  rwlock_init(lock);
  read_lock(lock);
  CHECK(read_trylock(lock) == 1 && write_trylock(lock) == 0 && atomic_read(lock) == 2);
  read_unlock(lock);
  CHECK(write_trylock(lock) == 0);
  _read_unlock(lock);
  write_lock(lock);
  CHECK(read_trylock(lock) == 0 && write_trylock(lock) == 0);
  write_unlock(lock);
  CHECK(write_trylock(lock) == 1 && atomic_read(other) == 77);

  atomic_set(completion, 9);
  init_completion(completion);
  CHECK(atomic_read(completion) == 0);
  complete(completion);
  complete(completion); /* no more than one */
  wait_for_completion(completion);
  CHECK(atomic_read(completion) == 0);
  complete_all(completion);
  complete(completion);
  wait_for_completion(completion);
  wait_for_completion(completion);
  init_completion(completion);
  CHECK(atomic_read(completion) == 0);

  atomic_set(cond, 9);
  cond_init(cond);
  cond_signal(cond); /* nobody waits */
  cond_broadcast(cond);
  CHECK(atomic_read(cond) == 0);
  atomic_set(cond, 3); /* three wait */
  cond_signal(cond);
  CHECK(atomic_read(cond) == 0x10003);
  cond_broadcast(cond);
  CHECK(atomic_read(cond) == 0x30003);
  cond_signal(cond);
  CHECK(atomic_read(cond) == 0x30003 && atomic_read(completion) == 0);
  exit(failures);
}
