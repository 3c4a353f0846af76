#pragma once
// Finds the face of another body by which a point has come in.
//
// For a point deep in a body that is pressed flat, the nearest place of the surface at rest is often at the body's rim, because the body is
// higher at rest than it is now. By that place, two bodies on each other would be pushed sideways, and into each other.
//
//      a  .--------------.
//         |       *      |      * well inside of a
//    .----+-------o------+-.    o the face of b that the path from x to * meets: x leaves b by this face
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

/// Finds a place well inside of a body near one of its cells, metres, at the step's end; x y z.
/// @return  false: the place is not in the local store
inline bool inner_place(const BodyInStore& body, uint32_t cell, vec_float4& place) {
  const vec_short8 own = body.cells[cell].place;
  const uint32_t inner = static_cast<uint32_t>(spu_extract(own, 6)) & 0xFFFFu;
  if (inner == kFindNoCell) return false;
  const uint32_t node = static_cast<uint32_t>(spu_extract(own, 7));
  place = value_of(body.cells[inner].corner, shares_at(place_of_node(node)), body.ends);
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

/// Follows a path through a body at rest to the face that it meets. Returns the field at the path's beginning, as if the body had only this
/// face and the face were plane. Steps are a little shorter than the distance to the surface, so they stay within the lattice.
/// @param s, field   of the path's beginning: its place in the cell, and the result of field_at() there
/// @param direction  of unit length, in cells; x y z 0
/// @return           `field` itself: the path meets no face
inline vec_float4 field_of_face(const BodyInStore& body, uint32_t cell, vec_float4 s, vec_float4 field,
                                vec_float4 direction) {
  constexpr int kMostSteps = 16;
  const vec_float4 half = only_xyz(spu_splats(0.5f));
  const auto grid_of = [&](uint32_t at) __attribute__((always_inline)) {
    const vec_short8 place = body.cells[at].place;
    return (vec_int4){spu_extract(place, 0), spu_extract(place, 1), spu_extract(place, 2), 0};
  };
  vec_int4 grid = grid_of(cell);
  const vec_float4 begin = spu_add(spu_convtf(grid, 0), spu_add(s, half));
  vec_float4 way = spu_splats(0.0f), here = field;
  for (int step = 0; spu_extract(here, 3) < -kFindDeep; ++step) {
    if (step == kMostSteps) return field;
    way = spu_nmsub(spu_add(splat_lane<3>(here), spu_splats(kFindDeep / 2)), direction, way);
    const vec_float4 at = spu_add(begin, way);
    const vec_int4 next = floor_of(at);
    if (spu_extract(spu_gather(spu_cmpeq(next, grid)), 0) != 15u) {
      cell = cell_at(body, next, cell);
      if (cell == body.cell_count) return field;
      grid = next;
    }
    here = field_at(body.cells[cell].field, spu_sub(spu_sub(at, spu_convtf(grid, 0)), half));
  }
  const vec_float4 back = dot_in_all_lanes(only_xyz(here), way);
  return with_fourth(here, spu_sub(here, back));
}

}  // namespace softcell::spu
