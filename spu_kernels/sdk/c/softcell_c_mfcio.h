/* spu_mfcio.h for C: DMA, channels, mailboxes, signals, events by name; that for C++ is sdk/host/spu_mfcio.h.
 * [LEXT, MFC input and output; CBEA, MFC commands] documented
 */
#ifndef SOFTCELL_C_MFCIO_H
#define SOFTCELL_C_MFCIO_H

#include "../shared/softcell_mfc_constants.h"
#include "softcell_c.h"

// ---- effective addresses

SC_C_INLINE unsigned int mfc_ea2h(uint64_t ea) { return (unsigned int)(ea >> 32); }
SC_C_INLINE unsigned int mfc_ea2l(uint64_t ea) { return (unsigned int)ea; }
SC_C_INLINE uint64_t mfc_hl2ea(unsigned int high, unsigned int low) { return (uint64_t)high << 32 | low; }

// ---- DMA: ls in local store, ea in main storage, size in bytes, tag 0..31; tid and rid are hints for
// caches, 0 is always right

#define SC_C_TRANSFER(name, opcode)                                                          \
  SC_C_INLINE void name(volatile void* ls, uint64_t ea, unsigned int size, unsigned int tag, \
                        unsigned int tid, unsigned int rid) {                                \
    spu_mfcdma64(ls, mfc_ea2h(ea), mfc_ea2l(ea), size, tag, MFC_CMD_WORD(tid, rid, opcode)); \
  }
SC_C_TRANSFER(mfc_put, MFC_PUT_CMD)
SC_C_TRANSFER(mfc_putb, MFC_PUTB_CMD)
SC_C_TRANSFER(mfc_putf, MFC_PUTF_CMD)
SC_C_TRANSFER(mfc_get, MFC_GET_CMD)
SC_C_TRANSFER(mfc_getb, MFC_GETB_CMD)
SC_C_TRANSFER(mfc_getf, MFC_GETF_CMD)
#undef SC_C_TRANSFER

// One transfer of a list: size in bytes, ea's low half. The list's words have the SPU's values in the host's
// byte order; therefore the fields stand in another order than on an SPU: initialise them by their names.
typedef struct mfc_list_element {
  uint32_t size : 15, reserved : 16, notify : 1;
  uint32_t eal;
} mfc_list_element_t;

// Where a list lies in local store: a pointer, or its address as a number.
#define SC_C_LIST(list) ((uint32_t)(uintptr_t)(list)&0x3FFFF)

// `ea` gives the high half of all elements' addresses, `list` lies in local store, `size` is its length in
// bytes.
#define SC_C_LIST_TRANSFER(name, opcode)                                                                    \
  SC_C_INLINE void name(volatile void* ls, uint64_t ea, uint32_t list, unsigned int size, unsigned int tag, \
                        unsigned int tid, unsigned int rid) {                                               \
    spu_mfcdma64(ls, mfc_ea2h(ea), list, size, tag, MFC_CMD_WORD(tid, rid, opcode));                        \
  }
SC_C_LIST_TRANSFER(softcell_mfc_putl, MFC_PUTL_CMD)
#define mfc_putl(ls, ea, list, size, tag, tid, rid) \
  (softcell_mfc_putl((ls), (ea), SC_C_LIST(list), (size), (tag), (tid), (rid)))
SC_C_LIST_TRANSFER(softcell_mfc_putlb, MFC_PUTLB_CMD)
#define mfc_putlb(ls, ea, list, size, tag, tid, rid) \
  (softcell_mfc_putlb((ls), (ea), SC_C_LIST(list), (size), (tag), (tid), (rid)))
SC_C_LIST_TRANSFER(softcell_mfc_putlf, MFC_PUTLF_CMD)
#define mfc_putlf(ls, ea, list, size, tag, tid, rid) \
  (softcell_mfc_putlf((ls), (ea), SC_C_LIST(list), (size), (tag), (tid), (rid)))
SC_C_LIST_TRANSFER(softcell_mfc_getl, MFC_GETL_CMD)
#define mfc_getl(ls, ea, list, size, tag, tid, rid) \
  (softcell_mfc_getl((ls), (ea), SC_C_LIST(list), (size), (tag), (tid), (rid)))
SC_C_LIST_TRANSFER(softcell_mfc_getlb, MFC_GETLB_CMD)
#define mfc_getlb(ls, ea, list, size, tag, tid, rid) \
  (softcell_mfc_getlb((ls), (ea), SC_C_LIST(list), (size), (tag), (tid), (rid)))
SC_C_LIST_TRANSFER(softcell_mfc_getlf, MFC_GETLF_CMD)
#define mfc_getlf(ls, ea, list, size, tag, tid, rid) \
  (softcell_mfc_getlf((ls), (ea), SC_C_LIST(list), (size), (tag), (tid), (rid)))
#undef SC_C_LIST_TRANSFER

// ---- a line of 128 bytes at once, immediate but for the queued putqlluc

