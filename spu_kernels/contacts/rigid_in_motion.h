#pragma once
// Rigid bodies that impulses move.

#include <spu_intrinsics.h>

#include "contact_solve_job.h"
#include "contacts/quad_vector.h"

namespace softcell::spu {

/// The first part of a SolveRigid, as registers: all that a free rigid body has.
struct RigidInMotion {
  vec_float4 velocity;  // x y z, and the inverse mass
  vec_float4 spin;      // x y z, and whether it is held
  vec_float4 inverse_inertia[3];
};

/// A SolveRigid as registers.
struct HeldRigid {
  RigidInMotion motion;
  vec_float4 linear[3], coupling[3], coupled[3];
};
static_assert(sizeof(HeldRigid) == sizeof(SolveRigid), "the same bytes");

/// The change of its velocity at a point. @param arm  from its centre to the point; the fourth lane is 0
inline vec_float4 change_at(const RigidInMotion& rigid, vec_float4 arm) {
  return spu_add(rigid.velocity, cross_of(rigid.spin, arm));
}

/// The product of a matrix, by columns, and a vector.
inline vec_float4 times(const vec_float4* columns, vec_float4 v) {
  const vec_float4 first = spu_mul(splat_lane<0>(v), columns[0]);
  return spu_madd(splat_lane<2>(v), columns[2], spu_madd(splat_lane<1>(v), columns[1], first));
}

/// v minus the product of a matrix, by columns, and a vector.
inline vec_float4 minus_product(vec_float4 v, const vec_float4* columns, vec_float4 by) {
  v = spu_nmsub(splat_lane<0>(by), columns[0], v);
  v = spu_nmsub(splat_lane<1>(by), columns[1], v);
  return spu_nmsub(splat_lane<2>(by), columns[2], v);
}

/// Subtracts an impulse from the rigid body's momentum. @param impulse  the fourth lane is 0
inline void take_at(RigidInMotion& rigid, vec_float4 arm, vec_float4 impulse) {
  const vec_float4 turn = cross_of(arm, impulse);
  rigid.velocity = spu_nmsub(splat_lane<3>(rigid.velocity), impulse, rigid.velocity);
  rigid.spin = minus_product(rigid.spin, rigid.inverse_inertia, turn);
}

inline void take_at(HeldRigid& rigid, vec_float4 arm, vec_float4 impulse) {
  RigidInMotion& motion = rigid.motion;
  take_at(motion, arm, impulse);
  if (__builtin_expect(spu_extract(motion.spin, 3) == 0.0f, 1)) return;
  const vec_float4 turn = cross_of(arm, impulse);
  motion.velocity =
      minus_product(minus_product(motion.velocity, rigid.linear, impulse), rigid.coupling, turn);
  motion.spin = minus_product(motion.spin, rigid.coupled, impulse);
}

}  // namespace softcell::spu
