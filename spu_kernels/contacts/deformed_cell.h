#pragma once
// A deformed cell: maps a place in the cell to the world, and a point of the world to its place in the cell.
//
// With s = xi - 1/2 and the cell's middle c, x(s) = c + e1 s1 + e2 s2 + e3 s3 + xy s1 s2 + yz s2 s3 + zx s3 s1 + xyz s1 s2 s3.

#include <spu_intrinsics.h>

#include "common/lane_mask.h"
#include "common/reciprocal.h"
#include "common/vector3.h"
#include "contacts/quad_vector.h"

namespace softcell::spu {

/// x y z of each coefficient.
struct DeformedCell {
  vec_float4 c, e1, e2, e3, xy, yz, zx, xyz;
};

inline DeformedCell deformed_cell(vec_ushort8 corner, const vec_float4* positions) {
  const vec_float4 x0 = positions[spu_extract(corner, 0)], x1 = positions[spu_extract(corner, 1)];
  const vec_float4 x2 = positions[spu_extract(corner, 2)], x3 = positions[spu_extract(corner, 3)];
  const vec_float4 x4 = positions[spu_extract(corner, 4)], x5 = positions[spu_extract(corner, 5)];
  const vec_float4 x6 = positions[spu_extract(corner, 6)], x7 = positions[spu_extract(corner, 7)];
  const vec_float4 s01 = spu_add(x0, x1), s23 = spu_add(x2, x3), s45 = spu_add(x4, x5), s67 = spu_add(x6, x7);
  const vec_float4 d01 = spu_sub(x1, x0), d23 = spu_sub(x3, x2), d45 = spu_sub(x5, x4), d67 = spu_sub(x7, x6);
  const vec_float4 s_low = spu_add(s01, s23), s_high = spu_add(s45, s67);
  const vec_float4 y_low = spu_sub(s23, s01), y_high = spu_sub(s67, s45);
  const vec_float4 x_low = spu_add(d01, d23), x_high = spu_add(d45, d67);
  const vec_float4 xy_low = spu_sub(d23, d01), xy_high = spu_sub(d67, d45);
  const vec_float4 half = spu_splats(0.5f), quarter = spu_splats(0.25f), eighth = spu_splats(0.125f);
  return {spu_mul(spu_add(s_low, s_high), eighth),  spu_mul(spu_add(x_low, x_high), quarter),
          spu_mul(spu_add(y_low, y_high), quarter), spu_mul(spu_sub(s_high, s_low), quarter),
          spu_mul(spu_add(xy_low, xy_high), half),  spu_mul(spu_sub(y_high, y_low), half),
          spu_mul(spu_sub(x_high, x_low), half),    spu_sub(xy_high, xy_low)};
}

/// The inverse of a cell's mean deformation, with bounds for its error in the cell.
struct RoughInverse {
  vec_float4 row1, row2, row3;  // x y z and anything
  vec_float4 middle;
  vec_float4 reach;  // by s1 s2 s3: the largest |s| of points that may be in the cell
  vec_float4 least;  // of the field, as FindCell
  vec_float4
      limit;  // largest value of `least` at which the field may be near 0; -1e30: nothing is in the cell
};

/// @param least_volume  m^3: a flatter cell, or one turned inside out, holds nothing
/// @param near          largest distance that counts as near, in cells
inline RoughInverse rough_inverse(const DeformedCell& cell, vec_float4 least, float least_volume,
                                  float near) {
  const vec_float4 c1 = cross_of(cell.e2, cell.e3), c2 = cross_of(cell.e3, cell.e1);
  const vec_float4 c3 = cross_of(cell.e1, cell.e2);
  const vec_float4 volume = dot_in_all_lanes(only_xyz(cell.e1), c1);
  if (spu_extract(volume, 0) <= least_volume) {
    const vec_float4 zero = spu_splats(0.0f);
    return {zero, zero, zero, cell.c, spu_splats(-1.0f), zero, spu_splats(-0x1.93e594p+99f)};  // 1e30
  }
  const vec_float4 by = reciprocal(volume);
  const vec_float4 bend = only_xyz(
      spu_madd(spu_splats(0.25f), spu_add(absolute(cell.xy), spu_add(absolute(cell.yz), absolute(cell.zx))),
               spu_mul(spu_splats(0.125f), absolute(cell.xyz))));
  const vec_float4 row1 = spu_mul(c1, by), row2 = spu_mul(c2, by), row3 = spu_mul(c3, by);
  const vec_float4 slack1 = dot_in_all_lanes(absolute(row1), bend),
                   slack2 = dot_in_all_lanes(absolute(row2), bend);
  const vec_float4 slack3 = dot_in_all_lanes(absolute(row3), bend);
  const vec_float4 slack12 = interleave_low(slack1, slack2);
  const vec_uchar16 two_and_one = {0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23};
  const vec_float4 slack = spu_shuffle(slack12, slack3, two_and_one);
  const vec_float4 beyond = dot_in_all_lanes(only_xyz(absolute(least)), slack);
  return {
      row1, row2, row3, cell.c, spu_add(slack, spu_splats(0.501f)), least, spu_add(beyond, spu_splats(near))};
}

inline Vector3x4 in_all_lanes(vec_float4 v) { return {splat_lane<0>(v), splat_lane<1>(v), splat_lane<2>(v)}; }

/// A RoughInverse with each component in all lanes, to look up many points in one cell.
struct RoughInverse4 {
  Vector3x4 row1, row2, row3, middle, reach, least;
  vec_float4 least_at_middle, limit;
};

inline RoughInverse4 in_all_lanes(const RoughInverse& inverse) {
  return {in_all_lanes(inverse.row1),   in_all_lanes(inverse.row2),
          in_all_lanes(inverse.row3),   in_all_lanes(inverse.middle),
          in_all_lanes(inverse.reach),  in_all_lanes(inverse.least),
          splat_lane<3>(inverse.least), inverse.limit};
}

/// The places that four points would have in the cell if it were a parallelepiped.
inline Vector3x4 rough_place(const RoughInverse4& inverse, const Vector3x4& point) {
  const Vector3x4 d = difference(point, inverse.middle);
  return {dot(inverse.row1, d), dot(inverse.row2, d), dot(inverse.row3, d)};
}

/// A lower bound of the field at four places, in cells. In a body that is stretched to twice its length the field has half
/// the slope, so half of an allowance counts.
inline vec_float4 least_field(const Vector3x4& least, vec_float4 at_middle, const Vector3x4& s,
                              vec_float4 allowance_in_cells) {
  const vec_float4 below = spu_madd(least.x, s.x, spu_madd(least.y, s.y, spu_madd(least.z, s.z, at_middle)));
  return spu_madd(allowance_in_cells, spu_splats(0.5f), below);
}

/// Words whose top bit is set for points that cannot be in the cell, or are too far outside of the surface.
inline vec_uint4 surely_elsewhere(const RoughInverse4& inverse, const Vector3x4& s,
                                  vec_float4 allowance_in_cells) {
  const vec_uint4 beyond =
      spu_or(less(inverse.reach.x, absolute(s.x)),
             spu_or(less(inverse.reach.y, absolute(s.y)), less(inverse.reach.z, absolute(s.z))));
  const vec_float4 least = least_field(inverse.least, inverse.least_at_middle, s, allowance_in_cells);
  return spu_or(beyond, less(inverse.limit, least));
}

/// The coefficients of a cell, each component in all lanes.
struct CellMap {
  Vector3x4 c, e1, e2, e3, xy, yz, zx, xyz;
};

inline CellMap in_all_lanes(const DeformedCell& cell) {
  return {in_all_lanes(cell.c),  in_all_lanes(cell.e1), in_all_lanes(cell.e2), in_all_lanes(cell.e3),
          in_all_lanes(cell.xy), in_all_lanes(cell.yz), in_all_lanes(cell.zx), in_all_lanes(cell.xyz)};
}

/// Four places of a cell: their positions in the world, and the columns of dx/ds there.
struct MappedPoints {
  Vector3x4 position, f1, f2, f3;
};

/// One component of the positions and columns of four places.
struct MappedComponent {
  vec_float4 position, f1, f2, f3;
};

__attribute__((always_inline)) inline MappedComponent map_component(vec_float4 c, vec_float4 e1,
                                                                    vec_float4 e2, vec_float4 e3,
                                                                    vec_float4 xy, vec_float4 yz,
                                                                    vec_float4 zx, vec_float4 xyz,
                                                                    const Vector3x4& s) {
  const vec_float4 xy_there = spu_madd(xyz, s.z, xy);
  const vec_float4 along_y = spu_madd(yz, s.z, e2);
  const vec_float4 f1 = spu_madd(xy_there, s.y, spu_madd(zx, s.z, e1));
  const vec_float4 f2 = spu_madd(xy_there, s.x, along_y);
  const vec_float4 f3 = spu_madd(spu_madd(xyz, s.x, yz), s.y, spu_madd(zx, s.x, e3));
  return {spu_madd(f1, s.x, spu_madd(along_y, s.y, spu_madd(e3, s.z, c))), f1, f2, f3};
}

inline MappedPoints map_points(const CellMap& m, const Vector3x4& s) {
  const MappedComponent x = map_component(m.c.x, m.e1.x, m.e2.x, m.e3.x, m.xy.x, m.yz.x, m.zx.x, m.xyz.x, s);
  const MappedComponent y = map_component(m.c.y, m.e1.y, m.e2.y, m.e3.y, m.xy.y, m.yz.y, m.zx.y, m.xyz.y, s);
  const MappedComponent z = map_component(m.c.z, m.e1.z, m.e2.z, m.e3.z, m.xy.z, m.yz.z, m.zx.z, m.xyz.z, s);
  return {{x.position, y.position, z.position}, {x.f1, y.f1, z.f1}, {x.f2, y.f2, z.f2}, {x.f3, y.f3, z.f3}};
}

/// The places of four points in a cell, found by Newton's iteration.
struct FoundPlaces {
  Vector3x4 s;
  MappedPoints map;     // at the last but one iterate
  vec_uint4 elsewhere;  // top bit set: not in this cell, or outside of the surface for sure
};

/// The distance that counts as near in cells of any shape; exact distances are computed later.
constexpr float kNearInField = 0x1.99999ap-5f;  // 0.05

/// @param least      of the cell, as FindCell
/// @param elsewhere  words whose top bit is set in lanes that are not needed
inline FoundPlaces find_places(const CellMap& cell, vec_float4 least, const Vector3x4& point, Vector3x4 s,
                               vec_float4 allowance_in_cells, vec_uint4 elsewhere, float least_volume) {
  constexpr int kIterations = 3;
  const vec_float4 flattest = spu_splats(least_volume), near = spu_splats(kNearInField);
  const Vector3x4 slope = in_all_lanes(least);
  const vec_float4 at_middle = splat_lane<3>(least);
  MappedPoints map;
  for (int i = 0; i < kIterations; ++i) {
    map = map_points(cell, s);
    const Vector3x4 c1 = cross(map.f2, map.f3);
    const vec_float4 volume = dot(map.f1, c1);
    elsewhere = spu_or(elsewhere, less(volume, flattest));
    const vec_float4 by = reciprocal(larger(volume, flattest));
    const Vector3x4 d = difference(point, map.position);
    s.x = spu_madd(dot(c1, d), by, s.x);
    s.y = spu_madd(dot(cross(map.f3, map.f1), d), by, s.y);
    s.z = spu_madd(dot(cross(map.f1, map.f2), d), by, s.z);
    // The error after one step is of second order in the cell's bend. Many points need no other step.
    const vec_float4 reach = spu_splats(i == 0 ? 0x1.333334p-1f : 0.501f);               // 0.6
    const vec_float4 limit = i == 0 ? spu_add(near, spu_splats(0x1.99999ap-5f)) : near;  // 0.05
    elsewhere = spu_or(spu_or(elsewhere, less(reach, absolute(s.x))),
                       spu_or(spu_or(less(reach, absolute(s.y)), less(reach, absolute(s.z))),
                              less(limit, least_field(slope, at_middle, s, allowance_in_cells))));
    if (spu_extract(spu_gather(spu_rlmask(elsewhere, -31)), 0) == 15u) break;
  }
  return {s, map, elsewhere};
}

}  // namespace softcell::spu
