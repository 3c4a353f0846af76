#pragma once
// PSL1GHT's names of DMA commands.  [PSL1GHT, dma/spu_dma.h] documented
//
// PSL1GHT's functions halt an SPU that asks for what the MFC refuses. softcell's MFC says which rule the command breaks.

#include <spu_intrinsics.h>
#include <spu_mfcio.h>
#include <stdint.h>
#include <sys/cdefs.h>

#define MAX_DMA_BLOCK_SIZE 16384

/// The address within the quadword `ls` that a transfer of less than 16 bytes needs.
#define spu_dma_ea2ls(ea, ls) ((void*)((uintptr_t)(ls) + ((uint32_t)(ea)&15)))

#ifdef NO_SPU_DMA_ASSERT
#define spu_dma_assert(...) ((void)0)
#else
#define spu_dma_assert(...) SOFTCELL_FIRST_IS_TRUE(__VA_ARGS__, 0)
#define SOFTCELL_FIRST_IS_TRUE(condition, ...) spu_hcmpeq((condition) ? 1 : 0, 0)
#endif

#define SOFTCELL_DMA_INLINE static __inline__ __attribute__((__always_inline__, __unused__))

__BEGIN_DECLS
typedef mfc_list_element_t spu_dma_list_element;

/// Issues the command word `cmd`, and waits for its tag.
void spu_dma_and_wait(void* ls, uint64_t ea, uint32_t size, uint32_t tag, uint32_t cmd);
/// Transfers of any size, in as many commands as are needed.
void spu_dma_large_cmd(uintptr_t ls, uint64_t ea, uint32_t size, uint32_t tag, uint32_t cmd);

// spu_dma_put moves multiples of 16 bytes, spu_dma_small_put 1, 2, 4 or 8, spu_dma_large_put any number, spu_dma_list_put what a list says.
#define SOFTCELL_DMA_COMMAND(direction, constant, opcode)                                                   \
  SOFTCELL_DMA_INLINE void spu_dma_##direction(constant void* ls, uint64_t ea, uint32_t size, uint32_t tag, \
                                               uint32_t tid, uint32_t rid) {                                \
    mfc_##direction((volatile void*)(uintptr_t)ls, ea, size, tag, tid, rid);                                \
  }                                                                                                         \
  SOFTCELL_DMA_INLINE void spu_dma_small_##direction(constant void* ls, uint64_t ea, uint32_t size,         \
                                                     uint32_t tag, uint32_t tid, uint32_t rid) {            \
    mfc_##direction((volatile void*)(uintptr_t)ls, ea, size, tag, tid, rid);                                \
  }                                                                                                         \
  SOFTCELL_DMA_INLINE void spu_dma_large_##direction(constant void* ls, uint64_t ea, uint32_t size,         \
                                                     uint32_t tag, uint32_t tid, uint32_t rid) {            \
    spu_dma_large_cmd((uintptr_t)ls, ea, size, tag, MFC_CMD_WORD(tid, rid, opcode));                        \
  }
SOFTCELL_DMA_COMMAND(put, const, MFC_PUT_CMD)
SOFTCELL_DMA_COMMAND(putb, const, MFC_PUTB_CMD)
SOFTCELL_DMA_COMMAND(putf, const, MFC_PUTF_CMD)
SOFTCELL_DMA_COMMAND(get, , MFC_GET_CMD)
SOFTCELL_DMA_COMMAND(getb, , MFC_GETB_CMD)
SOFTCELL_DMA_COMMAND(getf, , MFC_GETF_CMD)

#define SOFTCELL_DMA_LIST(name, constant, command)                                                      \
  SOFTCELL_DMA_INLINE void spu_dma_list_##name(constant void* ls, uint64_t ea,                          \
                                               const spu_dma_list_element* list, uint32_t lsize,        \
                                               uint32_t tag, uint32_t tid, uint32_t rid) {              \
    command((volatile void*)(uintptr_t)ls, ea, (spu_dma_list_element*)(uintptr_t)list, lsize, tag, tid, \
            rid);                                                                                       \
  }
SOFTCELL_DMA_LIST(put, const, mfc_putl)
SOFTCELL_DMA_LIST(putb, const, mfc_putlb)
SOFTCELL_DMA_LIST(putf, const, mfc_putlf)
SOFTCELL_DMA_LIST(get, , mfc_getl)
SOFTCELL_DMA_LIST(getb, , mfc_getlb)
SOFTCELL_DMA_LIST(getf, , mfc_getlf)

