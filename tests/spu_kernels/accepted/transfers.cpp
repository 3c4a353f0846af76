// sdk: check host
// Gets, puts and tag groups, with the arithmetic of effective addresses.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static vec_float4 buffer[8];
alignas(128) static volatile uint32_t words[32];

int main(uint64_t spe_id, uint64_t argp, uint64_t envp) {
  static_assert(sizeof(uint64_t) == 8 && alignof(uint64_t) == 8 && sizeof(buffer) == 128, "the ABI's");
  const uint64_t ea = mfc_hl2ea(mfc_ea2h(argp), mfc_ea2l(argp)) + mfc_ceil128(sizeof buffer);
  mfc_get(buffer, ea, sizeof buffer, 3, 0, 0);
  mfc_getf(words, ea, sizeof words, 3, 0, 0);
  mfc_getb(words, ea, 128, 3, 0, 0);
  mfc_put(buffer, envp, sizeof buffer, 4, 0, 0);
  mfc_putf(&buffer[1], envp + 16, 16, 4, 0, 0);
  mfc_putb(words, envp, sizeof words, 4, 0, 0);
  mfc_write_tag_mask(1u << 3 | 1u << 4);
  const unsigned int done = mfc_read_tag_status_any();
  mfc_read_tag_status_all();
  return static_cast<int>(done & mfc_read_tag_status_immediate() & static_cast<unsigned int>(spe_id));
}
