#pragma once
// A contact of a point of one body with the surface of another: how deep it is by the distance field at rest,
// and what is held on to on both sides.  [FL01], [MZS+11]

#include <spu_intrinsics.h>
#include <stdint.h>

#include "common/reciprocal.h"
#include "contact_find_job.h"
#include "contacts/deformed_cell.h"
#include "contacts/quad_vector.h"
#include "contacts/sequential_impulses.h"

namespace softcell::spu {

/// A FindCell as registers.
struct CellAtRest {
  vec_ushort8 corner;
  vec_short8 place;  // grid index x y z 0, first group, number of groups
  vec_float4 least;
  float field[28];
};
static_assert(sizeof(CellAtRest) == sizeof(FindCell), "the same bytes");

/// One body of a task in the local store.
struct BodyInStore {
  const CellAtRest* cells;
  const vec_float4* groups;  // four quadwords each
  const vec_float4* boxes;   // six quadwords for four cells
  const vec_float4* ends;
  const vec_float4* begins;  // and the roots of inverse masses
  uint32_t cell_count, particle_count;
  float spacing;
};

/// 1 / sqrt(x) for normal x > 0, to a unit in the last place or two.
inline vec_float4 exact_reciprocal_sqrt(vec_float4 x) {
  const vec_float4 y = reciprocal_sqrt(x);
  const vec_float4 half = spu_mul(spu_mul(x, y), spu_splats(0.5f));
  return spu_madd(y, spu_nmsub(half, y, spu_splats(0.5f)), y);
}

/// The distance in cells and its derivatives by s, trilinear between the nodes of an eighth of the cell.
/// @param s  -1/2..1/2; x y z
/// @return   d/ds1, d/ds2, d/ds3, and the distance
inline vec_float4 field_at(const float* field, vec_float4 s) {
  const vec_float4 place = spu_madd(s, spu_splats(2.0f), spu_splats(1.0f));  // 0..2
  const vec_int4 upper = (vec_int4)spu_andc(spu_splats(1u), spu_rlmask((vec_uint4)s, -31));
  const int32_t x = spu_extract(upper, 0), y = spu_extract(upper, 1), z = spu_extract(upper, 2);
  const vec_float4 f = spu_sub(place, spu_convtf(upper, 0));
  const float* const node = field + (z * 3 + y) * 3 + x;
  const vec_float4 low = {node[0], node[3], node[9], node[12]};  // x = 0: y z 00 10 01 11
  const vec_float4 high = {node[1], node[4], node[10], node[13]};
  const vec_float4 by_x = spu_sub(high, low);
  const vec_float4 at_x = spu_madd(splat_lane<0>(f), by_x, low);
  // Over y, then z: of the distances and of their slopes along x.
  const vec_uchar16 y_low = {0, 1, 2, 3, 8, 9, 10, 11, 16, 17, 18, 19, 24, 25, 26, 27};
  const vec_uchar16 y_high = {4, 5, 6, 7, 12, 13, 14, 15, 20, 21, 22, 23, 28, 29, 30, 31};
  const vec_float4 low_y = spu_shuffle(at_x, by_x, y_low);  // d z0, d z1, dx z0, dx z1
  const vec_float4 by_y = spu_sub(spu_shuffle(at_x, by_x, y_high), low_y);
  const vec_float4 at_y = spu_madd(splat_lane<1>(f), by_y, low_y);
  const vec_uchar16 z_low = {8, 9, 10, 11, 16, 17, 18, 19, 0, 1, 2, 3, 0, 1, 2, 3};
  const vec_uchar16 z_high = {12, 13, 14, 15, 20, 21, 22, 23, 4, 5, 6, 7, 4, 5, 6, 7};
  const vec_float4 z0 = spu_shuffle(at_y, by_y, z_low), z1 = spu_shuffle(at_y, by_y, z_high);
  const vec_float4 by_z = spu_sub(z1, z0);                       // dxz, dyz, dz, dz
  const vec_float4 at_z = spu_madd(splat_lane<2>(f), by_z, z0);  // dx, dy, d, d
  const vec_uchar16 slope_z = {0, 1, 2, 3, 4, 5, 6, 7, 24, 25, 26, 27, 12, 13, 14, 15};
  const vec_float4 all = spu_shuffle(at_z, by_z, slope_z);  // dx dy dz d
  const vec_float4 scale = {2.0f, 2.0f, 2.0f, 1.0f};
  return spu_mul(all, scale);
}

/// Trilinear shares of a cell's corners.
struct Shares {
  vec_float4 low, high;  // z = 0 and z = 1
};

inline Shares shares_at(vec_float4 s) {
  const vec_float4 half = spu_splats(0.5f);
  const vec_float4 upper = spu_add(half, s), lower = spu_sub(half, s);
  const vec_uchar16 x = {16, 17, 18, 19, 0, 1, 2, 3, 16, 17, 18, 19, 0, 1, 2, 3};
  const vec_uchar16 y = {20, 21, 22, 23, 20, 21, 22, 23, 4, 5, 6, 7, 4, 5, 6, 7};
  const vec_float4 xy = spu_mul(spu_shuffle(upper, lower, x), spu_shuffle(upper, lower, y));
  return {spu_mul(xy, splat_lane<2>(lower)), spu_mul(xy, splat_lane<2>(upper))};
}

inline vec_float4 value_of(vec_ushort8 corner, const Shares& shares, const vec_float4* values) {
  return value_at(Anchor{corner, {shares.low, shares.high}}, values);
}

/// Shares times roots of inverse masses.
inline Anchor anchor_of(vec_ushort8 corner, const Shares& shares, const vec_float4* begins) {
  const auto root = [&](int k) __attribute__((always_inline)) {
    return spu_extract(begins[spu_extract(corner, k)], 3);
  };
  const vec_float4 low = {root(0), root(1), root(2), root(3)}, high = {root(4), root(5), root(6), root(7)};
  return {corner, {spu_mul(shares.low, low), spu_mul(shares.high, high)}};
}

/// What does not change within a task.
struct TaskTerms {
  float step, inverse_step, friction;
  float slop_base;  ///< metres: the spacing by which depths are measured
};

/// What is known of a point in another body's cell.
struct PointInCell {
  uint32_t cell_of_point, cell;
  vec_float4 s_of_point, s;  // x y z 0
  vec_float4 f1, f2, f3;     // dx/ds of the cell, x y z 0
  vec_float4 end;            // of the point
  float allowance;
};

/// @param mine   the point's body, @param other  whose cell it is in
/// @param swap   the contact is to be as seen from `other`
/// @return       whether it is one
inline bool make_contact(const BodyInStore& mine, const BodyInStore& other, const PointInCell& point,
                         bool swap, const TaskTerms& task, SolvedContact& contact) {
  const CellAtRest& there = other.cells[point.cell];
  const vec_float4 half = spu_splats(0.5f);
  const vec_float4 s = larger(smaller(point.s, half), negative(half));
  const vec_float4 field = field_at(there.field, s);
  const vec_float4 c1 = cross_of(point.f2, point.f3), c2 = cross_of(point.f3, point.f1);
  const vec_float4 c3 = cross_of(point.f1, point.f2);
  const vec_float4 by_volume = reciprocal(dot_in_all_lanes(point.f1, c1));
  const vec_float4 outwards =
      only_xyz(spu_mul(spu_madd(splat_lane<0>(field), c1,
                                spu_madd(splat_lane<1>(field), c2, spu_mul(splat_lane<2>(field), c3))),
                       by_volume));
  const vec_float4 square = dot_in_all_lanes(outwards, outwards);
  if (!(spu_extract(square, 0) > 0x1.4484cp-100f)) return false;  // 1e-30
  const vec_float4 flat = exact_reciprocal_sqrt(square);
  const vec_float4 normal = spu_mul(outwards, flat);
  const float distance = spu_extract(spu_mul(splat_lane<3>(field), flat), 0) + point.allowance;
  if (distance > kFindNear * other.spacing) return false;

  const vec_ushort8 own_corner = mine.cells[point.cell_of_point].corner;
  const Shares own = shares_at(point.s_of_point);
  const vec_float4 own_begin = value_of(own_corner, own, mine.begins);
  // The other side is held at one place with this one at the step's beginning: else impulse and reaction would
  // turn the two bodies. What is on its way may be somewhat outside of the cell.
  const vec_float4 farthest = spu_splats(1.0f);
  vec_float4 held = s;
  for (int i = 0; i < 3; ++i) {
    const vec_float4 off =
        only_xyz(spu_sub(own_begin, value_of(there.corner, shares_at(held), other.begins)));
    const vec_float4 along1 = dot_in_all_lanes(c1, off), along2 = dot_in_all_lanes(c2, off);
    const vec_float4 along3 = dot_in_all_lanes(c3, off);
    const vec_float4 along12 = interleave_low(along1, along2);
    const vec_uchar16 two_and_one = {0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23};
    held = spu_madd(spu_shuffle(along12, along3, two_and_one), by_volume, held);
    held = larger(smaller(held, farthest), negative(farthest));
  }
  const Shares others = shares_at(held);
  const vec_float4 their_begin = value_of(there.corner, others, other.begins);
  const vec_float4 their_end = value_of(there.corner, others, other.ends);
  const vec_float4 way = only_xyz(spu_sub(spu_sub(point.end, own_begin), spu_sub(their_end, their_begin)));
  // The distance at the beginning, if what moves moves straight.
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
  // The way is that of the point against the other body; velocities change from there.
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
