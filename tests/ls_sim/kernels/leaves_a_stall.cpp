// Gets 128 bytes from argp by a list that stalls, and ends without acknowledging that.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static char buffer[256];
alignas(8) static mfc_list_element_t list[2];

int main(uint64_t, uint64_t argp, uint64_t) {
  list[0].notify = 1;
  list[0].reserved = list[1].reserved = 0;
  list[0].size = 16;
  list[0].eal = mfc_ea2l(argp);
  list[1].notify = 0;
  list[1].size = 112;
  list[1].eal = mfc_ea2l(argp + 16);
  mfc_getl(buffer, argp, list, sizeof list, 3, 0, 0);
  return 0;
}
