#pragma once
// Rigid bodies whose velocities impulses change.

#include <spu_intrinsics.h>

#include "contact_solve_job.h"
#include "contacts/quad_vector.h"

namespace softcell::spu {

/// A SolveRigid as registers.
struct RigidInMotion {
  vec_float4 velocity;  // x y z, and the inverse mass
  vec_float4 spin;
  vec_float4 inverse_inertia[3];
};
static_assert(sizeof(RigidInMotion) == sizeof(SolveRigid), "the same bytes");

/// How its velocity has changed at a point. @param arm  from its centre; a fourth lane of 0
inline vec_float4 change_at(const RigidInMotion& rigid, vec_float4 arm) {
  return spu_add(rigid.velocity, cross_of(rigid.spin, arm));
}

/// The product of a matrix, by columns, and a vector.
inline vec_float4 times(const vec_float4* columns, vec_float4 v) {
  const vec_float4 first = spu_mul(splat_lane<0>(v), columns[0]);
  return spu_madd(splat_lane<2>(v), columns[2], spu_madd(splat_lane<1>(v), columns[1], first));
}

/// It loses an impulse, whose fourth lane is 0.
inline void take_at(RigidInMotion& rigid, vec_float4 arm, vec_float4 impulse) {
  const vec_float4 turn = cross_of(arm, impulse);
  rigid.velocity = spu_nmsub(splat_lane<3>(rigid.velocity), impulse, rigid.velocity);
  vec_float4 spin = spu_nmsub(splat_lane<0>(turn), rigid.inverse_inertia[0], rigid.spin);
  spin = spu_nmsub(splat_lane<1>(turn), rigid.inverse_inertia[1], spin);
  rigid.spin = spu_nmsub(splat_lane<2>(turn), rigid.inverse_inertia[2], spin);
}

}  // namespace softcell::spu
