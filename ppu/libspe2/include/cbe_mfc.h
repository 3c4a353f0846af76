#ifndef SOFTCELL_CBE_MFC_H
#define SOFTCELL_CBE_MFC_H
/* Names of the MFC's commands, sizes and answers, for MFC_ClassID_CMD and other registers of the problem state. On the SPU side
 * <spu_mfcio.h> has them. [SDK for Multicore Acceleration, cbe_mfc.h; CBEA, MFC commands] documented */

/* Sizes, in bytes; a list element takes 8. */
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

/* What can be added to put and get. */
#define MFC_BARRIER_ENABLE 0x01
#define MFC_FENCE_ENABLE 0x02
#define MFC_LIST_ENABLE 0x04
#define MFC_START_ENABLE 0x08
#define MFC_RESULT_ENABLE 0x10

/* Commands; those with an S start the SPU, and are for the PPU side only. */
#define MFC_PUT_CMD 0x20
#define MFC_PUTB_CMD 0x21
#define MFC_PUTF_CMD 0x22
#define MFC_PUTL_CMD 0x24
#define MFC_PUTLB_CMD 0x25
#define MFC_PUTLF_CMD 0x26
#define MFC_PUTS_CMD 0x28
#define MFC_PUTBS_CMD 0x29
#define MFC_PUTFS_CMD 0x2A
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
#define MFC_GETS_CMD 0x48
#define MFC_GETBS_CMD 0x49
#define MFC_GETFS_CMD 0x4A
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

#define MFC_CMD_WORD(tid, rid, opcode) (((tid) << 24) | ((rid) << 16) | (opcode))

/* Prxy_QueryType. */
#define MFC_TAG_UPDATE_IMMEDIATE 0
#define MFC_TAG_UPDATE_ANY 1
#define MFC_TAG_UPDATE_ALL 2

/* MFC_CMDStatus, of which the lowest two bits count. */
#define MFC_PPU_DMA_CMD_ENQUEUE_SUCCESSFUL 0x00
#define MFC_PPU_DMA_CMD_SEQUENCE_ERROR 0x01
#define MFC_PPU_DMA_QUEUE_FULL 0x02

#endif
