// One stage of a pipeline. It says through its mailbox where blocks are to come, and waits for a message to begin. It adds 1 to each word and puts them into the next
// stage's, or to memory behind the last one. Signal 1: a block has come. Signal 2 of the one before: its place is free.
// argp: what follows.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

struct Stage {
  unsigned long long next_block, next_signal;  // of the stage behind; next_signal 0: memory
  unsigned long long previous_signal;          // of the stage before; 0: none
  unsigned long long source;                   // of the first stage
  unsigned int blocks, first, padding[2];
};
static constexpr unsigned int kWords = 256, kBytes = kWords * 4;

alignas(128) static Stage stage;
alignas(16) static volatile unsigned int signal_word[4] = {0, 0, 0, 1};
alignas(128) static unsigned int work[kWords];

alignas(128) static volatile unsigned int arrived[kWords];

static void wait_for_tag() {
  mfc_write_tag_mask(1u << 2);
  mfc_read_tag_status_all();
}

int main(uint64_t, uint64_t argp, uint64_t) {
  spu_write_out_mbox(static_cast<unsigned int>(reinterpret_cast<uintptr_t>(arrived) & 0x3FFFF));
  spu_read_in_mbox();
  mfc_get(&stage, argp, sizeof stage, 2, 0, 0);
  wait_for_tag();
  for (unsigned int block = 0; block < stage.blocks; ++block) {
    if (stage.first != 0) {
      mfc_get(work, stage.source + block * kBytes, kBytes, 2, 0, 0);
      wait_for_tag();
    } else {
      spu_read_signal1();
      for (unsigned int i = 0; i < kWords; ++i) work[i] = arrived[i];
      mfc_sndsig(&signal_word[3], stage.previous_signal, 2, 0, 0);
      wait_for_tag();
    }
    for (unsigned int i = 0; i < kWords; ++i) ++work[i];
    if (stage.next_signal == 0) {
      mfc_put(work, stage.next_block + block * kBytes, kBytes, 2, 0, 0);
    } else {
      if (block != 0) spu_read_signal2();
      mfc_put(work, stage.next_block, kBytes, 2, 0, 0);
      mfc_sndsigb(&signal_word[3], stage.next_signal, 2, 0, 0);
    }
    wait_for_tag();
  }
  if (stage.next_signal != 0) spu_read_signal2();  // the last block was taken
  return 0;
}
