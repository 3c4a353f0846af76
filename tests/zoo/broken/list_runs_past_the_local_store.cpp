// rule: lsa-out-of-range
// names: getl
// twin: legal/last_bytes_of_local_store
// Gathers to the top of the local store more than fits there: it is the sum of the elements that counts.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(8) static mfc_list_element_t list[2];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0] = {0, 0, 0, mfc_ea2l(argp)};
  list[1] = {0, 0, 256, mfc_ea2l(argp)};
  mfc_getl(reinterpret_cast<void*>(uintptr_t{0x3FF80}), argp, list, sizeof list, 5, 0, 0);  // BROKEN
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  return 0;
}
