// argp: { ea of a table of addresses, number }. Gathers records of 32 bytes by one list and scatters them by another, in
// reverse order.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

struct Job {
  unsigned long long table;
  unsigned int count, padding;
};
static constexpr unsigned int kMost = 64, kRecord = 32;

alignas(128) static Job job;
alignas(128) static unsigned long long table[kMost];
alignas(128) static unsigned char records[kMost * kRecord];
alignas(16) static mfc_list_element_t list[kMost];

static void make_list(bool reverse) {
  for (unsigned int i = 0; i < job.count; ++i) {
    const unsigned int from = reverse ? job.count - 1 - i : i;
    list[i].notify = 0;
    list[i].reserved = 0;
    list[i].size = kRecord;
    list[i].eal = mfc_ea2l(table[from]);
  }
}

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_write_tag_mask(1u << 5);
  mfc_get(&job, argp, sizeof job, 5, 0, 0);
  mfc_read_tag_status_all();
  mfc_get(table, job.table, kMost * 8, 5, 0, 0);
  mfc_read_tag_status_all();
  make_list(false);
  mfc_getl(records, table[0], list, job.count * 8, 5, 0, 0);
  mfc_read_tag_status_all();
  make_list(true);
  mfc_putl(records, table[0], list, job.count * 8, 5, 0, 0);
  mfc_read_tag_status_all();
  return static_cast<int>(job.count);
}
