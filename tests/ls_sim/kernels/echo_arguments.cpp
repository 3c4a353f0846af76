// Correct: fetches a line, adds 1 to each word, puts it back. Ends with the low byte of envp.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

alignas(128) static vec_uint4 line[8];

int main(uint64_t, uint64_t argp, uint64_t envp) {
  mfc_get(line, argp, sizeof line, 5, 0, 0);
  mfc_write_tag_mask(1u << 5);
  mfc_read_tag_status_all();
  for (int i = 0; i < 8; ++i) line[i] = spu_add(line[i], spu_splats(1u));
  mfc_put(line, argp, sizeof line, 5, 0, 0);
  mfc_read_tag_status_all();
  return static_cast<int>(envp);
}
