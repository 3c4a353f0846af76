#pragma once
// Four 2-vectors at a time, one component to a register.

#include <spu_intrinsics.h>

namespace softcell::spu {

struct Vector2x4 {
  vec_float4 x, y;
};

/// a x b = ax by - ay bx.
inline vec_float4 cross(const Vector2x4& a, const Vector2x4& b) {
  return spu_msub(a.x, b.y, spu_mul(a.y, b.x));
}

inline vec_float4 dot(const Vector2x4& a, const Vector2x4& b) {
  return spu_madd(a.x, b.x, spu_mul(a.y, b.y));
}

inline Vector2x4 scale(const Vector2x4& a, vec_float4 s) { return {spu_mul(a.x, s), spu_mul(a.y, s)}; }

inline Vector2x4 sum(const Vector2x4& a, const Vector2x4& b) {
  return {spu_add(a.x, b.x), spu_add(a.y, b.y)};
}

/// a - b.
inline Vector2x4 difference(const Vector2x4& a, const Vector2x4& b) {
  return {spu_sub(a.x, b.x), spu_sub(a.y, b.y)};
}

/// a * s + b, each component fused.
inline Vector2x4 scale_add(const Vector2x4& a, vec_float4 s, const Vector2x4& b) {
  return {spu_madd(a.x, s, b.x), spu_madd(a.y, s, b.y)};
}

}  // namespace softcell::spu
