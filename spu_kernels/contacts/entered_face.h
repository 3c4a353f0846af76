#pragma once
// Finds the face of another body by which a point has come in.
//
// Contacts are found for places at the substep's end, before they are solved. A stiff body that is pressed returns to its shape within a
// substep, so its points may end in the middle of the other body, where the nearest face may be any. The point leaves by the face where its
// way through the body at rest gets deep:
//
//         o  the point at the beginning
//    .----|------------.
//    |    |            |
//    |    '----x       |   x at the end: the nearest face is the one on the right
//    '-----------------'
//
// If the point is deep from the beginning, it leaves by the face that is nearest then; or by the one that a line to the inside of its own
// body meets, if that one is not much farther as the body is deformed. Of a body that is pressed flat, the nearest face at rest is often
// its rim, because it is higher at rest than it is now. By that face, two bodies on each other would be pushed sideways, and into each
// other.
//
//      a  .--------------.
//         |       *      |      * well inside of a
//    .----+-------o------+-.    o the face of b that the line from x to * meets
//    |    '-------x------' |    x a point of a
//  b |                     |
//    '---------------------'

#include <spu_intrinsics.h>
#include <stdint.h>

#include "contact_find_job.h"
#include "contacts/body_in_store.h"
#include "contacts/quad_vector.h"

namespace softcell::spu {

/// The place of FindCell::inner_node, -1/2..1/2 along each edge; x y z 0.
inline vec_float4 place_of_node(uint32_t node) {
  const vec_int4 steps = {static_cast<int32_t>(node & 3u), static_cast<int32_t>(node >> 2 & 3u),
                          static_cast<int32_t>(node >> 4 & 3u), 1};
  return spu_msub(spu_convtf(steps, 0), spu_splats(0.5f), spu_splats(0.5f));
}

/// Finds a place well inside of a body near one of its cells, metres, at the substep's beginning; x y z.
/// @return  false: the place is not in the local store
inline bool inner_place(const BodyInStore& body, uint32_t cell, vec_float4& place) {
  const vec_short8 own = body.cells[cell].place;
  const uint32_t inner = static_cast<uint32_t>(spu_extract(own, 6)) & 0xFFFFu;
  if (inner == kFindNoCell) return false;
  const uint32_t node = static_cast<uint32_t>(spu_extract(own, 7));
  place = value_of(body.cells[inner].corner, shares_at(place_of_node(node)), body.begins);
  return true;
}

/// Finds the cell at a place of the lattice. Cells that are near each other in the lattice are mostly near in the list, too.
/// @param place  grid index x y z and 0   @param near  a cell near that place
/// @return       cell_count: there is no such cell
inline uint32_t cell_at(const BodyInStore& body, vec_int4 place, uint32_t near) {
  const vec_uchar16 halfwords = {2, 3, 6, 7, 10, 11, 14, 15, 2, 3, 6, 7, 10, 11, 14, 15};
  const vec_short8 wanted = spu_shuffle((vec_short8)place, (vec_short8)place, halfwords);
  const auto is_it = [&](uint32_t cell) __attribute__((always_inline)) {
    return spu_extract(spu_gather(spu_cmpeq(body.cells[cell].place, wanted)), 0) >= 0xF0u;
  };
  for (uint32_t off = 0; off < body.cell_count; ++off) {
    const uint32_t before = near - off, behind = near + off;  // a number below 0 wraps around to a large one
    if (before < body.cell_count && is_it(before)) return before;
    if (behind < body.cell_count && is_it(behind)) return behind;
  }
  return body.cell_count;
}

/// The largest whole numbers that are not above v.
inline vec_int4 floor_of(vec_float4 v) {
  const vec_int4 towards_zero = spu_convts(v, 0);
  return spu_add(towards_zero, (vec_int4)spu_cmpgt(spu_convtf(towards_zero, 0), v));
}

/// The field at a place of the body at rest.
/// @param at    grid index and place in the cell, in cells; x y z 0
/// @param cell  a cell near that place; becomes the cell there
/// @return      false: there is no cell, and nothing has changed
__attribute__((noinline)) inline bool field_at_place(const BodyInStore& body, vec_float4 at, uint32_t& cell,
                                                     vec_float4& field) {
  const vec_int4 grid = floor_of(at);
  const uint32_t there = cell_at(body, grid, cell);
  if (there == body.cell_count) return false;
  cell = there;
  const vec_float4 middle = spu_add(spu_convtf(grid, 0), spu_splats(0.5f));
  field = field_at(body.cells[cell].field, only_xyz(spu_sub(at, middle)));
  return true;
}

/// The field of a face as if the body had only this one and it were plane, at a place that is `way` farther.
inline vec_float4 field_farther(vec_float4 field, vec_float4 way) {
  return with_fourth(field, spu_add(field, dot_in_all_lanes(only_xyz(field), way)));
}

/// Follows a line through a body at rest to the face that it meets. Returns this face's field at the line's beginning. Steps are a little
/// shorter than the distance to the surface, so they stay within the lattice.
/// @param begin, cell  the place and its cell  @param field  the field there
/// @param direction    of unit length, in cells; x y z 0
/// @return             `field` itself: the line meets no face
inline vec_float4 field_of_met_face(const BodyInStore& body, vec_float4 begin, uint32_t cell,
                                    vec_float4 field, vec_float4 direction) {
  constexpr int kMostSteps = 16;
  vec_float4 way = spu_splats(0.0f), here = field;
  for (int step = 0; spu_extract(here, 3) < -kFindDeep; ++step) {
    if (step == kMostSteps) return field;
    way = spu_nmsub(spu_add(splat_lane<3>(here), spu_splats(kFindDeep / 2)), direction, way);
    if (!field_at_place(body, spu_add(begin, way), cell, here)) return field;
  }
  return field_farther(here, negative(way));
}

/// A point's way through a body at rest.
struct WayAtRest {
  vec_float4 begin, way;  ///< in cells; x y z 0
  uint32_t cell;          ///< at the end
  float deep;             ///< cells
};

/// Follows the way to where the point gets deep. The field, at the way's end, of the face that is nearest there.
/// @param nearest  the field at the end  @return  `nearest`: it gets deep only at the very end
inline vec_float4 field_of_entered_face(const BodyInStore& body, const WayAtRest& way, vec_float4 nearest) {
  constexpr int kHalvings = 3;
  uint32_t cell = way.cell;
  float outside = 0.0f, inside = 1.0f;
  vec_float4 entered = nearest, here;
  for (int i = 0; i < kHalvings; ++i) {
    const float middle = 0.5f * (outside + inside);
    const vec_float4 at = spu_madd(spu_splats(middle), way.way, way.begin);
    if (field_at_place(body, at, cell, here) && spu_extract(here, 3) < -way.deep) {
      inside = middle;
      entered = field_farther(here, spu_mul(spu_splats(1.0f - middle), way.way));
    } else {
      outside = middle;
    }
  }
  return entered;
}

}  // namespace softcell::spu
