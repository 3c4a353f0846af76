#include <spu_mfcio.h>
#include "shared.h"
#include "times.h"

static work_t work __attribute__((aligned(128)));
vector unsigned int sums(unsigned int count);
int is_right(unsigned int sum, unsigned int factor, unsigned int product);

int main(unsigned long long id, unsigned long long argp) {
  (void)id;
  mfc_get(&work, argp, sizeof work, 1, 0, 0);
  mfc_write_tag_mask(2);
  mfc_read_tag_status_all();
  work.sum = times(spu_extract(sums(work.count), 0), work.factor);
  if (!is_right(work.sum / work.factor, work.factor, work.sum)) return 1;
  mfc_put(&work, argp, sizeof work, 1, 0, 0);
  mfc_read_tag_status_all();
  return 3;
}
