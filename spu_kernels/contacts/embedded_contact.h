#pragma once
// A contact of a point of one body with the surface of another: its depth by the distance field at rest, and the
// particles that hold it on both sides.  [FL01], [MZS+11]

#include <spu_intrinsics.h>
#include <stdint.h>

#include "common/reciprocal.h"
#include "contact_find_job.h"
#include "contacts/body_in_store.h"
#include "contacts/entered_face.h"
#include "contacts/quad_vector.h"
#include "contacts/sequential_impulses.h"

namespace softcell::spu {

/// 1 / sqrt(x) for normal x > 0, with an error of a unit in the last place or two.
inline vec_float4 exact_reciprocal_sqrt(vec_float4 x) {
  const vec_float4 y = reciprocal_sqrt(x);
  const vec_float4 half = spu_mul(spu_mul(x, y), spu_splats(0.5f));
  return spu_madd(y, spu_nmsub(half, y, spu_splats(0.5f)), y);
}

/// An anchor whose weights are shares times roots of inverse masses.
inline Anchor anchor_of(vec_ushort8 corner, const Shares& shares, const vec_float4* begins) {
  const auto root = [&](int k) __attribute__((always_inline)) {
    return spu_extract(begins[spu_extract(corner, k)], 3);
  };
  const vec_float4 low = {root(0), root(1), root(2), root(3)}, high = {root(4), root(5), root(6), root(7)};
  return {corner, {spu_mul(shares.low, low), spu_mul(shares.high, high)}};
}

/// Numbers that do not change within a task.
struct TaskTerms {
  float step, inverse_step, friction;
  float slop_base;  ///< metres: the spacing that is the unit of depths
};

/// A point of one body in a cell of another one.
struct PointInCell {
  uint32_t cell_of_point, cell;
  vec_float4 s_of_point, s;  // x y z 0
  vec_float4 f1, f2, f3;     // dx/ds of the cell, x y z 0
  vec_float4 end;            // of the point
  float allowance;
};

/// The inverse of dx/ds at a place of a cell: its rows times the determinant, and the inverse of the determinant.
struct InverseThere {
  vec_float4 c1, c2, c3, by_volume;

  explicit InverseThere(const PointInCell& point)
      : c1(cross_of(point.f2, point.f3)),
        c2(cross_of(point.f3, point.f1)),
        c3(cross_of(point.f1, point.f2)),
        by_volume(reciprocal(dot_in_all_lanes(point.f1, c1))) {}

  /// Transforms a vector into the cell, without the division by the determinant. The fourth lane is that of c3.
  vec_float4 times_volume(vec_float4 v) const {
    const vec_float4 along1 = dot_in_all_lanes(c1, v), along2 = dot_in_all_lanes(c2, v);
    const vec_float4 along3 = dot_in_all_lanes(c3, v);
    const vec_uchar16 two_and_one = {0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23};
    return spu_shuffle(interleave_low(along1, along2), along3, two_and_one);
  }

