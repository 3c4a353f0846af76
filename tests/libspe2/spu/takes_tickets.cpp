// A queue of numbers in a line: word 0 is the next index, word 1 how many there are. Each SPE takes indices until there
// are none, and adds up the squares. argp: { ea of the line, ea for the sum }.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

struct Job {
  unsigned long long line, sum;
};
alignas(128) static Job job;
alignas(128) static volatile unsigned int line[32];
alignas(16) static unsigned long long sum[2];

static unsigned int take() {
  for (;;) {
    mfc_getllar(line, job.line, 0, 0);
    mfc_read_atomic_status();
    const unsigned int index = line[0];
    if (index == line[1]) return index;
    line[0] = index + 1;
    mfc_putllc(line, job.line, 0, 0);
    if ((mfc_read_atomic_status() & MFC_PUTLLC_STATUS) == 0) return index;
  }
}

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_write_tag_mask(1);
  mfc_get(&job, argp, sizeof job, 0, 0, 0);
  mfc_read_tag_status_all();
  for (;;) {
    const unsigned int index = take();
    if (index == line[1]) break;
    sum[0] += static_cast<unsigned long long>(index) * index;
  }
  mfc_put(sum, job.sum, 16, 0, 0, 0);
  mfc_read_tag_status_all();
  return 0;
}