SOFTCELL_DMA_INLINE void spu_dma_getllar(void* ls, uint64_t ea, uint32_t tid, uint32_t rid) {
  mfc_getllar(ls, ea, tid, rid);
}
SOFTCELL_DMA_INLINE void spu_dma_putllc(const void* ls, uint64_t ea, uint32_t tid, uint32_t rid) {
  mfc_putllc((volatile void*)(uintptr_t)ls, ea, tid, rid);
}
SOFTCELL_DMA_INLINE void spu_dma_putlluc(const void* ls, uint64_t ea, uint32_t tid, uint32_t rid) {
  mfc_putlluc((volatile void*)(uintptr_t)ls, ea, tid, rid);
}
SOFTCELL_DMA_INLINE void spu_dma_putqlluc(const void* ls, uint64_t ea, uint32_t tag, uint32_t tid,
                                          uint32_t rid) {
  mfc_putqlluc((volatile void*)(uintptr_t)ls, ea, tag, tid, rid);
}

// One number, at an address that is a multiple of its size. They wait.
#define SOFTCELL_DMA_NUMBER(bits)                                                                            \
  SOFTCELL_DMA_INLINE void spu_dma_put_uint##bits(uint##bits##_t value, uint64_t ea, uint32_t tag,           \
                                                  uint32_t tid, uint32_t rid) {                              \
    uint##bits##_t room[128 / bits] __attribute__((__aligned__(16)));                                        \
    room[((uint32_t)ea & 15) / sizeof value] = value;                                                        \
    spu_dma_and_wait(spu_dma_ea2ls(ea, room), ea, sizeof value, tag, MFC_CMD_WORD(tid, rid, MFC_PUT_CMD));   \
  }                                                                                                          \
  SOFTCELL_DMA_INLINE uint##bits##_t spu_dma_get_uint##bits(uint64_t ea, uint32_t tag, uint32_t tid,         \
                                                            uint32_t rid) {                                  \
    uint##bits##_t room[128 / bits] __attribute__((__aligned__(16)));                                        \
    spu_dma_and_wait(spu_dma_ea2ls(ea, room), ea, sizeof room[0], tag, MFC_CMD_WORD(tid, rid, MFC_GET_CMD)); \
    return room[((uint32_t)ea & 15) / sizeof room[0]];                                                       \
  }
SOFTCELL_DMA_NUMBER(8)
SOFTCELL_DMA_NUMBER(16)
SOFTCELL_DMA_NUMBER(32)
SOFTCELL_DMA_NUMBER(64)

/// Takes back a request for the tag status that nobody has read.
SOFTCELL_DMA_INLINE void spu_dma_cancel_tag_status_update(void) {
  mfc_write_tag_update_immediate();
  while (mfc_stat_tag_update() == 0) {
  }
  mfc_read_tag_status();
}
SOFTCELL_DMA_INLINE uint32_t spu_dma_wait_tag_status_immediate(uint32_t tagmask) {
  mfc_write_tag_mask(tagmask);
  return mfc_read_tag_status_immediate();
}
/// Its name is PSL1GHT's.
SOFTCELL_DMA_INLINE uint32_t spu_cma_wait_tag_status_any(uint32_t tagmask) {
  mfc_write_tag_mask(tagmask);
  return mfc_read_tag_status_any();
}
SOFTCELL_DMA_INLINE uint32_t spu_dma_wait_tag_status_all(uint32_t tagmask) {
  mfc_write_tag_mask(tagmask);
  return mfc_read_tag_status_all();
}
SOFTCELL_DMA_INLINE uint32_t spu_dma_cancel_and_wait_tag_status_any(uint32_t tagmask) {
  spu_dma_cancel_tag_status_update();
  return spu_cma_wait_tag_status_any(tagmask);
}
SOFTCELL_DMA_INLINE uint32_t spu_dma_cancel_and_wait_tag_status_all(uint32_t tagmask) {
  spu_dma_cancel_tag_status_update();
  return spu_dma_wait_tag_status_all(tagmask);
}
__END_DECLS

#define spu_dma_wait_atomic_status() mfc_read_atomic_status()
