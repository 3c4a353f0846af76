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

}  // namespace softcell::spu
