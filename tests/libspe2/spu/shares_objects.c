/* One of the SPEs that share objects of libsync.h with threads of the PPU side. Returns the line of what is not true, or 0. */
#include <libsync.h>
#include <spu_mfcio.h>
#include <stddef.h>
#include <stdint.h>

#include "shared_objects.h"

#define CHECK(condition)           \
  do {                             \
    if (!(condition)) return __LINE__; \
  } while (0)
#define EA(member) (job.shared + offsetof(shared_t, member))

static job_t job;
static queue_t queue;
static page_t page;

static void get(void* to, uint64_t ea, unsigned int bytes) {
  mfc_get(to, ea, bytes, 5, 0, 0);
  mfc_write_tag_mask(1 << 5);
  mfc_read_tag_status_all();
}

static void put(void* from, uint64_t ea, unsigned int bytes) {
  mfc_put(from, ea, bytes, 5, 0, 0);
  mfc_write_tag_mask(1 << 5);
  mfc_read_tag_status_all();
}

static void produce(unsigned int number) {
  mutex_lock(EA(mutex));
  for (get(&queue, EA(queue), sizeof queue); queue.count == kPlaces; get(&queue, EA(queue), sizeof queue))
    cond_wait(EA(emptied), EA(mutex));
  queue.numbers[(queue.first + queue.count++) % kPlaces] = number;
  put(&queue, EA(queue), sizeof queue);
  cond_signal(EA(filled));
  mutex_unlock(EA(mutex));
}

static unsigned int consume(void) {
  unsigned int number;
  mutex_lock(EA(mutex));
  for (get(&queue, EA(queue), sizeof queue); queue.count == 0; get(&queue, EA(queue), sizeof queue))
    cond_wait(EA(filled), EA(mutex));
  number = queue.numbers[queue.first];
  queue.first = (queue.first + 1) % kPlaces;
  --queue.count;
  put(&queue, EA(queue), sizeof queue);
  cond_signal(EA(emptied));
  mutex_unlock(EA(mutex));
  return number;
}

static int write(void) {
  int i;
  write_lock(EA(lock));
  CHECK(atomic_read(EA(readers.word)) == 0);
  get(&page, EA(page), sizeof page);
  for (i = 0; i < 32; ++i) {
    CHECK(page.same[i] == page.same[0] || i == 0);
  }
  for (i = 0; i < 32; ++i) {
    ++page.same[i];
    put(&page, EA(page), sizeof page);
  }
  write_unlock(EA(lock));
  return 0;
}

static int read(void) {
  int i;
  read_lock(EA(lock));
  atomic_inc(EA(readers.word));
  get(&page, EA(page), sizeof page);
  for (i = 1; i < 32; ++i) CHECK(page.same[i] == page.same[0]);
  atomic_dec(EA(readers.word));
  read_unlock(EA(lock));
  return 0;
}

int main(uint64_t id, uint64_t argp) {
  unsigned int i;
  (void)id;
  get(&job, argp, sizeof job);
  /* An event of the program's own stays enabled whatever the library waits for. */
  spu_write_event_mask(MFC_SIGNAL_NOTIFY_1_EVENT);

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
    if (job.index % 2 == 0) {
      produce(job.index * kNumbers + i);
    } else {
      atomic_add((int)consume(), EA(sum));
    }
  }
  for (i = 0; i < kRounds; ++i) {
    const int wrong = i % 4 == job.index ? write() : read();
    if (wrong != 0) return wrong;
  }
  for (i = 0; job.index == 0 && i < kPasses; ++i) {
    wait_for_completion(EA(ping));
    complete(EA(pong));
  }
  CHECK(spu_read_event_mask() == MFC_SIGNAL_NOTIFY_1_EVENT);
  return 0;
}
