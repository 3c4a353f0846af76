#pragma once
// Solves one attachment: the impulses that hold particles and places where they should be, and the pushes that bring them back
// there. ppu/attachments/attachment_rows.h has the equations.

#include <spu_intrinsics.h>
#include <stdint.h>

#include "attach/registers.h"
#include "common/reciprocal.h"
#include "contacts/quad_vector.h"
#include "contacts/rigid_in_motion.h"

namespace softcell::spu {

/// The state that attachments change: velocities and pushes of slots, and rigid bodies.
struct Held {
  vec_float4* velocities;
  vec_float4* pushes;
  RigidInMotion* rigids;
};

/// A link and its records.
struct LinkParts {
  Link* link;
  Point* points;
  Row* rows;
  Entry* entries;  // of the first body, then of the second one
};

/// Adds to x y z; the fourth lane of the sum does not change.
inline void add_to_xyz(vec_float4& sum, vec_float4 v) { sum = with_fourth(spu_add(sum, v), sum); }

/// The link's rigid body; null: it has none that moves.
inline RigidInMotion* rigid_of(const Link& link, const Held& held) {
  return link.rigid == kAttachNoRigid ? nullptr : held.rigids + link.rigid;
}

inline bool is_soft(const Link& link) { return spu_extract(link.terms, 0) > 0.0f; }

/// The error of velocity of a compliant row.
inline vec_float4 softened(const Link& link, vec_float4 v, vec_float4 error, vec_float4 impulse) {
  return spu_madd(splat_lane<0>(link.terms), impulse, spu_add(v, error));
}

inline float squared_length(vec_float4 v) { return spu_extract(dot_in_all_lanes(v, v), 0); }

inline uint32_t slot_of(const Point& point) { return spu_extract((vec_uint4)point.impulse, 3); }
inline uint32_t slot_of(const Entry& entry) { return spu_extract(entry.slot, 0); }

/// Solves all points at once: their errors of velocity, then the motion that all of them give the rigid body, then their impulses.
/// @return  the square of the largest error
inline float solve_points(const LinkParts& parts, const Held& held) {
  const Link& link = *parts.link;
  RigidInMotion* const rigid = rigid_of(link, held);
  const bool soft = is_soft(link);
  const vec_float4 zero = spu_splats(0.0f);
  vec_float4 momentum = zero, turn = zero;
  float largest = 0.0f;
  for (uint32_t i = 0; i < link.points; ++i) {
    Point& point = parts.points[i];
    const vec_float4 arm = only_xyz(point.arm);
    vec_float4 v = spu_msub(splat_lane<3>(point.arm), held.velocities[slot_of(point)], point.carried);
    if (rigid != nullptr) v = spu_sub(v, change_at(*rigid, arm));
    if (soft) v = softened(link, v, point.error, point.impulse);
    point.missing = v = only_xyz(v);
    const vec_float4 pull = spu_mul(splat_lane<3>(point.carried), v);
    momentum = spu_add(momentum, pull);
    turn = spu_add(turn, cross_of(arm, pull));
    const float square = squared_length(v);
    if (square > largest) largest = square;
  }
  vec_float4 velocity = zero, spin = zero, given = zero;
  if (rigid != nullptr) {
    const vec_float4 arms = only_xyz(link.arms), inverse_sum = splat_lane<3>(link.arms);
    spin = times(link.inverse_inertia, spu_nmsub(cross_of(arms, momentum), inverse_sum, turn));
    velocity = spu_mul(spu_sub(momentum, cross_of(spin, arms)), inverse_sum);
  }
  for (uint32_t i = 0; i < link.points; ++i) {
    Point& point = parts.points[i];
    const vec_float4 weight = splat_lane<3>(point.arm);
    const vec_float4 wanted = spu_add(velocity, cross_of(spin, only_xyz(point.arm)));
    const vec_float4 change = only_xyz(spu_mul(splat_lane<3>(point.carried), spu_sub(wanted, point.missing)));
    const uint32_t slot = slot_of(point);
    add_to_xyz(point.impulse, change);
    held.velocities[slot] = spu_madd(weight, change, held.velocities[slot]);
    given = spu_add(given, change);
    if (link.pushes == 0) continue;
    const vec_float4 off = only_xyz(spu_madd(weight, held.pushes[slot], point.error));
    const vec_float4 push = spu_mul(weight, negative(spu_mul(splat_lane<3>(point.error), off)));
    held.pushes[slot] = spu_add(held.pushes[slot], push);
    point.pushed = spu_add(point.pushed, push);
  }
  if (rigid != nullptr) {
    // The rigid body loses the momentum that the points got.
    rigid->velocity = spu_nmsub(splat_lane<3>(rigid->velocity), given, rigid->velocity);
    rigid->spin = spu_add(rigid->spin, spin);
  }
  return largest;
}

/// Calls work(entry, whether it is the second body's) for each entry.
template <typename Work>
__attribute__((always_inline)) inline void each_entry(const LinkParts& parts, const Work& work) {
  Entry* entry = parts.entries;
  for (uint32_t side = 0; side < 2; ++side)
    for (uint32_t i = 0; i < parts.link->entries[side]; ++i) work(*entry++, side != 0);
}

/// A vector for each of four places.
struct FourPlaces {
  vec_float4 at[4];
};

/// Adds to each place its value: the weighted sum over particles of the first body, minus that of the second one.
inline void gather(const LinkParts& parts, const vec_float4* values, FourPlaces& places) {
  vec_float4 v0 = places.at[0], v1 = places.at[1], v2 = places.at[2], v3 = places.at[3];
  each_entry(
      parts, [&](const Entry& entry, bool second) __attribute__((always_inline)) {
        const vec_float4 value = second ? negative(values[slot_of(entry)]) : values[slot_of(entry)];
        v0 = spu_madd(splat_lane<0>(entry.weight), value, v0);
        v1 = spu_madd(splat_lane<1>(entry.weight), value, v1);
        v2 = spu_madd(splat_lane<2>(entry.weight), value, v2);
        v3 = spu_madd(splat_lane<3>(entry.weight), value, v3);
      });
  places = {{only_xyz(v0), only_xyz(v1), only_xyz(v2), only_xyz(v3)}};
}

/// The change of an entry's particle by impulses at places, in the unit of slots.
inline vec_float4 share_of(const Entry& entry, const FourPlaces& impulses, bool second) {
  vec_float4 sum = spu_mul(splat_lane<0>(entry.weight), impulses.at[0]);
  sum = spu_madd(splat_lane<1>(entry.weight), impulses.at[1], sum);
  sum = spu_madd(splat_lane<2>(entry.weight), impulses.at[2], sum);
  sum = spu_madd(splat_lane<3>(entry.weight), impulses.at[3], sum);
  return second ? negative(sum) : sum;
}

inline void apply(const LinkParts& parts, const Held& held, const FourPlaces& impulses) {
  each_entry(
      parts, [&](const Entry& entry, bool second) __attribute__((always_inline)) {
        vec_float4& v = held.velocities[slot_of(entry)];
        v = spu_add(v, share_of(entry, impulses, second));
      });
}

inline void apply_push(const LinkParts& parts, const Held& held, const FourPlaces& impulses) {
  each_entry(
      parts, [&](Entry & entry, bool second) __attribute__((always_inline)) {
        const vec_float4 push = share_of(entry, impulses, second);
        vec_float4& v = held.pushes[slot_of(entry)];
        v = spu_add(v, push);
        add_to_xyz(entry.pushed, push);
      });
}

/// Minus the product of a symmetric matrix, given by columns, and the values of places, for each axis.
inline FourPlaces impulses_against(const vec_float4* columns, const FourPlaces& v) {
  const auto row = [&](vec_float4 c) __attribute__((always_inline)) {
    vec_float4 sum = spu_mul(splat_lane<0>(c), v.at[0]);
    sum = spu_madd(splat_lane<1>(c), v.at[1], sum);
    sum = spu_madd(splat_lane<2>(c), v.at[2], sum);
    return negative(spu_madd(splat_lane<3>(c), v.at[3], sum));
  };
  return {{row(columns[0]), row(columns[1]), row(columns[2]), row(columns[3])}};
}

/// Solves all places at once. @return  the square of the largest error
inline float solve_places(const LinkParts& parts, const Held& held) {
  const Link& link = *parts.link;
  const bool soft = is_soft(link);
  FourPlaces v = {{spu_splats(0.0f), spu_splats(0.0f), spu_splats(0.0f), spu_splats(0.0f)}};
  for (uint32_t k = 0; k < link.rows; ++k) {
    const Row& row = parts.rows[k];
    v.at[k] = negative(row.carried);
    if (soft) v.at[k] = softened(link, v.at[k], row.error, row.impulse);
  }
  gather(parts, held.velocities, v);
  float largest = 0.0f;
  for (uint32_t k = 0; k < link.rows; ++k) {
    const float square = squared_length(v.at[k]);
    if (square > largest) largest = square;
  }
  const FourPlaces impulses = impulses_against(link.inverse, v);
  for (uint32_t k = 0; k < link.rows; ++k) add_to_xyz(parts.rows[k].impulse, impulses.at[k]);
  apply(parts, held, impulses);
  if (link.pushes == 0) return largest;
  FourPlaces off = {{spu_splats(0.0f), spu_splats(0.0f), spu_splats(0.0f), spu_splats(0.0f)}};
  for (uint32_t k = 0; k < link.rows; ++k) off.at[k] = parts.rows[k].error;
  gather(parts, held.pushes, off);
  apply_push(parts, held, impulses_against(link.inverse_of_pushes, off));
  return largest;
}

/// A value at one place, and zero at the others.
inline FourPlaces only_at(uint32_t place, vec_float4 value) {
  FourPlaces places = {{spu_splats(0.0f), spu_splats(0.0f), spu_splats(0.0f), spu_splats(0.0f)}};
  places.at[place] = value;
  return places;
}

/// The error of velocity of a row, with the velocity of its rigid body.
inline vec_float4 error_of_row(const LinkParts& parts, const Held& held, uint32_t k) {
  const Row& row = parts.rows[k];
  FourPlaces v = only_at(k, negative(row.carried));
  gather(parts, held.velocities, v);
  const RigidInMotion* const rigid = rigid_of(*parts.link, held);
  return rigid == nullptr ? v.at[k] : spu_sub(v.at[k], change_at(*rigid, only_xyz(row.arm)));
}

inline void apply_to_row(const LinkParts& parts, const Held& held, uint32_t k, vec_float4 impulse) {
  apply(parts, held, only_at(k, impulse));
  if (RigidInMotion* const rigid = rigid_of(*parts.link, held))
    take_at(*rigid, only_xyz(parts.rows[k].arm), impulse);
}

/// Solves rows one after the other. @return  the square of the largest error
inline float solve_hinge(const LinkParts& parts, const Held& held) {
  const Link& link = *parts.link;
  float largest = 0.0f;
  for (uint32_t k = 0; k < link.rows; ++k) {
    Row& row = parts.rows[k];
    vec_float4 v = error_of_row(parts, held, k);
    if (is_soft(link)) v = softened(link, v, row.error, row.impulse);
    v = only_xyz(v);
    const float square = squared_length(v);
    if (square > largest) largest = square;
    const vec_float4 change = negative(times(row.inverse, v));
    add_to_xyz(row.impulse, change);
    apply_to_row(parts, held, k, change);
    if (link.pushes == 0) continue;
    FourPlaces off = only_at(k, row.error);
    gather(parts, held.pushes, off);
    apply_push(parts, held, only_at(k, negative(spu_mul(splat_lane<3>(row.error), off.at[k]))));
  }
  return largest;
}

inline vec_float4 not_above_zero(vec_float4 v) { return spu_and(v, (vec_float4)below_zero(v)); }

/// Solves a rope, which pulls and never pushes. @return  the square of its error
inline float solve_rope(const LinkParts& parts, const Held& held) {
  const Link& link = *parts.link;
  Row& row = *parts.rows;
  const vec_float4 along = only_xyz(row.along), mass = splat_lane<3>(row.arm);
  const vec_float4 before = dot_in_all_lanes(along, row.impulse);
  const vec_float4 speed = dot_in_all_lanes(along, error_of_row(parts, held, 0));
  vec_float4 error = spu_sub(splat_lane<3>(row.carried), speed);
  error = spu_nmsub(splat_lane<0>(link.terms), before, error);
  const vec_float4 after = not_above_zero(spu_madd(error, mass, before));
  const vec_float4 change = spu_sub(after, before);
  apply_to_row(parts, held, 0, spu_mul(change, along));
  row.impulse = with_fourth(spu_mul(after, along), row.impulse);
  if (spu_extract(row.along, 3) < 0.0f) {
    FourPlaces off = only_at(0, spu_splats(0.0f));
    gather(parts, held.pushes, off);
    const vec_float4 missing = spu_sub(splat_lane<3>(row.along), dot_in_all_lanes(along, off.at[0]));
    const vec_float4 pushed = splat_lane<3>(row.impulse);
    const vec_float4 push = not_above_zero(spu_madd(missing, splat_lane<3>(row.error), pushed));
    apply_push(parts, held, only_at(0, spu_mul(spu_sub(push, pushed), along)));
    row.impulse = with_fourth(row.impulse, push);
  }
  return squared_length(only_xyz(spu_mul(spu_mul(change, reciprocal(mass)), along)));
}

/// If the impulses of a link are together above its limit, scales them down to it and marks the link as broken.
inline void keep_below_break_impulse(const LinkParts& parts, const Held& held) {
  Link& link = *parts.link;
  vec_float4 sum = spu_splats(0.0f);
  for (uint32_t i = 0; i < link.points; ++i) sum = spu_add(sum, only_xyz(parts.points[i].impulse));
  for (uint32_t k = 0; k < link.rows; ++k) sum = spu_add(sum, only_xyz(parts.rows[k].impulse));
  const float square = squared_length(sum), most = spu_extract(link.terms, 1);
  link.broke = square > most * most ? 1 : 0;
  if (link.broke == 0) return;
  const vec_float4 kept = spu_mul(splat_lane<1>(link.terms), reciprocal_sqrt(spu_splats(square)));
  RigidInMotion* const rigid = rigid_of(link, held);
  for (uint32_t i = 0; i < link.points; ++i) {
    Point& point = parts.points[i];
    const vec_float4 impulse = only_xyz(point.impulse);
    const vec_float4 change = spu_msub(impulse, kept, impulse);
    vec_float4& v = held.velocities[slot_of(point)];
    v = spu_madd(splat_lane<3>(point.arm), change, v);
    if (rigid != nullptr) take_at(*rigid, only_xyz(point.arm), change);
    add_to_xyz(point.impulse, change);
  }
  for (uint32_t k = 0; k < link.rows; ++k) {
    const vec_float4 impulse = only_xyz(parts.rows[k].impulse);
    const vec_float4 change = spu_msub(impulse, kept, impulse);
    apply_to_row(parts, held, k, change);
    add_to_xyz(parts.rows[k].impulse, change);
  }
}

/// Not a switch, because compilers make tables of addresses from it, which an image must not have.
inline float solve_kind(const LinkParts& parts, const Held& held) {
  if (parts.link->kind == kAttachPoints) return solve_points(parts, held);
  if (parts.link->kind == kAttachPlaces) return solve_places(parts, held);
  if (parts.link->kind == kAttachHinge) return solve_hinge(parts, held);
  return solve_rope(parts, held);
}

/// Makes one iteration over a link. @return  the square of the largest error of velocity, (m/s)^2
inline float solve(const LinkParts& parts, const Held& held) {
  const float largest = solve_kind(parts, held);
  if (parts.link->breaks != 0) keep_below_break_impulse(parts, held);
  return largest;
}

/// Limits the push of one attachment, because attachments that contradict each other push further in each iteration. Pushes by other
/// attachments do not change.
inline void limit_push(vec_float4& push, vec_float4 pushed, vec_float4 root, float most) {
  const vec_float4 speed = only_xyz(spu_mul(root, pushed));
  const float square = squared_length(speed);
  if (!(square > most * most)) return;
  const vec_float4 kept = spu_mul(spu_splats(most), reciprocal_sqrt(spu_splats(square)));
  push = spu_sub(push, only_xyz(spu_nmsub(kept, pushed, pushed)));
}

inline void limit_pushes(const LinkParts& parts, const Held& held) {
  const Link& link = *parts.link;
  if (link.pushes == 0) return;
  for (uint32_t i = 0; i < link.points; ++i) {
    const Point& point = parts.points[i];
    limit_push(held.pushes[slot_of(point)], point.pushed, splat_lane<3>(point.arm),
               spu_extract(link.terms, 2));
  }
  each_entry(
      parts, [&](const Entry& entry, bool second) __attribute__((always_inline)) {
        limit_push(held.pushes[slot_of(entry)], entry.pushed, splat_lane<3>(entry.pushed),
                   second ? spu_extract(link.terms, 3) : spu_extract(link.terms, 2));
      });
}

}  // namespace softcell::spu
