// Rows of C = A B for matrices of 32 x 32 floats; argp: { ea of A, B, C, first row, rows }.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

struct Job {
  unsigned long long a, b, c;
  unsigned int first, rows;
};
static constexpr unsigned int kSize = 32, kRow = kSize * 4;

alignas(128) static Job job;
alignas(128) static float a[kSize][kSize];
alignas(128) static vec_float4 b[kSize][kSize / 4];
alignas(128) static vec_float4 c[kSize][kSize / 4];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_write_tag_mask(1u << 4);
  mfc_get(&job, argp, sizeof job, 4, 0, 0);
  mfc_read_tag_status_all();
  mfc_get(a, job.a + job.first * kRow, job.rows * kRow, 4, 0, 0);
  mfc_get(b, job.b, kSize * kRow, 4, 0, 0);
  mfc_read_tag_status_all();
  for (unsigned int row = 0; row < job.rows; ++row) {
    for (unsigned int column = 0; column < kSize / 4; ++column) {
      vec_float4 sum = spu_splats(0.0f);
      for (unsigned int k = 0; k < kSize; ++k) sum = spu_madd(spu_splats(a[row][k]), b[k][column], sum);
      c[row][column] = sum;
    }
  }
  mfc_put(c, job.c + job.first * kRow, job.rows * kRow, 4, 0, 0);
  mfc_read_tag_status_all();
  return 0;
}
