// Uses the channel that argp chooses, where it may wait, and ends with the value's low byte. envp is the
// event mask, or what is written to the decrementer.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t argp, uint64_t envp) {
  const uint32_t argument = static_cast<uint32_t>(envp);
  switch (static_cast<uint32_t>(argp)) {
    case SPU_RdInMbox:
      return static_cast<int>(spu_read_in_mbox());
    case SPU_RdSigNotify1:
      return static_cast<int>(spu_read_signal1());
    case SPU_RdSigNotify2:
      return static_cast<int>(spu_read_signal2());
    case SPU_WrOutMbox:
      for (uint32_t i = 1; i <= argument; ++i) spu_write_out_mbox(i);
      return 0;
    case SPU_WrOutIntrMbox:
      for (uint32_t i = 1; i <= argument; ++i) spu_write_out_intr_mbox(i);
      return 0;
    case SPU_RdEventStat:
      spu_write_event_mask(argument);
      return static_cast<int>(spu_read_event_status());
    case SPU_RdDec:
      spu_write_event_mask(MFC_DECREMENTER_EVENT);
      spu_write_decrementer(argument);
      return static_cast<int>(spu_read_event_status());
    default:
      return 0xFF;
  }
}
