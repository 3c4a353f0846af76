/* One slice of a dot product; the sum is the exit status. */
#include <spu_intrinsics.h>
#include <spu_mfcio.h>
#include <sys/spu_thread.h>

static float a[256] __attribute__((aligned(128))), b[256] __attribute__((aligned(128)));

int main(uint64_t first, uint64_t second, uint64_t slice, uint64_t slices) {
  vec_float4 sum = spu_splats(0.0f);
  unsigned i;
  mfc_get(a, first + slice * sizeof a, sizeof a, 4, 0, 0);
  mfc_get(b, second + slice * sizeof b, sizeof b, 4, 0, 0);
  mfc_write_tag_mask(1 << 4);
  mfc_read_tag_status_all();
  for (i = 0; i < 256; i += 4) sum = spu_madd(*(vec_float4 *)&a[i], *(vec_float4 *)&b[i], sum);
  spu_thread_exit((int)(spu_extract(sum, 0) + spu_extract(sum, 1) + spu_extract(sum, 2) + spu_extract(sum, 3)) + (slices == 6 ? 0 : 1000));
  return 0;
}
