#pragma once
// What spu_mfcio.h names by macros, for host and check alike: sizes, opcodes, events, status bits.
// [LEXT, MFC input and output; CBEA, MFC commands] documented

// ---- sizes, in bytes; a list element takes 8

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

// ---- opcodes: what can be added to put, get and sndsig, and the sums that exist

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
#define MFC_SDCRT_CMD 0x80
#define MFC_SDCRTST_CMD 0x81
#define MFC_SDCRZ_CMD 0x89
#define MFC_SDCRST_CMD 0x8D
#define MFC_SDCRF_CMD 0x8F
#define MFC_SNDSIG_CMD 0xA0
#define MFC_SNDSIGB_CMD 0xA1
#define MFC_SNDSIGF_CMD 0xA2
#define MFC_PUTLLUC_CMD 0xB0
#define MFC_PUTLLC_CMD 0xB4
#define MFC_PUTQLLUC_CMD 0xB8
#define MFC_BARRIER_CMD 0xC0
#define MFC_EIEIO_CMD 0xC8
#define MFC_SYNC_CMD 0xCC
#define MFC_GETLLAR_CMD 0xD0

/// The word for channel MFC_Cmd: transfer class and replacement class (hints for caches, 0 is always right),
/// opcode.
#define MFC_CMD_WORD(tid, rid, opcode) (((tid) << 24) | ((rid) << 16) | (opcode))

// ---- MFC_WrTagUpdate: when a tag status is given

#define MFC_TAG_UPDATE_IMMEDIATE 0
#define MFC_TAG_UPDATE_ANY 1
#define MFC_TAG_UPDATE_ALL 2

// ---- MFC_RdAtomicStat; the bit of putllc says that it has *not* stored

#define MFC_PUTLLC_STATUS 0x1
#define MFC_PUTLLUC_STATUS 0x2
#define MFC_GETLLAR_STATUS 0x4

// ---- events: bits of SPU_RdEventStat, SPU_WrEventMask and SPU_WrEventAck

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

// ---- what the tag manager answers

#define MFC_TAG_VALID 0x00000000u
#define MFC_TAG_INVALID 0xFFFFFFFFu

/// Rounds up to a multiple of 128.
#define mfc_ceil128(value) (((value) + 127) & ~127)
