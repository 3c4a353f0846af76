// Gets two halves of the line at argp by a list, the second half first, whose address it gives as a number, as the Cell's tutorial does:
// to spu_mfcdma64 (envp 0) or to the channels (envp 1). Puts them over the line.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static unsigned int words[32];
alignas(8) static mfc_list_element_t list[2];

int main(uint64_t, uint64_t argp, uint64_t envp) {
  constexpr unsigned int kTag = 3;
  list[0].size = list[1].size = 64;
  list[0].eal = mfc_ea2l(argp) + 64;
  list[1].eal = mfc_ea2l(argp);
  const auto list_number = static_cast<unsigned int>(reinterpret_cast<uintptr_t>(list));
  if (envp == 0) {
    spu_mfcdma64(words, mfc_ea2h(argp), list_number, sizeof list, kTag, MFC_GETL_CMD);
  } else {
    spu_writech(MFC_LSA, static_cast<unsigned int>(reinterpret_cast<uintptr_t>(words)));
    spu_writech(MFC_EAH, mfc_ea2h(argp));
    spu_writech(MFC_EAL, list_number);
    spu_writech(MFC_Size, sizeof list);
    spu_writech(MFC_TagID, kTag);
    spu_writech(MFC_Cmd, MFC_GETL_CMD);
  }
  mfc_write_tag_mask(1u << kTag);
  mfc_read_tag_status_all();
  mfc_put(words, argp, 128, kTag, 0, 0);
  mfc_read_tag_status_all();
  return 0;
}
