#pragma once
// Four 3-vectors at a time, one component to a register ("structure of arrays").

#include <spu_intrinsics.h>

namespace softcell::spu {

struct Vector3x4 {
  vec_float4 x, y, z;
};

inline Vector3x4 cross(const Vector3x4& a, const Vector3x4& b) {
  return {spu_msub(a.y, b.z, spu_mul(a.z, b.y)), spu_msub(a.z, b.x, spu_mul(a.x, b.z)),
          spu_msub(a.x, b.y, spu_mul(a.y, b.x))};
}

inline vec_float4 dot(const Vector3x4& a, const Vector3x4& b) {
  return spu_madd(a.x, b.x, spu_madd(a.y, b.y, spu_mul(a.z, b.z)));
}

inline Vector3x4 scale(const Vector3x4& a, vec_float4 s) {
  return {spu_mul(a.x, s), spu_mul(a.y, s), spu_mul(a.z, s)};
}

/// a - b.
inline Vector3x4 difference(const Vector3x4& a, const Vector3x4& b) {
  return {spu_sub(a.x, b.x), spu_sub(a.y, b.y), spu_sub(a.z, b.z)};
}

/// a * s + b, each component fused.
inline Vector3x4 scale_add(const Vector3x4& a, vec_float4 s, const Vector3x4& b) {
  return {spu_madd(a.x, s, b.x), spu_madd(a.y, s, b.y), spu_madd(a.z, s, b.z)};
}

/// 1 / sqrt(x) for normal x > 0, relative error below 5e-6: enough for a vector that becomes halves.
/// Halving the exponent by an integer shift is right to 3.5 %; two Newton steps square that twice.
/// spu_rsqrte() and one step would be three instructions less on an SPU, but thirty more on a host, which has
/// to look the estimate up in a table.
inline vec_float4 reciprocal_sqrt(vec_float4 x) {
  const vec_float4 half_x = spu_mul(x, spu_splats(0.5f));
  const vec_float4 y0 = (vec_float4)spu_sub(spu_splats(0x5F375A86u), spu_rlmask((vec_uint4)x, -1));
  const vec_float4 y1 = spu_mul(y0, spu_nmsub(spu_mul(half_x, y0), y0, spu_splats(1.5f)));
  return spu_mul(y1, spu_nmsub(spu_mul(half_x, y1), y1, spu_splats(1.5f)));
}

}  // namespace softcell::spu
