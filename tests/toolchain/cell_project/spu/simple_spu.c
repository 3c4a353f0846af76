#include <spu_mfcio.h>
#include "shared.h"

static work_t work __attribute__((aligned(128)));
vector unsigned int sums(unsigned int count);

int main(unsigned long long id, unsigned long long argp) {
  (void)id;
  mfc_get(&work, argp, sizeof work, 1, 0, 0);
  mfc_write_tag_mask(2);
  mfc_read_tag_status_all();
  work.sum = spu_extract(sums(work.count), 0) * work.factor;
  mfc_put(&work, argp, sizeof work, 1, 0, 0);
  mfc_read_tag_status_all();
  return 3;
}
