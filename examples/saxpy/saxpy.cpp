// saxpy: y = a x + y over arrays in main storage, in blocks of 8 KB with two buffers for each array.
//
//   array  direction  element  alignment
//   job    in         SaxpyJob   16
//   x      in         float      16
//   y      in, out    float      16
//
//   get   [0 A][1 B]     [2 A]     [3 B]       A, B: the two buffers, each with a tag of its own
//   work       [0 A]     [1 B]     [2 A]
//   put             [0 A]     [1 B]            a buffer is filled again by a fenced get: behind its own put
//
// Budget: 40 KB, of which buffers 32 KB. Compiles unchanged with a real SPU g++ (-std=c++17).

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "saxpy_job.h"

namespace {

constexpr uint32_t kBlockFloats = 2048;

struct Buffer {
  vec_float4 x[kBlockFloats / 4];
  vec_float4 y[kBlockFloats / 4];
};

alignas(128) Buffer buffers[2];
alignas(16) SaxpyJob job;

uint32_t floats_of(uint32_t block) {
  const uint32_t left = static_cast<uint32_t>(job.count) - block * kBlockFloats;
  return left < kBlockFloats ? left : kBlockFloats;
}

uint64_t offset_of(uint32_t block) { return uint64_t{block} * kBlockFloats * sizeof(float); }

/// The buffer's number is its tag.
void fetch(uint32_t block, uint32_t tag) {
  const uint32_t bytes = floats_of(block) * sizeof(float);
  mfc_get(buffers[tag].x, job.x + offset_of(block), bytes, tag, 0, 0);
  mfc_getf(buffers[tag].y, job.y + offset_of(block), bytes, tag, 0, 0);
}

void wait(uint32_t tag) {
  mfc_write_tag_mask(1u << tag);
  mfc_read_tag_status_all();
}

void compute(Buffer& buffer, vec_float4 a, uint32_t floats) {
  for (uint32_t i = 0; i < floats / 4; ++i) buffer.y[i] = spu_madd(a, buffer.x[i], buffer.y[i]);
}

void store(uint32_t block, uint32_t tag) {
  mfc_put(buffers[tag].y, job.y + offset_of(block), floats_of(block) * sizeof(float), tag, 0, 0);
}

}  // namespace

int main(uint64_t spe, uint64_t argp, uint64_t) {
  mfc_get(&job, argp, sizeof job, 0, 0, 0);
  wait(0);
  if (job.count % 4 != 0) return kSaxpyCountNotMultipleOf4;
  if (job.spes == 0) return kSaxpyNoSpes;

  const vec_float4 a = (vec_float4)spu_splats(static_cast<uint32_t>(job.a));
  const uint32_t blocks = (static_cast<uint32_t>(job.count) + kBlockFloats - 1) / kBlockFloats;
  const uint32_t stride = static_cast<uint32_t>(job.spes);
  uint32_t tag = 0;
  if (spe < blocks) fetch(static_cast<uint32_t>(spe), tag);
  for (uint32_t block = static_cast<uint32_t>(spe); block < blocks; block += stride, tag ^= 1) {
    if (block + stride < blocks) fetch(block + stride, tag ^ 1);
    wait(tag);
    compute(buffers[tag], a, floats_of(block));
    store(block, tag);
  }
  mfc_write_tag_mask(1u << 0 | 1u << 1);
  mfc_read_tag_status_all();
  return kSaxpyDone;
}
