// argp: { ea of input, ea of output, floats in blocks of 1024, factor }. Two buffers: while one is computed, the other
// is fetched.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

struct Job {
  unsigned long long in, out;
  unsigned int blocks;
  float factor;
  unsigned int padding[2];
};
static constexpr unsigned int kFloats = 1024, kBytes = kFloats * 4;

alignas(128) static Job job;
alignas(128) static vec_float4 buffer[2][kFloats / 4];

int main(uint64_t, uint64_t argp, uint64_t) {
  mfc_get(&job, argp, sizeof job, 31, 0, 0);
  mfc_write_tag_mask(1u << 31);
  mfc_read_tag_status_all();
  mfc_get(buffer[0], job.in, kBytes, 0, 0, 0);
  for (unsigned int block = 0; block < job.blocks; ++block) {
    const unsigned int now = block & 1, next = now ^ 1;
    if (block + 1 < job.blocks) mfc_getb(buffer[next], job.in + (block + 1) * kBytes, kBytes, next, 0, 0);
    mfc_write_tag_mask(1u << now);
    mfc_read_tag_status_all();
    for (unsigned int i = 0; i < kFloats / 4; ++i)
      buffer[now][i] = spu_mul(buffer[now][i], spu_splats(job.factor));
    mfc_put(buffer[now], job.out + block * kBytes, kBytes, now, 0, 0);
  }
  mfc_write_tag_mask(3);
  mfc_read_tag_status_all();
  return 0;
}