SC_C_INLINE void mfc_getllar(volatile void* ls, uint64_t ea, unsigned int tid, unsigned int rid) {
  spu_mfcdma64(ls, mfc_ea2h(ea), mfc_ea2l(ea), 128, 0, MFC_CMD_WORD(tid, rid, MFC_GETLLAR_CMD));
}
SC_C_INLINE void mfc_putllc(volatile void* ls, uint64_t ea, unsigned int tid, unsigned int rid) {
  spu_mfcdma64(ls, mfc_ea2h(ea), mfc_ea2l(ea), 128, 0, MFC_CMD_WORD(tid, rid, MFC_PUTLLC_CMD));
}
SC_C_INLINE void mfc_putlluc(volatile void* ls, uint64_t ea, unsigned int tid, unsigned int rid) {
  spu_mfcdma64(ls, mfc_ea2h(ea), mfc_ea2l(ea), 128, 0, MFC_CMD_WORD(tid, rid, MFC_PUTLLUC_CMD));
}
SC_C_INLINE void mfc_putqlluc(volatile void* ls, uint64_t ea, unsigned int tag, unsigned int tid,
                              unsigned int rid) {
  spu_mfcdma64(ls, mfc_ea2h(ea), mfc_ea2l(ea), 128, tag, MFC_CMD_WORD(tid, rid, MFC_PUTQLLUC_CMD));
}

// ---- signals, order, hints to the data cache

#define SC_C_SIGNAL(name, opcode)                                                           \
  SC_C_INLINE void name(volatile void* ls, uint64_t ea, unsigned int tag, unsigned int tid, \
                        unsigned int rid) {                                                 \
    spu_mfcdma64(ls, mfc_ea2h(ea), mfc_ea2l(ea), 4, tag, MFC_CMD_WORD(tid, rid, opcode));   \
  }
SC_C_SIGNAL(mfc_sndsig, MFC_SNDSIG_CMD)
SC_C_SIGNAL(mfc_sndsigb, MFC_SNDSIGB_CMD)
SC_C_SIGNAL(mfc_sndsigf, MFC_SNDSIGF_CMD)
#undef SC_C_SIGNAL

SC_C_INLINE void mfc_barrier(unsigned int tag) {
  spu_mfcdma32((volatile void*)0, 0, 0, tag, MFC_BARRIER_CMD);
}
SC_C_INLINE void mfc_eieio(unsigned int tag, unsigned int tid, unsigned int rid) {
  spu_mfcdma32((volatile void*)0, 0, 0, tag, MFC_CMD_WORD(tid, rid, MFC_EIEIO_CMD));
}
SC_C_INLINE void mfc_sync(unsigned int tag) { spu_mfcdma32((volatile void*)0, 0, 0, tag, MFC_SYNC_CMD); }

#define SC_C_CACHE_HINT(name, opcode)                                                              \
  SC_C_INLINE void name(uint64_t ea, unsigned int size, unsigned int tag, unsigned int tid,        \
                        unsigned int rid) {                                                        \
    spu_mfcdma64((void*)0, mfc_ea2h(ea), mfc_ea2l(ea), size, tag, MFC_CMD_WORD(tid, rid, opcode)); \
  }
SC_C_CACHE_HINT(mfc_sdcrt, MFC_SDCRT_CMD)
SC_C_CACHE_HINT(mfc_sdcrtst, MFC_SDCRTST_CMD)
SC_C_CACHE_HINT(mfc_sdcrz, MFC_SDCRZ_CMD)
SC_C_CACHE_HINT(mfc_sdcrst, MFC_SDCRST_CMD)
SC_C_CACHE_HINT(mfc_sdcrf, MFC_SDCRF_CMD)
#undef SC_C_CACHE_HINT

// ---- the queue and tag groups

// Free slots of the queue, 0..16.
SC_C_INLINE unsigned int mfc_stat_cmd_queue(void) { return spu_readchcnt(MFC_Cmd); }
// Which tag groups the reads below are about, a bit each.
SC_C_INLINE void mfc_write_tag_mask(unsigned int mask) { spu_writech(MFC_WrTagMask, mask); }
SC_C_INLINE unsigned int mfc_read_tag_mask(void) { return spu_readch(MFC_RdTagMask); }
SC_C_INLINE void mfc_write_tag_update(unsigned int condition) { spu_writech(MFC_WrTagUpdate, condition); }
SC_C_INLINE void mfc_write_tag_update_immediate(void) { mfc_write_tag_update(MFC_TAG_UPDATE_IMMEDIATE); }
SC_C_INLINE void mfc_write_tag_update_any(void) { mfc_write_tag_update(MFC_TAG_UPDATE_ANY); }
SC_C_INLINE void mfc_write_tag_update_all(void) { mfc_write_tag_update(MFC_TAG_UPDATE_ALL); }
SC_C_INLINE unsigned int mfc_stat_tag_update(void) { return spu_readchcnt(MFC_WrTagUpdate); }
// Blocks until the condition written last holds; returns the complete tag groups of the mask.
SC_C_INLINE unsigned int mfc_read_tag_status(void) { return spu_readch(MFC_RdTagStat); }
SC_C_INLINE unsigned int mfc_read_tag_status_immediate(void) { return spu_mfcstat(MFC_TAG_UPDATE_IMMEDIATE); }
// Blocks until a tag group of the mask is complete.
SC_C_INLINE unsigned int mfc_read_tag_status_any(void) { return spu_mfcstat(MFC_TAG_UPDATE_ANY); }
// Blocks until all tag groups of the mask are complete.
SC_C_INLINE unsigned int mfc_read_tag_status_all(void) { return spu_mfcstat(MFC_TAG_UPDATE_ALL); }
SC_C_INLINE unsigned int mfc_stat_tag_status(void) { return spu_readchcnt(MFC_RdTagStat); }