  /// Transforms a gradient from the cell to the world; x y z 0.
  vec_float4 gradient(vec_float4 by_s) const {
    const vec_float4 sum = spu_madd(splat_lane<0>(by_s), c1,
                                    spu_madd(splat_lane<1>(by_s), c2, spu_mul(splat_lane<2>(by_s), c3)));
    return only_xyz(spu_mul(sum, by_volume));
  }
};

/// Whether the cosine of the angle between two vectors is above 1/2; reads the first lane.
/// @param product  their dot product  @param squares  |a|^2 |b|^2
inline bool are_alike(vec_float4 product, vec_float4 squares) {
  const vec_float4 signed_square = spu_mul(product, absolute(product));
  return spu_extract(spu_cmpgt(signed_square, spu_mul(squares, spu_splats(0.25f))), 0) != 0;
}

/// The field of the face by which a deep point has come in; or `nearest`, the field at the point, if that has nearly the same direction.
inline vec_float4 field_of_entered_face(const BodyInStore& mine, const BodyInStore& other,
                                        const PointInCell& point, const InverseThere& inverse, vec_float4 s,
                                        vec_float4 nearest) {
  vec_float4 inside;
  if (mine.ends == other.ends || !inner_place(mine, point.cell_of_point, inside)) return nearest;
  const vec_float4 along = only_xyz(spu_sub(inside, point.end));
  const vec_float4 way = only_xyz(spu_mul(inverse.times_volume(along), inverse.by_volume));
  const vec_float4 outwards = inverse.gradient(nearest), square = dot_in_all_lanes(outwards, outwards);
  const vec_float4 squares = spu_mul(square, dot_in_all_lanes(along, along));
  const vec_float4 length_squared = dot_in_all_lanes(way, way);
  if (!(spu_extract(length_squared, 0) > 0x1.4484cp-100f)) return nearest;  // 1e-30
  if (are_alike(dot_in_all_lanes(outwards, along), squares)) return nearest;
  const vec_float4 direction = spu_mul(way, exact_reciprocal_sqrt(length_squared));
  const vec_float4 field = field_of_face(other, point.cell, s, nearest, direction);
  const vec_float4 others = inverse.gradient(field);
  const bool is_same =
      are_alike(dot_in_all_lanes(outwards, others), spu_mul(square, dot_in_all_lanes(others, others)));
  return is_same ? nearest : field;
}

/// @param mine   the point's body  @param other  the body in whose cell the point is
/// @param swap   makes the contact as seen from `other`
/// @return       false: there is no contact
inline bool make_contact(const BodyInStore& mine, const BodyInStore& other, const PointInCell& point,
                         bool swap, const TaskTerms& task, SolvedContact& contact) {
  const CellAtRest& there = other.cells[point.cell];
  const vec_float4 half = spu_splats(0.5f);
  const vec_float4 s = larger(smaller(point.s, half), negative(half));
  const InverseThere inverse(point);
  vec_float4 field = field_at(there.field, s);
  if (spu_extract(field, 3) < -kFindDeep)
    field = field_of_entered_face(mine, other, point, inverse, s, field);
  const vec_float4 outwards = inverse.gradient(field);
  const vec_float4 square = dot_in_all_lanes(outwards, outwards);
  if (!(spu_extract(square, 0) > 0x1.4484cp-100f)) return false;  // 1e-30
  const vec_float4 flat = exact_reciprocal_sqrt(square);
  const vec_float4 normal = spu_mul(outwards, flat);
  const float distance = spu_extract(spu_mul(splat_lane<3>(field), flat), 0) + point.allowance;
  if (distance > kFindNear * other.spacing) return false;

  const vec_ushort8 own_corner = mine.cells[point.cell_of_point].corner;
  const Shares own = shares_at(point.s_of_point);
  const vec_float4 own_begin = value_of(own_corner, own, mine.begins);
  // At the step's beginning both sides are held at the same place: otherwise impulse and reaction would turn the two
  // bodies. While the point still approaches, this place may be somewhat outside of the cell.
  const vec_float4 farthest = spu_splats(1.0f);
  vec_float4 held = s;
  for (int i = 0; i < 3; ++i) {
    const vec_float4 off =
        only_xyz(spu_sub(own_begin, value_of(there.corner, shares_at(held), other.begins)));
    held = spu_madd(inverse.times_volume(off), inverse.by_volume, held);
    held = larger(smaller(held, farthest), negative(farthest));
  }
  const Shares others = shares_at(held);
  const vec_float4 their_begin = value_of(there.corner, others, other.begins);
  const vec_float4 their_end = value_of(there.corner, others, other.ends);
  const vec_float4 way = only_xyz(spu_sub(spu_sub(point.end, own_begin), spu_sub(their_end, their_begin)));
  // The distance at the beginning, if both sides move along straight lines.
  const float begin = distance - spu_extract(dot_in_all_lanes(normal, way), 0);
  const float apart = begin > 0.0f ? begin : 0.0f, depth = begin < 0.0f ? -begin : 0.0f;
  const float excess = depth - kFindSlop * task.slop_base;
  float push = 0.0f;
  if (excess > 0.0f) {
    const float share = kFindPushShare * excess, most = kFindMostPush * task.slop_base;
    push = (share < most ? share : most) * task.inverse_step;
  }

  const Anchor near = anchor_of(own_corner, own, mine.begins);
  const Anchor far = anchor_of(there.corner, others, other.begins);
  const vec_float4 squares =
      spu_madd(near.weight[0], near.weight[0],
               spu_madd(near.weight[1], near.weight[1],
                        spu_madd(far.weight[0], far.weight[0], spu_mul(far.weight[1], far.weight[1]))));
  const vec_float4 mobility = sum_of_lanes(squares);
  if (!(spu_extract(mobility, 0) > 0.0f)) return false;
  const float mass = spu_extract(reciprocal(mobility), 0);
  contact.a = swap ? far : near;
  contact.b = swap ? near : far;
  contact.normal = only_xyz(swap ? negative(normal) : normal);
  // `way` is the point's motion relative to the other body in this step; the solver adds changes of velocities to it.
  const vec_float4 approach = spu_mul(swap ? way : negative(way), spu_splats(task.inverse_step));
  contact.carried = with_fourth(approach, spu_splats(-apart * task.inverse_step));
  contact.terms = (vec_float4){mass, task.friction, push, 0.0f};
  contact.impulse = spu_splats(0.0f);
  const uint32_t cell_a = swap ? point.cell : point.cell_of_point,
                 cell_b = swap ? point.cell_of_point : point.cell;
  contact.point = point.end;
  uint16_t* const cells = reinterpret_cast<uint16_t*>(&contact.point) + 6;
  cells[0] = static_cast<uint16_t>(cell_a);
  cells[1] = static_cast<uint16_t>(cell_b);
  return true;
}

}  // namespace softcell::spu
