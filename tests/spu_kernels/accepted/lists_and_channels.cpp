// sdk: check host
// List commands, atomic lines, signals, mailboxes, events, the tag manager.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned char buffer[16384];
alignas(8) static mfc_list_element_t list[4];
static_assert(sizeof(mfc_list_element_t) == 8, "two words");

int main(uint64_t, uint64_t argp, uint64_t envp) {
  const unsigned int tag = mfc_tag_reserve();
  if (tag == MFC_TAG_INVALID) return 1;
  list[0].notify = 1;
  list[0].size = MFC_MAX_DMA_SIZE;
  list[0].eal = mfc_ea2l(argp);
  mfc_getl(buffer, argp, list, sizeof list, tag, 0, 0);
  mfc_getl(buffer, argp, reinterpret_cast<uintptr_t>(list), sizeof list, tag, 0, 0);
  mfc_getlf(buffer, argp, &list[1], sizeof(mfc_list_element_t), tag, 0, 0);
  mfc_putlb(buffer, argp, list, sizeof list, tag, 0, 0);
  if (mfc_stat_list_stall_status()) mfc_write_list_stall_ack(mfc_read_list_stall_status() & tag);

  do {
    mfc_getllar(buffer, envp, 0, 0);
    (void)mfc_read_atomic_status();
    mfc_putllc(buffer, envp, 0, 0);
  } while (mfc_read_atomic_status() & MFC_PUTLLC_STATUS);
  mfc_putlluc(buffer, envp, 0, 0);
  mfc_putqlluc(buffer, envp, tag, 0, 0);

  mfc_sndsig(buffer, argp, tag, 0, 0);
  mfc_barrier(tag);
  mfc_eieio(tag, 0, 0);
  mfc_sync(tag);
  mfc_sdcrz(argp, 128, tag, 0, 0);

  spu_write_event_mask(MFC_DECREMENTER_EVENT | MFC_SIGNAL_NOTIFY_1_EVENT);
  spu_write_decrementer(1000);
  if (spu_stat_event_status()) spu_write_event_ack(spu_read_event_status());
  spu_write_out_mbox(spu_read_in_mbox() + spu_read_signal1() + spu_read_decrementer());
  if (spu_stat_out_intr_mbox()) spu_write_out_intr_mbox(1);
  spu_writech(MFC_WrTagMask, 1u << tag);
  spu_writech(MFC_WrTagUpdate, MFC_TAG_UPDATE_ALL);
  const unsigned int done = spu_readch(MFC_RdTagStat) + spu_readchcnt(SPU_RdInMbox);
  mfc_tag_release(tag);
  return static_cast<int>(done);
}
