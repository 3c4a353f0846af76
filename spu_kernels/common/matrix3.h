#pragma once
// Four 3x3 matrices and four quaternions at a time, one component to a register.

#include <spu_intrinsics.h>

#include "common/reciprocal.h"
#include "common/vector3.h"

namespace softcell::spu {

/// By rows.
struct Matrix3x4 {
  Vector3x4 x, y, z;
};

/// A rotation by quaternion: cos(angle / 2) in w.
struct Quaternion4 {
  vec_float4 x, y, z, w;
};

inline vec_float4 dot(const Quaternion4& a, const Quaternion4& b) {
  return spu_madd(a.x, b.x, spu_madd(a.y, b.y, spu_madd(a.z, b.z, spu_mul(a.w, b.w))));
}

/// The rotation matrices of quaternions whose length is one to within 1e-5. The factor 2 (2 - |q|^2), which is 2 / |q|^2 to within 1e-10,
/// corrects the length, so that the matrix is orthogonal to some roundings.
inline Matrix3x4 matrix_of(const Quaternion4& q) {
  const vec_float4 one = spu_splats(1.0f);
  const vec_float4 two = spu_madd(spu_splats(-2.0f), dot(q, q), spu_splats(4.0f));
  const vec_float4 tx = spu_mul(two, q.x), ty = spu_mul(two, q.y), tz = spu_mul(two, q.z);
  const vec_float4 wx = spu_mul(tx, q.w), wy = spu_mul(ty, q.w), wz = spu_mul(tz, q.w);
  return {{spu_nmsub(ty, q.y, spu_nmsub(tz, q.z, one)), spu_msub(tx, q.y, wz), spu_madd(tx, q.z, wy)},
          {spu_madd(tx, q.y, wz), spu_nmsub(tx, q.x, spu_nmsub(tz, q.z, one)), spu_msub(ty, q.z, wx)},
          {spu_msub(tx, q.z, wy), spu_madd(ty, q.z, wx), spu_nmsub(tx, q.x, spu_nmsub(ty, q.y, one))}};
}

/// normalize(q (1, half)): a further rotation by about 2 |half|, about `half` in the body's frame. The length is one to within 5e-6.
inline Quaternion4 turn(const Quaternion4& q, const Vector3x4& half) {
  const Quaternion4 t = {spu_madd(q.w, half.x, spu_madd(q.y, half.z, spu_nmsub(q.z, half.y, q.x))),
                         spu_madd(q.w, half.y, spu_madd(q.z, half.x, spu_nmsub(q.x, half.z, q.y))),
                         spu_madd(q.w, half.z, spu_madd(q.x, half.y, spu_nmsub(q.y, half.x, q.z))),
                         spu_nmsub(q.x, half.x, spu_nmsub(q.y, half.y, spu_nmsub(q.z, half.z, q.w)))};
  const vec_float4 scale = reciprocal_sqrt(dot(t, t));
  return {spu_mul(t.x, scale), spu_mul(t.y, scale), spu_mul(t.z, scale), spu_mul(t.w, scale)};
}

}  // namespace softcell::spu
