// Breaks the rule that argp names; envp is an address for it.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static volatile unsigned int buffer[64];

int main(uint64_t, uint64_t argp, uint64_t envp) {
  mfc_write_tag_mask(1);
  switch (argp) {
    case 1:
      mfc_get(buffer, envp + 4, 64, 0, 0, 0);
      break;
    case 2:
      mfc_get(buffer, envp, 64, 0, 0, 0);
      break;
    case 3:
      mfc_put(buffer, envp, 64, 0, 0, 0);
      break;
    case 4:
      mfc_get(buffer, envp, 64, 77, 0, 0);
      break;
    case 5:
      spu_stop(0);
      break;
    case 6:
      for (;;) spu_readchcnt(29);
    case 7:
      mfc_get(buffer, envp, 64, 0, 0, 0);
      return static_cast<int>(buffer[0]);  // not waited for
    case 8:
      spu_hcmpeq(static_cast<int>(argp), 8);
      break;
    case 9:
      spu_writech(99, 0);
      break;
    case 10:
      spu_stop(0x2101);
      break;
    case 11:
      mfc_get(buffer, envp, 64, 0, 0, 0);
      if (buffer[0] != 12345) spu_stop(0x2110);  // not waited for
      break;
    case 12:
      mfc_get(buffer, envp, 0, 0, 0, 0);
      break;
    case 13:
      mfc_putlluc(buffer, envp + 16, 0, 0);
      break;
    default:
      break;
  }
  mfc_read_tag_status_all();
  return 0;
}
