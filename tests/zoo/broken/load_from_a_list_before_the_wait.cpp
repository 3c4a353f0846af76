// rule: load-in-flight
// names: getl
// twin: legal/list_at_multiple_of_8
// build: checked
// Reads the second of two blocks that a list gathers, before the wait.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile uint32_t buffer[64];
alignas(8) static mfc_list_element_t list[2];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {0, 0, 128, mfc_ea2l(argp)};
  list[1] = {0, 0, 128, mfc_ea2l(argp) + 4096};
  mfc_getl(buffer, argp, list, sizeof list, 3, 0, 0);
  const uint32_t word = buffer[32];  // BROKEN
  mfc_write_tag_mask(1u << 3);
  mfc_read_tag_status_all();
  return word == 0xFFFFFFFFu ? 1 : 0;
}
