#pragma once
// DMA, channels, mailboxes, signals, events by name.  [LEXT, MFC input and output; CBEA, MFC commands]
// documented
//
// Everything here writes and reads channels, nothing else: what the emulator does not have answers with its
// own fault.

#include "softcell_tags.h"
#include "spu_intrinsics.h"

// ---- sizes, in bytes

#define MFC_MIN_DMA_SIZE_SHIFT 4
#define MFC_MAX_DMA_SIZE_SHIFT 14
#define MFC_MIN_DMA_SIZE (1 << MFC_MIN_DMA_SIZE_SHIFT)
#define MFC_MAX_DMA_SIZE (1 << MFC_MAX_DMA_SIZE_SHIFT)
#define MFC_MIN_DMA_SIZE_MASK (MFC_MIN_DMA_SIZE - 1)
#define MFC_MAX_DMA_SIZE_MASK (MFC_MAX_DMA_SIZE - 1)
#define MFC_MIN_DMA_LIST_ELEMENTS 1
#define MFC_MAX_DMA_LIST_ELEMENTS 2048
#define MFC_MIN_DMA_LIST_SIZE (MFC_MIN_DMA_LIST_ELEMENTS << 3)
#define MFC_MAX_DMA_LIST_SIZE (MFC_MAX_DMA_LIST_ELEMENTS << 3)

// ---- opcodes

#define MFC_BARRIER_ENABLE 0x01
#define MFC_FENCE_ENABLE 0x02
#define MFC_LIST_ENABLE 0x04
#define MFC_RESULT_ENABLE 0x10
#define MFC_PUT_CMD 0x20
#define MFC_PUTB_CMD 0x21
#define MFC_PUTF_CMD 0x22
#define MFC_PUTL_CMD 0x24
#define MFC_PUTLB_CMD 0x25
#define MFC_PUTLF_CMD 0x26
#define MFC_PUTR_CMD 0x30
#define MFC_PUTRB_CMD 0x31
#define MFC_PUTRF_CMD 0x32
#define MFC_PUTRL_CMD 0x34
#define MFC_PUTRLB_CMD 0x35
#define MFC_PUTRLF_CMD 0x36
#define MFC_GET_CMD 0x40
#define MFC_GETB_CMD 0x41
#define MFC_GETF_CMD 0x42
#define MFC_GETL_CMD 0x44
#define MFC_GETLB_CMD 0x45
#define MFC_GETLF_CMD 0x46
#define MFC_SNDSIG_CMD 0xA0
#define MFC_SNDSIGB_CMD 0xA1
#define MFC_SNDSIGF_CMD 0xA2
#define MFC_BARRIER_CMD 0xC0
#define MFC_EIEIO_CMD 0xC8
#define MFC_SYNC_CMD 0xCC
#define MFC_GETLLAR_CMD 0xD0
#define MFC_PUTLLC_CMD 0xB4
#define MFC_PUTLLUC_CMD 0xB0
#define MFC_PUTQLLUC_CMD 0xB8
#define MFC_SDCRT_CMD 0x80
#define MFC_SDCRTST_CMD 0x81
#define MFC_SDCRZ_CMD 0x89
#define MFC_SDCRST_CMD 0x8D
#define MFC_SDCRF_CMD 0x8F
#define MFC_CMD_WORD(tid, rid, opcode) (((tid) << 24) | ((rid) << 16) | (opcode))

// ---- values read from and written to channels

#define MFC_TAG_UPDATE_IMMEDIATE 0
#define MFC_TAG_UPDATE_ANY 1
#define MFC_TAG_UPDATE_ALL 2

#define MFC_PUTLLC_STATUS 0x1
#define MFC_PUTLLUC_STATUS 0x2
#define MFC_GETLLAR_STATUS 0x4

#define MFC_TAG_STATUS_UPDATE_EVENT 0x00000001
#define MFC_LIST_STALL_NOTIFY_EVENT 0x00000002
#define MFC_COMMAND_QUEUE_AVAILABLE_EVENT 0x00000008
#define MFC_IN_MBOX_AVAILABLE_EVENT 0x00000010
#define MFC_DECREMENTER_EVENT 0x00000020
#define MFC_OUT_INTR_MBOX_AVAILABLE_EVENT 0x00000040
#define MFC_OUT_MBOX_AVAILABLE_EVENT 0x00000080
#define MFC_SIGNAL_NOTIFY_2_EVENT 0x00000100
#define MFC_SIGNAL_NOTIFY_1_EVENT 0x00000200
#define MFC_LLR_LOST_EVENT 0x00000400
#define MFC_PRIV_ATTN_EVENT 0x00000800
#define MFC_MULTI_SRC_SYNC_EVENT 0x00001000

