// Gravity of all bodies on a range of them, in C++.
#include <spu_intrinsics.h>
#include <spu_mfcio.h>

extern "C" {
#include "nbody.h"
}

namespace {
job_t job __attribute__((aligned(16)));
body_t bodies[BODIES] __attribute__((aligned(128)));
vec_t forces[BODIES] __attribute__((aligned(128)));

class TagGroup {
 public:
  explicit TagGroup(unsigned int tag) : tag_(tag) {}
  ~TagGroup() {
    mfc_write_tag_mask(1u << tag_);
    mfc_read_tag_status_all();
  }
  void get(volatile void* ls, unsigned long long ea, unsigned int size) { mfc_get(ls, ea, size, tag_, 0, 0); }
  void put(volatile void* ls, unsigned long long ea, unsigned int size) { mfc_put(ls, ea, size, tag_, 0, 0); }

 private:
  unsigned int tag_;
};

template <class T>
T rsqrt(T x) {  // estimate and one step of Newton's
  T y = spu_rsqrte(x);
  const T half = spu_mul(x, spu_splats(0.5f));
  return spu_mul(y, spu_nmsub(spu_mul(half, y), y, spu_splats(1.5f)));
}
}  // namespace

int main(unsigned long long, unsigned long long argp, unsigned long long) {
  {
    TagGroup in(0);
    in.get(&job, argp, sizeof job);
  }
  {
    TagGroup in(1);
    in.get(bodies, job.bodies, sizeof bodies);
  }
  for (unsigned int i = job.first; i < job.first + job.count; i++) {
    vec_float4 p = *reinterpret_cast<vec_float4*>(&bodies[i]);
    vec_float4 sum = spu_splats(0.0f);
    for (unsigned int j = 0; j < BODIES; j++) {
      vec_float4 q = *reinterpret_cast<vec_float4*>(&bodies[j]);
      vec_float4 d = spu_sub(q, p);
      d = spu_insert(0.0f, d, 3);
      vec_float4 sq = spu_mul(d, d);
      float r2 = spu_extract(sq, 0) + spu_extract(sq, 1) + spu_extract(sq, 2) + 0.01f;
      vec_float4 inv = rsqrt(spu_splats(r2));
      vec_float4 w = spu_mul(spu_mul(inv, inv), spu_mul(inv, spu_splats(bodies[j].mass)));
      sum = spu_madd(d, w, sum);
    }
    *reinterpret_cast<vec_float4*>(&forces[i]) = sum;
  }
  TagGroup out(2);
  out.put(&forces[job.first], job.forces + job.first * sizeof(vec_t), job.count * sizeof(vec_t));
  return 0;
}
