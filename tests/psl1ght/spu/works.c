/* Takes work from the queue that is bound as 7, answers by an event of port 3, and ends when it gets no work. */
#include <spu_mfcio.h>
#include <sys/spu_event.h>
#include <sys/spu_thread.h>

int main(uint64_t rank, uint64_t tries, uint64_t c, uint64_t d) {
  uint32_t first, count, flags, i;
  for (;;) {
    uint32_t sum = 0;
    if (tries) {
      while (spu_thread_tryreceive_event(7, &first, &count, &flags) != 0) spu_thread_group_yield();
    } else if (spu_thread_receive_event(7, &first, &count, &flags) != 0) {
      return 1;
    }
    if (count == 0) break;
    for (i = first; i < first + count; i++) sum += i;
    if (spu_thread_send_event(3, first, sum) != 0) return 2;
  }
  spu_thread_throw_event(4, (uint32_t)rank, flags);
  spu_thread_exit(0);
  return 0;
}
