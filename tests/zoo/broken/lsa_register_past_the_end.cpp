// rule: lsa-out-of-range
// names: get
// twin: legal/last_bytes_of_local_store
// Writes the channels itself, with an address behind the local store.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

int main(uint64_t, uint64_t argp, uint64_t) {
  spu_writech(MFC_LSA, 0x40000u);
  spu_writech(MFC_EAH, mfc_ea2h(argp));
  spu_writech(MFC_EAL, mfc_ea2l(argp));
  spu_writech(MFC_Size, 16u);
  spu_writech(MFC_TagID, 0u);
  spu_writech(MFC_Cmd, static_cast<unsigned int>(MFC_GET_CMD));  // BROKEN
  mfc_write_tag_mask(1u << 0);
  mfc_read_tag_status_all();
  return 0;
}
