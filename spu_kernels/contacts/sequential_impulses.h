#pragma once
// Solves one contact after the other: impulses that keep bodies apart, hold them by friction, and push them out of
// each other.  [Cat05]

#include <spu_intrinsics.h>
#include <stdint.h>

#include "common/reciprocal.h"
#include "contact_solve_job.h"
#include "contacts/quad_vector.h"
#include "contacts/rigid_in_motion.h"

namespace softcell::spu {

/// A SolveAnchor as registers.
struct Anchor {
  vec_ushort8 particle;
  vec_float4 weight[2];
};

/// The kind of the other side of a contact.
enum class With { kNothingThatMoves, kSoft, kRigid };

/// A SolveRigidPoint as registers.
struct RigidPoint {
  vec_ushort8 rigid;  // its index, and zeros
  vec_float4 arm;     // x y z, and the mass of pushes
  vec_float4 feels;   // x y z, and the mass of friction
};

/// A SolveContact as registers.
struct SolvedContact {
  Anchor a;
  union {
    Anchor b;
    RigidPoint rigid;
  };
  vec_float4 normal;   // x y z 0
  vec_float4 carried;  // x y z, and the least velocity
  vec_float4 terms;    // mass, friction, push velocity, push
  vec_float4 impulse;  // of friction x y z, and along the normal
  vec_float4 point;    // x y z, and cells
};
static_assert(sizeof(SolvedContact) == sizeof(SolveContact), "the same bytes");

/// The sum of weight times value: even terms, odd terms, then both.
inline vec_float4 value_at(const Anchor& anchor, const vec_float4* values) {
  const vec_ushort8 p = anchor.particle;
  const vec_float4 w0 = anchor.weight[0], w1 = anchor.weight[1];
  vec_float4 even = spu_mul(splat_lane<0>(w0), values[spu_extract(p, 0)]);
  vec_float4 odd = spu_mul(splat_lane<1>(w0), values[spu_extract(p, 1)]);
  even = spu_madd(splat_lane<2>(w0), values[spu_extract(p, 2)], even);
  odd = spu_madd(splat_lane<3>(w0), values[spu_extract(p, 3)], odd);
  even = spu_madd(splat_lane<0>(w1), values[spu_extract(p, 4)], even);
  odd = spu_madd(splat_lane<1>(w1), values[spu_extract(p, 5)], odd);
  even = spu_madd(splat_lane<2>(w1), values[spu_extract(p, 6)], even);
  odd = spu_madd(splat_lane<3>(w1), values[spu_extract(p, 7)], odd);
  return spu_add(even, odd);
}

/// values += weight impulse.
inline void add_at(const Anchor& anchor, vec_float4* values, vec_float4 impulse) {
  const vec_ushort8 p = anchor.particle;
  const vec_float4 w0 = anchor.weight[0], w1 = anchor.weight[1];
  const auto add = [&](uint32_t particle, vec_float4 weight) __attribute__((always_inline)) {
    values[particle] = spu_madd(weight, impulse, values[particle]);
  };
  add(spu_extract(p, 0), splat_lane<0>(w0));
  add(spu_extract(p, 1), splat_lane<1>(w0));
  add(spu_extract(p, 2), splat_lane<2>(w0));
  add(spu_extract(p, 3), splat_lane<3>(w0));
  add(spu_extract(p, 4), splat_lane<0>(w1));
  add(spu_extract(p, 5), splat_lane<1>(w1));
  add(spu_extract(p, 6), splat_lane<2>(w1));
  add(spu_extract(p, 7), splat_lane<3>(w1));
}

inline HeldRigid& rigid_of(const RigidPoint& point, HeldRigid* rigids) {
  return rigids[spu_extract(point.rigid, 0)];
}

/// Solves one contact: the impulse along its normal, and the friction across it (Coulomb's law, the same in all directions).
template <With kWith>
inline void solve_velocities(SolvedContact& contact, vec_float4* a, [[maybe_unused]] vec_float4* b,
                             [[maybe_unused]] HeldRigid* rigids) {
  const vec_float4 n = contact.normal, terms = contact.terms;
  const vec_float4 mass = splat_lane<0>(terms);
  vec_float4 v = spu_sub(value_at(contact.a, a), contact.carried);
  if constexpr (kWith == With::kSoft) v = spu_sub(v, value_at(contact.b, b));
  if constexpr (kWith == With::kRigid)
    v = spu_sub(v, change_at(rigid_of(contact.rigid, rigids).motion, only_xyz(contact.rigid.arm)));
  v = only_xyz(v);
  vec_float4 along = dot_in_all_lanes(n, v);
  const vec_float4 before = splat_lane<3>(contact.impulse);
  const vec_float4 wanted = spu_madd(spu_sub(splat_lane<3>(contact.carried), along), mass, before);
  const vec_float4 impulse = not_below_zero(wanted);

  // An impulse along the normal changes the sliding velocity only if it turns a rigid body.
  vec_float4 friction_mass = mass;
  if constexpr (kWith == With::kRigid) {
    v = spu_madd(only_xyz(contact.rigid.feels), spu_sub(impulse, before), v);
    along = dot_in_all_lanes(n, v);
    friction_mass = splat_lane<3>(contact.rigid.feels);
  }
  const vec_float4 sliding = spu_nmsub(along, n, v);
  const vec_float4 friction_before = only_xyz(contact.impulse);
  vec_float4 friction = spu_nmsub(sliding, friction_mass, friction_before);
  const vec_float4 most = spu_mul(splat_lane<1>(terms), impulse);
  const vec_float4 square = dot_in_all_lanes(friction, friction);
  const vec_uint4 slips = below_zero(spu_msub(most, most, square));
  const vec_float4 scale = spu_sel(spu_splats(1.0f), spu_mul(most, reciprocal_sqrt(square)), slips);
  friction = spu_mul(friction, scale);

  const vec_float4 change = spu_madd(n, spu_sub(impulse, before), spu_sub(friction, friction_before));
  add_at(contact.a, a, change);
  if constexpr (kWith == With::kSoft) add_at(contact.b, b, negative(change));
  if constexpr (kWith == With::kRigid)
    take_at(rigid_of(contact.rigid, rigids), only_xyz(contact.rigid.arm), change);
  contact.impulse = with_fourth(friction, impulse);
}

/// Solves the push of one contact, which moves soft bodies only.
template <With kWith>
inline void solve_push(SolvedContact& contact, vec_float4* a, [[maybe_unused]] vec_float4* b) {
  const vec_float4 n = contact.normal, terms = contact.terms;
  vec_float4 v = value_at(contact.a, a);
  if constexpr (kWith == With::kSoft) v = spu_sub(v, value_at(contact.b, b));
  const vec_float4 mass = kWith == With::kRigid ? splat_lane<3>(contact.rigid.arm) : splat_lane<0>(terms);
  const vec_float4 along = dot_in_all_lanes(n, only_xyz(v));
  const vec_float4 before = splat_lane<3>(terms);
  const vec_float4 wanted = spu_madd(spu_sub(splat_lane<2>(terms), along), mass, before);
  const vec_float4 push = not_below_zero(wanted);
  const vec_float4 change = spu_mul(n, spu_sub(push, before));
  add_at(contact.a, a, change);
  if constexpr (kWith == With::kSoft) add_at(contact.b, b, negative(change));
  contact.terms = with_fourth(terms, push);
}

}  // namespace softcell::spu