SC_C_INLINE unsigned int mfc_read_list_stall_status(void) { return spu_readch(MFC_RdListStallStat); }
SC_C_INLINE unsigned int mfc_stat_list_stall_status(void) { return spu_readchcnt(MFC_RdListStallStat); }
SC_C_INLINE void mfc_write_list_stall_ack(unsigned int tag) { spu_writech(MFC_WrListStallAck, tag); }
SC_C_INLINE unsigned int mfc_read_atomic_status(void) { return spu_readch(MFC_RdAtomicStat); }
SC_C_INLINE unsigned int mfc_stat_atomic_status(void) { return spu_readchcnt(MFC_RdAtomicStat); }
SC_C_INLINE void mfc_write_multi_src_sync_request(void) { spu_writech(MFC_WrMSSyncReq, 0); }
SC_C_INLINE unsigned int mfc_stat_multi_src_sync_request(void) { return spu_readchcnt(MFC_WrMSSyncReq); }

// ---- signals, mailboxes, decrementer, events

SC_C_INLINE unsigned int spu_read_signal1(void) { return spu_readch(SPU_RdSigNotify1); }
SC_C_INLINE unsigned int spu_stat_signal1(void) { return spu_readchcnt(SPU_RdSigNotify1); }
SC_C_INLINE unsigned int spu_read_signal2(void) { return spu_readch(SPU_RdSigNotify2); }
SC_C_INLINE unsigned int spu_stat_signal2(void) { return spu_readchcnt(SPU_RdSigNotify2); }
SC_C_INLINE unsigned int spu_read_in_mbox(void) { return spu_readch(SPU_RdInMbox); }
SC_C_INLINE unsigned int spu_stat_in_mbox(void) { return spu_readchcnt(SPU_RdInMbox); }
SC_C_INLINE void spu_write_out_mbox(unsigned int value) { spu_writech(SPU_WrOutMbox, value); }
SC_C_INLINE unsigned int spu_stat_out_mbox(void) { return spu_readchcnt(SPU_WrOutMbox); }
SC_C_INLINE void spu_write_out_intr_mbox(unsigned int value) { spu_writech(SPU_WrOutIntrMbox, value); }
SC_C_INLINE unsigned int spu_stat_out_intr_mbox(void) { return spu_readchcnt(SPU_WrOutIntrMbox); }
SC_C_INLINE unsigned int spu_read_decrementer(void) { return spu_readch(SPU_RdDec); }
SC_C_INLINE void spu_write_decrementer(unsigned int ticks) { spu_writech(SPU_WrDec, ticks); }
SC_C_INLINE unsigned int spu_read_event_status(void) { return spu_readch(SPU_RdEventStat); }
SC_C_INLINE unsigned int spu_stat_event_status(void) { return spu_readchcnt(SPU_RdEventStat); }
SC_C_INLINE void spu_write_event_mask(unsigned int mask) { spu_writech(SPU_WrEventMask, mask); }
SC_C_INLINE void spu_write_event_ack(unsigned int events) { spu_writech(SPU_WrEventAck, events); }
SC_C_INLINE unsigned int spu_read_event_mask(void) { return spu_readch(SPU_RdEventMask); }
SC_C_INLINE unsigned int spu_read_machine_status(void) { return spu_readch(SPU_RdMachStat); }
SC_C_INLINE void spu_write_srr0(unsigned int address) { spu_writech(SPU_WrSRR0, address); }
SC_C_INLINE unsigned int spu_read_srr0(void) { return spu_readch(SPU_RdSRR0); }

// Around code that an interrupt handler must not cut into. Jobs on the host have no interrupts.
SC_C_INLINE unsigned int mfc_begin_critical_section(void) { return 0; }
SC_C_INLINE void mfc_end_critical_section(unsigned int status) { (void)status; }

/* The tag manager: hands out tag groups, so that parts of a program which do not know each other do not share one. */
unsigned int softcell_c_tag_reserve(unsigned int count);
unsigned int softcell_c_tag_release(unsigned int first, unsigned int count);
#define mfc_tag_reserve() (softcell_c_tag_reserve(1))
#define mfc_tag_release(tag) (softcell_c_tag_release((tag), 1))
#define mfc_multi_tag_reserve(count) (softcell_c_tag_reserve(count))
#define mfc_multi_tag_release(first, count) (softcell_c_tag_release((first), (count)))

#endif
