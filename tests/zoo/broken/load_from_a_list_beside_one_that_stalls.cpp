// rule: load-in-flight
// names: getl
// twin: legal/list_at_multiple_of_8
// build: checked
// Takes the stall of one list for news of another of its tag, whose own stall bit, on the last element, says
// nothing.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t first[64], second[64];
alignas(8) static mfc_list_element_t stalls[2], goes_on[2];

int main(uint64_t, uint64_t argp, uint64_t) {
  stalls[0] = {1, 0, 128, mfc_ea2l(argp)};
  stalls[1] = {0, 0, 128, mfc_ea2l(argp) + 4096};
  goes_on[0] = {0, 0, 128, mfc_ea2l(argp)};
  goes_on[1] = {1, 0, 128, mfc_ea2l(argp) + 4096};
  mfc_getl(first, argp, stalls, sizeof stalls, 5, 0, 0);
  mfc_getl(second, argp, goes_on, sizeof goes_on, 5, 0, 0);
  mfc_read_list_stall_status();
  const uint32_t word = second[32];  // BROKEN
  mfc_write_list_stall_ack(5);
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return word == 0xFFFFFFFFu ? 1 : 0;
}
