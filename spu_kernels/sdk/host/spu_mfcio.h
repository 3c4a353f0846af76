#pragma once
// DMA and channels by name, as the Cell SDK's header of this name declares them. [LEXT; CBEA, MFC commands] documented

#include "spu_intrinsics.h"

// ---- channel numbers

#define SPU_RdEventStat 0
#define SPU_WrEventMask 1
#define SPU_WrEventAck 2
#define SPU_RdSigNotify1 3
#define SPU_RdSigNotify2 4
#define SPU_WrDec 7
#define SPU_RdDec 8
#define MFC_WrMSSyncReq 9
#define SPU_RdEventMask 11
#define MFC_RdTagMask 12
#define SPU_RdMachStat 13
#define SPU_WrSRR0 14
#define SPU_RdSRR0 15
#define MFC_LSA 16
#define MFC_EAH 17
#define MFC_EAL 18
#define MFC_Size 19
#define MFC_TagID 20
#define MFC_Cmd 21
#define MFC_WrTagMask 22
#define MFC_WrTagUpdate 23
#define MFC_RdTagStat 24
#define MFC_RdListStallStat 25
#define MFC_WrListStallAck 26
#define MFC_RdAtomicStat 27
#define SPU_WrOutMbox 28
#define SPU_RdInMbox 29
#define SPU_WrOutIntrMbox 30

// ---- commands

#define MFC_PUT_CMD 0x20
#define MFC_PUTB_CMD 0x21
#define MFC_PUTF_CMD 0x22
#define MFC_GET_CMD 0x40
#define MFC_GETB_CMD 0x41
#define MFC_GETF_CMD 0x42

#define MFC_TAG_UPDATE_IMMEDIATE 0
#define MFC_TAG_UPDATE_ANY 1
#define MFC_TAG_UPDATE_ALL 2

#define MFC_MIN_DMA_SIZE 1
#define MFC_MAX_DMA_SIZE 16384

// ---- effective addresses

inline unsigned int mfc_ea2h(uint64_t ea) { return static_cast<unsigned int>(ea >> 32); }
inline unsigned int mfc_ea2l(uint64_t ea) { return static_cast<unsigned int>(ea); }
inline uint64_t mfc_hl2ea(unsigned int high, unsigned int low) { return static_cast<uint64_t>(high) << 32 | low; }
inline uint64_t mfc_ceil128(uint64_t value) { return (value + 127) & ~static_cast<uint64_t>(127); }

namespace softcell_sdk {
inline void command(const volatile void* ls, uint64_t ea, uint32_t size, uint32_t tag, uint32_t tid, uint32_t rid, uint32_t opcode) {
  Environment& e = environment();
  e.mfc_lsa = local_store_address(ls);
  e.mfc_eah = mfc_ea2h(ea);
  e.mfc_eal = mfc_ea2l(ea);
  e.mfc_size = size;
  e.mfc_tag = tag;
  call_gate(kWrite, MFC_Cmd, tid << 24 | rid << 16 | opcode);
}
}  // namespace softcell_sdk

// ---- DMA: ls in local store, ea in main storage, size in bytes, tag 0..31; tid and rid are cache hints, 0 is always right

#define SC_SDK_COMMAND(name, opcode)                                                                                                  \
  inline void name(volatile void* ls, uint64_t ea, uint32_t size, uint32_t tag, uint32_t tid, uint32_t rid) {                         \
    softcell_sdk::command(ls, ea, size, tag, tid, rid, opcode);                                                                       \
  }
SC_SDK_COMMAND(mfc_get, MFC_GET_CMD)
SC_SDK_COMMAND(mfc_getb, MFC_GETB_CMD)
SC_SDK_COMMAND(mfc_getf, MFC_GETF_CMD)
SC_SDK_COMMAND(mfc_put, MFC_PUT_CMD)
SC_SDK_COMMAND(mfc_putb, MFC_PUTB_CMD)
SC_SDK_COMMAND(mfc_putf, MFC_PUTF_CMD)
#undef SC_SDK_COMMAND

inline unsigned int mfc_stat_cmd_queue() { return spu_readchcnt(MFC_Cmd); }

// ---- tag groups

inline void mfc_write_tag_mask(unsigned int mask) { spu_writech(MFC_WrTagMask, mask); }
inline unsigned int mfc_read_tag_mask() { return spu_readch(MFC_RdTagMask); }
inline void mfc_write_tag_update(unsigned int condition) { spu_writech(MFC_WrTagUpdate, condition); }
inline void mfc_write_tag_update_immediate() { mfc_write_tag_update(MFC_TAG_UPDATE_IMMEDIATE); }
inline void mfc_write_tag_update_any() { mfc_write_tag_update(MFC_TAG_UPDATE_ANY); }
inline void mfc_write_tag_update_all() { mfc_write_tag_update(MFC_TAG_UPDATE_ALL); }
inline unsigned int mfc_stat_tag_update() { return spu_readchcnt(MFC_WrTagUpdate); }
inline unsigned int mfc_read_tag_status() { return spu_readch(MFC_RdTagStat); }
inline unsigned int mfc_read_tag_status_immediate() {
  mfc_write_tag_update_immediate();
  return mfc_read_tag_status();
}
inline unsigned int mfc_read_tag_status_any() {
  mfc_write_tag_update_any();
  return mfc_read_tag_status();
}
inline unsigned int mfc_read_tag_status_all() {
  mfc_write_tag_update_all();
  return mfc_read_tag_status();
}
inline unsigned int mfc_stat_tag_status() { return spu_readchcnt(MFC_RdTagStat); }
