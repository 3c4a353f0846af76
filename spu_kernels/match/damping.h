#pragma once
// The arithmetic of region damping between the sums: the payload of a particle, the rigid motion of a region, and what becomes of the sums
// of motions.
// [Mueller et al. 2006, section 3.5, per region]
//
//   up      P = m~ v,  L0 = x × m~ v,  Q = m~ x x^T
//           rows (Px Py Pz Qxx), (Lx Ly Lz Qyy), (Qxy Qyz Qzx Qzz)
//   region  L = L0 - c × P,  C = Q - M c c^T,  I = tr(C) 1 - C,  omega = I^+ L,  b = P / M - omega × c
//   down    rows (bx by bz 0), (omega 0)
//   dv_i = 1 / |R_i|  (sum b + (sum omega) × x_i) - v_i

#include <spu_intrinsics.h>

#include "common/lane_mask.h"
#include "common/reciprocal.h"
#include "match/matching.h"

namespace softcell::spu {

/// m~ of four particles.
inline vec_float4 modified_mass(const RestMoments& rest_moment) {
  return interleave_high(interleave_high(rest_moment[0], rest_moment[2]),
                         interleave_high(rest_moment[1], rest_moment[3]));
}

/// Computes the payload of four particles. @param mass  m~
inline void twist_moments(vec_float4 mass, const Vector3x4& x, const Vector3x4& v, Slot* out) {
  const Vector3x4 momentum = scale(v, mass), moment = scale(x, mass);
  const Vector3x4 l = cross(x, momentum);
  store_row(out, 0, {momentum.x, momentum.y, momentum.z, spu_mul(moment.x, x.x)});
  store_row(out, 1, {l.x, l.y, l.z, spu_mul(moment.y, x.y)});
  store_row(out, 2,
            {spu_mul(moment.x, x.y), spu_mul(moment.y, x.z), spu_mul(moment.z, x.x), spu_mul(moment.z, x.z)});
}

/// A symmetric matrix.
struct Symmetric3x4 {
  vec_float4 xx, yy, zz, xy, yz, zx;
};

/// omega = I^+ L for I = trace(C) 1 - C. Particles on one line have neither inertia nor angular momentum about it; a small multiple of the
/// trace keeps I invertible. Particles on one point do not turn.
/// @param least  traces up to this are noise
inline Vector3x4 angular_velocity(const Symmetric3x4& c, const Vector3x4& l, vec_float4 least) {
  constexpr float kShift = 2e-6f;
  const vec_float4 trace = spu_add(spu_add(c.xx, c.yy), c.zz);
  const vec_float4 shift = spu_mul(trace, spu_splats(kShift));
  const vec_float4 ixx = spu_add(spu_add(c.yy, c.zz), shift);
  const vec_float4 iyy = spu_add(spu_add(c.xx, c.zz), shift);
  const vec_float4 izz = spu_add(spu_add(c.xx, c.yy), shift);
  // The adjugate and determinant of I, whose other elements are -C's.
  const vec_float4 axx = spu_msub(iyy, izz, spu_mul(c.yz, c.yz));
  const vec_float4 axy = spu_madd(c.zx, c.yz, spu_mul(c.xy, izz));
  const vec_float4 azx = spu_madd(c.xy, c.yz, spu_mul(c.zx, iyy));
  const vec_float4 ayy = spu_msub(ixx, izz, spu_mul(c.zx, c.zx));
  const vec_float4 ayz = spu_madd(c.xy, c.zx, spu_mul(ixx, c.yz));
  const vec_float4 azz = spu_msub(ixx, iyy, spu_mul(c.xy, c.xy));
  const vec_float4 determinant = spu_msub(ixx, axx, spu_madd(c.xy, axy, spu_mul(c.zx, azx)));
  const vec_uint4 nothing = spu_or(less(trace, least), less(determinant, spu_mul(shift, axx)));
  const vec_float4 inverse =
      (vec_float4)spu_andc((vec_uint4)reciprocal(determinant), negative_lanes(nothing));
  return scale({spu_madd(axx, l.x, spu_madd(axy, l.y, spu_mul(azx, l.z))),
                spu_madd(axy, l.x, spu_madd(ayy, l.y, spu_mul(ayz, l.z))),
                spu_madd(azx, l.x, spu_madd(ayz, l.y, spu_mul(azz, l.z)))},
               inverse);
}

/// Computes the twists of four regions from their sums, into the first two rows of four slots: the sums' own or others.
/// @param moment  sum m~ x of each region, from match_regions()
/// @param by      1 / M of each region
template <typename AnySlot>
inline void twist_regions(vec_float4 by, const Vector3x4& moment, const Slot* sums, AnySlot* slots,
                          vec_float4 noise_floor) {
  const Rows4 x = load_row(sums, 0), y = load_row(sums, 1), z = load_row(sums, 2);
  const Vector3x4 p = {x.a, x.b, x.c};
  const Vector3x4 c = scale(moment, by);
  const Vector3x4 orbital = cross(c, p);
  const Vector3x4 l = {spu_sub(y.a, orbital.x), spu_sub(y.b, orbital.y), spu_sub(y.c, orbital.z)};
  const Symmetric3x4 second = {spu_nmsub(moment.x, c.x, x.d), spu_nmsub(moment.y, c.y, y.d),
                               spu_nmsub(moment.z, c.z, z.d), spu_nmsub(moment.x, c.y, z.a),
                               spu_nmsub(moment.y, c.z, z.b), spu_nmsub(moment.z, c.x, z.c)};
  // Divided by the mass, so that the sizes of determinants do not depend on it.
  const Vector3x4 omega =
      angular_velocity({spu_mul(second.xx, by), spu_mul(second.yy, by), spu_mul(second.zz, by),
                        spu_mul(second.xy, by), spu_mul(second.yz, by), spu_mul(second.zx, by)},
                       scale(l, by), noise_floor);
  const Vector3x4 turning = cross(omega, c);
  const vec_float4 zero = spu_splats(0.0f);
  store_row(slots, 0,
            {spu_msub(p.x, by, turning.x), spu_msub(p.y, by, turning.y), spu_msub(p.z, by, turning.z), zero});
  store_row(slots, 1, {omega.x, omega.y, omega.z, zero});
}

/// The velocities of four particles, minus `damping` times the part that is not the rigid motion of their regions.
/// @param share   1 / |R_i| of each particle
/// @param region  offsets of the totals of their regions
template <typename AnySlot>
inline Vector3x4 damp(vec_float4 share, const uint32_t (&region)[4], const AnySlot* totals,
                      const Vector3x4& x, const Vector3x4& v, vec_float4 damping) {
  const auto row = [&](int k) __attribute__((always_inline)) {
    return transpose({slot_at(totals, region[0]).row[k], slot_at(totals, region[1]).row[k],
                      slot_at(totals, region[2]).row[k], slot_at(totals, region[3]).row[k]});
  };
  const Rows4 b = row(0), omega = row(1);
  const Vector3x4 turning = cross({omega.a, omega.b, omega.c}, x);
  const auto component = [&](vec_float4 sum, vec_float4 turn, vec_float4 before)
      __attribute__((always_inline)) {
    return spu_madd(damping, spu_msub(share, spu_add(sum, turn), before), before);
  };
  return {component(b.a, turning.x, v.x), component(b.b, turning.y, v.y), component(b.c, turning.z, v.z)};
}

}  // namespace softcell::spu
