/* Threads of the PPU side and SPEs share the objects of libsync.h in main storage. */
#include <atomic_set.h>
#include <cond_wait.h>
#include <mutex_lock.h>
#include <unistd.h>

#include "../spu/shared_objects.h"
#include "run_in_thread.h"

extern spe_program_handle_t shares_objects;

static shared_t shared;
#define EA(member) ((unsigned long long)(uintptr_t)&shared.member)

/* ---- each function by itself */

static void words(void) {
  static unsigned int pair[2] = {0, 77};
  const atomic_ea_t ea = (uintptr_t)&pair[0];
  atomic_set(ea, 5);
  atomic_add(3, ea);
  atomic_sub(1, ea);
  atomic_inc(ea);
  atomic_dec(ea);
  CHECK(atomic_read(ea) == 7);
  CHECK(atomic_add_return(2, ea) == 7 && atomic_sub_return(4, ea) == 9);
  CHECK(atomic_inc_return(ea) == 5 && atomic_dec_return(ea) == 6);
  CHECK(!atomic_sub_and_test(3, ea) && atomic_read(ea) == 2);
  CHECK(!atomic_dec_and_test(ea) && atomic_dec_and_test(ea));
  CHECK(atomic_dec_if_positive(ea) < 0 && atomic_read(ea) == 0);
  _atomic_set(ea, 1);
  CHECK(atomic_dec_if_positive(ea) == 0 && atomic_read(ea) == 0 && pair[1] == 77);
}

static void locks(void) {
  static unsigned int word = 9;
  const mutex_ea_t mutex = (uintptr_t)&word;
  const eaddr_t lock = mutex;
  mutex_init(mutex);
  CHECK(mutex_trylock(mutex) == 1 && mutex_trylock(mutex) == 0 && word == 1);
  mutex_unlock(mutex);
  _mutex_lock(mutex);
  CHECK(mutex_trylock(mutex) == 0);
  mutex_unlock(mutex);
  CHECK(word == 0);

  word = 9;
  rwlock_init(lock);
  read_lock(lock);
  CHECK(read_trylock(lock) == 1 && write_trylock(lock) == 0 && word == 2);
  read_unlock(lock);
  CHECK(write_trylock(lock) == 0);
  read_unlock(lock);
  write_lock(lock);
  CHECK(read_trylock(lock) == 0 && write_trylock(lock) == 0);
  write_unlock(lock);
  CHECK(write_trylock(lock) == 1);
  _write_unlock(lock);
  CHECK(word == 0);
}

static void events(void) {
  static unsigned int word = 9;
  const completion_ea_t completion = (uintptr_t)&word;
  const cond_ea_t cond = completion;
  init_completion(completion);
  CHECK(word == 0);
  complete(completion);
  complete(completion); /* no more than one */
  wait_for_completion(completion);
  CHECK(word == 0);
  complete_all(completion);
  complete(completion);
  wait_for_completion(completion);
  wait_for_completion(completion);
  init_completion(completion);
  CHECK(word == 0);

  word = 9;
  cond_init(cond);
  cond_signal(cond); /* nobody waits */
  cond_broadcast(cond);
  CHECK(word == 0);
  word = 3; /* three wait */
  cond_signal(cond);
  CHECK(word == 0x10003);
  cond_broadcast(cond);
  CHECK(word == 0x30003);
  cond_signal(cond);
  CHECK(word == 0x30003);
}

static unsigned int late_mutex, late_cond;

static void* comes_late(void* unused) {
  mutex_lock((uintptr_t)&late_mutex);
  cond_wait((uintptr_t)&late_cond, (uintptr_t)&late_mutex);
  mutex_unlock((uintptr_t)&late_mutex);
  return unused;
}

/* Who comes after a signal does not take it from whom it was given to. */
static void signals_have_owners(void) {
  pthread_t thread;
  late_cond = 0x10001;
  CHECK(pthread_create(&thread, NULL, comes_late, NULL) == 0);
  usleep(20000);
  CHECK(atomic_read((uintptr_t)&late_cond) == 0x10001 && atomic_read((uintptr_t)&late_mutex) == 1);
  atomic_sub(0x10001, (uintptr_t)&late_cond); /* its owner goes on */
  while (atomic_read((uintptr_t)&late_cond) != 1) usleep(100);
  cond_signal((uintptr_t)&late_cond);
  CHECK(pthread_join(thread, NULL) == 0 && late_cond == 0 && late_mutex == 0);
}

/* ---- with others: what spu/shares_objects.c does */

static void produce(unsigned int number) {
  mutex_lock(EA(mutex));
  while (shared.queue.count == kPlaces) cond_wait(EA(emptied), EA(mutex));
  shared.queue.numbers[(shared.queue.first + shared.queue.count++) % kPlaces] = number;
  cond_signal(EA(filled));
  mutex_unlock(EA(mutex));
}