// ---- effective addresses

SC_SDK_INLINE constexpr unsigned int mfc_ea2h(uint64_t ea) { return static_cast<unsigned int>(ea >> 32); }
SC_SDK_INLINE constexpr unsigned int mfc_ea2l(uint64_t ea) { return static_cast<unsigned int>(ea); }
SC_SDK_INLINE constexpr uint64_t mfc_hl2ea(unsigned int high, unsigned int low) {
  return uint64_t{high} << 32 | low;
}
/// Rounds up to a multiple of 128.
#define mfc_ceil128(value) (((value) + 127) & ~127)

// ---- DMA: ls in local store, ea in main storage, size in bytes, tag 0..31; tid and rid are hints for
// caches, 0 is always right

#define SC_SDK_TRANSFER(name, opcode)                                                          \
  SC_SDK_INLINE void name(volatile void* ls, uint64_t ea, unsigned int size, unsigned int tag, \
                          unsigned int tid, unsigned int rid) {                                \
    spu_mfcdma64(ls, mfc_ea2h(ea), mfc_ea2l(ea), size, tag, MFC_CMD_WORD(tid, rid, opcode));   \
  }
SC_SDK_TRANSFER(mfc_put, MFC_PUT_CMD)
SC_SDK_TRANSFER(mfc_putb, MFC_PUTB_CMD)
SC_SDK_TRANSFER(mfc_putf, MFC_PUTF_CMD)
SC_SDK_TRANSFER(mfc_get, MFC_GET_CMD)
SC_SDK_TRANSFER(mfc_getb, MFC_GETB_CMD)
SC_SDK_TRANSFER(mfc_getf, MFC_GETF_CMD)
#undef SC_SDK_TRANSFER

/// One transfer of a list: size in bytes, ea's low half. The list's words have the SPU's values in the host's
/// byte order.
struct mfc_list_element_t {
  uint32_t size : 15, reserved : 16, notify : 1;
  uint32_t eal;

  mfc_list_element_t() = default;
  /// In the order in which the SPU's compiler lays the fields out.
  constexpr mfc_list_element_t(uint32_t notify_bit, uint32_t reserved_bits, uint32_t size_bytes, uint32_t low)
      : size(size_bytes & 0x7FFFu), reserved(reserved_bits & 0xFFFFu), notify(notify_bit & 1u), eal(low) {}
};
static_assert(sizeof(mfc_list_element_t) == 8, "as the MFC reads it");

/// `ea` gives the high half of all elements' addresses, `list` lies in local store, `size` is its length in
/// bytes.
#define SC_SDK_LIST_TRANSFER(name, opcode)                                                              \
  SC_SDK_INLINE void name(volatile void* ls, uint64_t ea, const volatile void* list, unsigned int size, \
                          unsigned int tag, unsigned int tid, unsigned int rid) {                       \
    spu_mfcdma64(ls, mfc_ea2h(ea), softcell_sdk::local_store_address(list), size, tag,                  \
                 MFC_CMD_WORD(tid, rid, opcode));                                                       \
  }
SC_SDK_LIST_TRANSFER(mfc_putl, MFC_PUTL_CMD)
SC_SDK_LIST_TRANSFER(mfc_putlb, MFC_PUTLB_CMD)
SC_SDK_LIST_TRANSFER(mfc_putlf, MFC_PUTLF_CMD)
SC_SDK_LIST_TRANSFER(mfc_getl, MFC_GETL_CMD)
SC_SDK_LIST_TRANSFER(mfc_getlb, MFC_GETLB_CMD)
SC_SDK_LIST_TRANSFER(mfc_getlf, MFC_GETLF_CMD)
#undef SC_SDK_LIST_TRANSFER

// ---- a line of 128 bytes at once, immediate but for the queued putqlluc

