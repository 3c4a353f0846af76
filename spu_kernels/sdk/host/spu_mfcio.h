#pragma once
// DMA, channels, mailboxes, signals, events by name.  [LEXT, MFC input and output; CBEA, MFC commands]
// documented
//
// Everything here writes and reads channels, nothing else: what the emulator does not have answers with its
// own fault.

#ifndef __cplusplus
#include "../c/softcell_c_mfcio.h"
#else

#include "../shared/softcell_mfc_constants.h"
#include "softcell_tags.h"
#include "spu_intrinsics.h"

// ---- effective addresses

SC_SDK_INLINE constexpr unsigned int mfc_ea2h(uint64_t ea) { return static_cast<unsigned int>(ea >> 32); }
SC_SDK_INLINE constexpr unsigned int mfc_ea2l(uint64_t ea) { return static_cast<unsigned int>(ea); }
SC_SDK_INLINE constexpr uint64_t mfc_hl2ea(unsigned int high, unsigned int low) {
  return uint64_t{high} << 32 | low;
}

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
typedef struct mfc_list_element {
  uint32_t size : 15, reserved : 16, notify : 1;
  uint32_t eal;

  mfc_list_element() = default;
  /// In the order in which the SPU's compiler lays the fields out.
  constexpr mfc_list_element(uint32_t notify_bit, uint32_t reserved_bits, uint32_t size_bytes, uint32_t low)
      : size(size_bytes & 0x7FFFu), reserved(reserved_bits & 0xFFFFu), notify(notify_bit & 1u), eal(low) {}
} mfc_list_element_t;
static_assert(sizeof(mfc_list_element_t) == 8, "as the MFC reads it");

namespace softcell_sdk {
/// Where a list lies in local store: a pointer, or its address as a number, as a real SPU's header takes
/// both.
struct ListAddress {
  SC_SDK_INLINE ListAddress(const volatile void* list) : value(local_store_address(list)) {}
  SC_SDK_INLINE ListAddress(unsigned int list) : value(list) {}
  uint32_t value;
};
}  // namespace softcell_sdk

/// `ea` gives the high half of all elements' addresses, `list` lies in local store, `size` is its length in
/// bytes.
#define SC_SDK_LIST_TRANSFER(name, opcode)                                                                   \
  SC_SDK_INLINE void name(volatile void* ls, uint64_t ea, softcell_sdk::ListAddress list, unsigned int size, \
                          unsigned int tag, unsigned int tid, unsigned int rid) {                            \
    spu_mfcdma64(ls, mfc_ea2h(ea), list.value, size, tag, MFC_CMD_WORD(tid, rid, opcode));                   \
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

#endif