static unsigned int consume(void) {
  unsigned int number;
  mutex_lock(EA(mutex));
  while (shared.queue.count == 0) cond_wait(EA(filled), EA(mutex));
  number = shared.queue.numbers[shared.queue.first];
  shared.queue.first = (shared.queue.first + 1) % kPlaces;
  --shared.queue.count;
  cond_signal(EA(emptied));
  mutex_unlock(EA(mutex));
  return number;
}

static void* work(void* argument) {
  const unsigned int index = (unsigned int)(uintptr_t)argument;
  unsigned int i, j;
  wait_for_completion(EA(start));
  wait_for_completion(EA(one));
  atomic_inc(EA(passed));

  mutex_lock(EA(gate_mutex));
  atomic_inc(EA(waiting));
  cond_wait(EA(gate), EA(gate_mutex));
  CHECK(mutex_trylock(EA(gate_mutex)) == 0);
  atomic_inc(EA(opened));
  mutex_unlock(EA(gate_mutex));

  for (i = 0; i < kNumbers; ++i) {
    if (index % 2 == 0) {
      produce(index * kNumbers + i);
    } else {
      atomic_add((int)consume(), EA(sum));
    }
  }
  for (i = 0; i < kRounds; ++i) {
    if (i % 8 == index) {
      write_lock(EA(lock));
      CHECK(atomic_read(EA(readers)) == 0);
      for (j = 0; j < 32; ++j) CHECK(shared.page.same[j] == shared.page.same[31]);
      for (j = 0; j < 32; ++j) ++shared.page.same[j];
      write_unlock(EA(lock));
    } else {
      read_lock(EA(lock));
      atomic_inc(EA(readers));
      for (j = 0; j < 32; ++j) CHECK(shared.page.same[j] == shared.page.same[0]);
      atomic_dec(EA(readers));
      read_unlock(EA(lock));
    }
  }
  return NULL;
}

static void expect_soon(atomic_ea_t counter, int value) {
  while (atomic_read(counter) < value) usleep(100);
  usleep(5000);
  CHECK(atomic_read(counter) == value);
}

static void together(void) {
  static job_t jobs[kSpes];
  spe_thread_t spes[kSpes];
  pthread_t threads[kThreads];
  unsigned int i, numbers = 0, writes = 0;
  init_completion(EA(start));
  init_completion(EA(one));
  init_completion(EA(ping));
  init_completion(EA(pong));
  cond_init(EA(gate));
  cond_init(EA(filled));
  cond_init(EA(emptied));
  mutex_init(EA(gate_mutex));
  mutex_init(EA(mutex));
  rwlock_init(EA(lock));
  for (i = 0; i < kSpes; ++i) {
    jobs[i].shared = (uintptr_t)&shared;
    jobs[i].index = i;
    start_spe(&spes[i], &shares_objects, 0, &jobs[i], NULL);
  }

  /* A completion lets one pass. As if a signal had an owner who has not yet gone on, the SPEs do not get to wait. */
  atomic_set(EA(gate), 0x10001);
  complete_all(EA(start));
  for (i = 1; i <= kSpes; ++i) {
    complete(EA(one));
    expect_soon(EA(passed), (int)i);
  }
  expect_soon(EA(waiting), 1);
  CHECK(atomic_read(EA(gate)) == 0x10001);
  atomic_sub(0x10001, EA(gate));
  for (i = 0; i < kThreads; ++i) {
    CHECK(pthread_create(&threads[i], NULL, work, (void*)(uintptr_t)(kSpes + i)) == 0);
    complete(EA(one));
    expect_soon(EA(passed), (int)(kSpes + i + 1));
  }

  /* A signal wakes one of those who wait, a broadcast all. */
  while (atomic_read(EA(waiting)) < kAll) usleep(100);
  mutex_lock(EA(gate_mutex)); /* now all wait */
  mutex_unlock(EA(gate_mutex));
  CHECK(atomic_read(EA(opened)) == 0);
  for (i = 1; i <= 2; ++i) {
    cond_signal(EA(gate));
    expect_soon(EA(opened), (int)i);
  }
  cond_broadcast(EA(gate));
  expect_soon(EA(opened), kAll);

  for (i = 0; i < kPasses; ++i) {
    complete(EA(ping));
    wait_for_completion(EA(pong));
  }
  for (i = 0; i < kSpes; ++i) CHECK(end_spe(&spes[i]) == 0);
  for (i = 0; i < kThreads; ++i) CHECK(pthread_join(threads[i], NULL) == 0);

  for (i = 0; i < kAll * kNumbers; ++i) {
    if (i / kNumbers % 2 == 0) numbers += i;
  }
  CHECK(shared.sum.word == numbers && shared.queue.count == 0);
  writes = kSpes * kRounds / 4 + kThreads * kRounds / 8;
  for (i = 0; i < 32; ++i) CHECK(shared.page.same[i] == writes);
  CHECK(shared.mutex.word == 0 && shared.lock.word == 0 && shared.filled.word == 0 && shared.emptied.word == 0);
}

int main(void) {
  words();
  locks();
  events();
  signals_have_owners();
  together();
  puts("ok");
  return 0;
}