SC_SDK_INLINE void mfc_getllar(volatile void* ls, uint64_t ea, unsigned int tid, unsigned int rid) {
  spu_mfcdma64(ls, mfc_ea2h(ea), mfc_ea2l(ea), 128, 0, MFC_CMD_WORD(tid, rid, MFC_GETLLAR_CMD));
}
SC_SDK_INLINE void mfc_putllc(volatile void* ls, uint64_t ea, unsigned int tid, unsigned int rid) {
  spu_mfcdma64(ls, mfc_ea2h(ea), mfc_ea2l(ea), 128, 0, MFC_CMD_WORD(tid, rid, MFC_PUTLLC_CMD));
}
SC_SDK_INLINE void mfc_putlluc(volatile void* ls, uint64_t ea, unsigned int tid, unsigned int rid) {
  spu_mfcdma64(ls, mfc_ea2h(ea), mfc_ea2l(ea), 128, 0, MFC_CMD_WORD(tid, rid, MFC_PUTLLUC_CMD));
}
SC_SDK_INLINE void mfc_putqlluc(volatile void* ls, uint64_t ea, unsigned int tag, unsigned int tid,
                                unsigned int rid) {
  spu_mfcdma64(ls, mfc_ea2h(ea), mfc_ea2l(ea), 128, tag, MFC_CMD_WORD(tid, rid, MFC_PUTQLLUC_CMD));
}

// ---- signals, order, hints to the data cache

#define SC_SDK_SIGNAL(name, opcode)                                                           \
  SC_SDK_INLINE void name(volatile void* ls, uint64_t ea, unsigned int tag, unsigned int tid, \
                          unsigned int rid) {                                                 \
    spu_mfcdma64(ls, mfc_ea2h(ea), mfc_ea2l(ea), 4, tag, MFC_CMD_WORD(tid, rid, opcode));     \
  }
SC_SDK_SIGNAL(mfc_sndsig, MFC_SNDSIG_CMD)
SC_SDK_SIGNAL(mfc_sndsigb, MFC_SNDSIGB_CMD)
SC_SDK_SIGNAL(mfc_sndsigf, MFC_SNDSIGF_CMD)
#undef SC_SDK_SIGNAL

SC_SDK_INLINE void mfc_barrier(unsigned int tag) { spu_mfcdma32(nullptr, 0, 0, tag, MFC_BARRIER_CMD); }
SC_SDK_INLINE void mfc_eieio(unsigned int tag, unsigned int tid, unsigned int rid) {
  spu_mfcdma32(nullptr, 0, 0, tag, MFC_CMD_WORD(tid, rid, MFC_EIEIO_CMD));
}
SC_SDK_INLINE void mfc_sync(unsigned int tag) { spu_mfcdma32(nullptr, 0, 0, tag, MFC_SYNC_CMD); }

#define SC_SDK_CACHE_HINT(name, opcode)                                                           \
  SC_SDK_INLINE void name(uint64_t ea, unsigned int size, unsigned int tag, unsigned int tid,     \
                          unsigned int rid) {                                                     \
    spu_mfcdma64(nullptr, mfc_ea2h(ea), mfc_ea2l(ea), size, tag, MFC_CMD_WORD(tid, rid, opcode)); \
  }
SC_SDK_CACHE_HINT(mfc_sdcrt, MFC_SDCRT_CMD)
SC_SDK_CACHE_HINT(mfc_sdcrtst, MFC_SDCRTST_CMD)
SC_SDK_CACHE_HINT(mfc_sdcrz, MFC_SDCRZ_CMD)
SC_SDK_CACHE_HINT(mfc_sdcrst, MFC_SDCRST_CMD)
SC_SDK_CACHE_HINT(mfc_sdcrf, MFC_SDCRF_CMD)
#undef SC_SDK_CACHE_HINT

// ---- the queue and tag groups

/// Free slots of the queue, 0..16.
SC_SDK_INLINE unsigned int mfc_stat_cmd_queue() { return spu_readchcnt(MFC_Cmd); }
/// Which tag groups the reads below are about, a bit each.
SC_SDK_INLINE void mfc_write_tag_mask(unsigned int mask) { spu_writech(MFC_WrTagMask, mask); }
SC_SDK_INLINE unsigned int mfc_read_tag_mask() { return spu_readch(MFC_RdTagMask); }
SC_SDK_INLINE void mfc_write_tag_update(unsigned int condition) { spu_writech(MFC_WrTagUpdate, condition); }
SC_SDK_INLINE void mfc_write_tag_update_immediate() { mfc_write_tag_update(MFC_TAG_UPDATE_IMMEDIATE); }
SC_SDK_INLINE void mfc_write_tag_update_any() { mfc_write_tag_update(MFC_TAG_UPDATE_ANY); }
SC_SDK_INLINE void mfc_write_tag_update_all() { mfc_write_tag_update(MFC_TAG_UPDATE_ALL); }
SC_SDK_INLINE unsigned int mfc_stat_tag_update() { return spu_readchcnt(MFC_WrTagUpdate); }
/// Blocks until the condition written last holds; returns the complete tag groups of the mask.
SC_SDK_INLINE unsigned int mfc_read_tag_status() { return spu_readch(MFC_RdTagStat); }
SC_SDK_INLINE unsigned int mfc_read_tag_status_immediate() { return spu_mfcstat(MFC_TAG_UPDATE_IMMEDIATE); }
/// Blocks until a tag group of the mask is complete.
SC_SDK_INLINE unsigned int mfc_read_tag_status_any() { return spu_mfcstat(MFC_TAG_UPDATE_ANY); }
/// Blocks until all tag groups of the mask are complete.
SC_SDK_INLINE unsigned int mfc_read_tag_status_all() { return spu_mfcstat(MFC_TAG_UPDATE_ALL); }
SC_SDK_INLINE unsigned int mfc_stat_tag_status() { return spu_readchcnt(MFC_RdTagStat); }

