// Does what its inbound mailbox says.

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

enum Request : unsigned int { kEndWithStatus7 = 1, kMisalignedGet = 2, kReadAgain = 3, kStop = 4, kSpin = 5 };

static vec_uint4 quadword;

int main(uint64_t spe, uint64_t argp, uint64_t envp) {
  const unsigned int request = spu_read_in_mbox();
  switch (request) {
    case kEndWithStatus7:
      return 7;
    case kMisalignedGet:
      mfc_get(&quadword, argp + 8, 16, 0, 0, 0);
      return 0;
    case kReadAgain:
      spu_read_in_mbox();
      return 0;
    case kStop:
      spu_stop(0x123);
      return 0;
    case kSpin:
      for (;;) (void)spu_stat_in_mbox();
    default:
      spu_write_out_mbox(request + static_cast<unsigned int>(spe));
      spu_write_out_intr_mbox(static_cast<unsigned int>(envp));
      return 0;
  }
}
