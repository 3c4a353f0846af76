/* Breaks the rule that its first argument names; the second is an address for it. */
#include <spu_intrinsics.h>
#include <spu_mfcio.h>
static char buffer[16] __attribute__((aligned(16)));
static mfc_list_element_t list[1] __attribute__((aligned(8)));
int main(uint64_t what, uint64_t ea, uint64_t c, uint64_t d) {
  (void)c, (void)d;
  switch (what) {
    case 0: /* fetches from where nothing is */
      mfc_get(buffer, 0x7000000000ull, sizeof buffer, 0, 0, 0);
      break;
    case 1:
      list[0].size = 16;
      list[0].eal = mfc_ea2l(ea) + 4;
      mfc_getl(buffer, ea, list, sizeof list, 0, 0, 0);
      break;
    case 2:
      mfc_get(buffer, ea, 0, 0, 0, 0);
      break;
    case 3:
      mfc_get(buffer + 4, ea + 8, 4, 0, 0, 0);
      break;
    default:
      spu_hcmpeq((int)what, 4);
      break;
  }
  mfc_write_tag_mask(1);
  mfc_read_tag_status_all();
  return buffer[0];
}