SC_SDK_INLINE unsigned int mfc_read_list_stall_status() { return spu_readch(MFC_RdListStallStat); }
SC_SDK_INLINE unsigned int mfc_stat_list_stall_status() { return spu_readchcnt(MFC_RdListStallStat); }
SC_SDK_INLINE void mfc_write_list_stall_ack(unsigned int tag) { spu_writech(MFC_WrListStallAck, tag); }
SC_SDK_INLINE unsigned int mfc_read_atomic_status() { return spu_readch(MFC_RdAtomicStat); }
SC_SDK_INLINE unsigned int mfc_stat_atomic_status() { return spu_readchcnt(MFC_RdAtomicStat); }
SC_SDK_INLINE void mfc_write_multi_src_sync_request() { spu_writech(MFC_WrMSSyncReq, 0); }
SC_SDK_INLINE unsigned int mfc_stat_multi_src_sync_request() { return spu_readchcnt(MFC_WrMSSyncReq); }

// ---- signals, mailboxes, decrementer, events

SC_SDK_INLINE unsigned int spu_read_signal1() { return spu_readch(SPU_RdSigNotify1); }
SC_SDK_INLINE unsigned int spu_stat_signal1() { return spu_readchcnt(SPU_RdSigNotify1); }
SC_SDK_INLINE unsigned int spu_read_signal2() { return spu_readch(SPU_RdSigNotify2); }
SC_SDK_INLINE unsigned int spu_stat_signal2() { return spu_readchcnt(SPU_RdSigNotify2); }
SC_SDK_INLINE unsigned int spu_read_in_mbox() { return spu_readch(SPU_RdInMbox); }
SC_SDK_INLINE unsigned int spu_stat_in_mbox() { return spu_readchcnt(SPU_RdInMbox); }
SC_SDK_INLINE void spu_write_out_mbox(unsigned int value) { spu_writech(SPU_WrOutMbox, value); }
SC_SDK_INLINE unsigned int spu_stat_out_mbox() { return spu_readchcnt(SPU_WrOutMbox); }
SC_SDK_INLINE void spu_write_out_intr_mbox(unsigned int value) { spu_writech(SPU_WrOutIntrMbox, value); }
SC_SDK_INLINE unsigned int spu_stat_out_intr_mbox() { return spu_readchcnt(SPU_WrOutIntrMbox); }
SC_SDK_INLINE unsigned int spu_read_decrementer() { return spu_readch(SPU_RdDec); }
SC_SDK_INLINE void spu_write_decrementer(unsigned int ticks) { spu_writech(SPU_WrDec, ticks); }
SC_SDK_INLINE unsigned int spu_read_event_status() { return spu_readch(SPU_RdEventStat); }
SC_SDK_INLINE unsigned int spu_stat_event_status() { return spu_readchcnt(SPU_RdEventStat); }
SC_SDK_INLINE void spu_write_event_mask(unsigned int mask) { spu_writech(SPU_WrEventMask, mask); }
SC_SDK_INLINE void spu_write_event_ack(unsigned int events) { spu_writech(SPU_WrEventAck, events); }
SC_SDK_INLINE unsigned int spu_read_event_mask() { return spu_readch(SPU_RdEventMask); }
SC_SDK_INLINE unsigned int spu_read_machine_status() { return spu_readch(SPU_RdMachStat); }
SC_SDK_INLINE void spu_write_srr0(unsigned int address) { spu_writech(SPU_WrSRR0, address); }
SC_SDK_INLINE unsigned int spu_read_srr0() { return spu_readch(SPU_RdSRR0); }

/// Around code that an interrupt handler must not cut into. Jobs on the host have no interrupts.
SC_SDK_INLINE unsigned int mfc_begin_critical_section() { return 0; }
SC_SDK_INLINE void mfc_end_critical_section(unsigned int) {}
