#pragma once
// The roles of two bodies in a search: one has the points, the other one the cells.

#include <spu_intrinsics.h>

#include "contact_find/local_store.h"

namespace softcell::spu {
namespace {  // a part of contact_find.cpp, which alone includes it

/// Whether two cells of one body are too near each other at rest to touch.
bool belong_together(const CellAtRest& a, const CellAtRest& b) {
  int32_t square = 0;
  for (int d = 0; d < 3; ++d) {
    const int32_t off = spu_extract(a.place, d) - spu_extract(b.place, d);
    square += off * off;
  }
  return square <= kFindApart * kFindApart;
}

/// The roles of two bodies in a search: one has the points, the other one the cells.
struct Sides {
  const BodyInStore& mine;
  const BodyInStore& other;
  bool swap;  // contacts are as seen from `other`
  float least_volume;
  vec_float4 per_spacing;  // 1 / spacing of the other body

  Sides(const BodyInStore& my, const BodyInStore& its, bool seen_from_other)
      : mine(my),
        other(its),
        swap(seen_from_other),
        least_volume(0x1.0624dep-10f * its.spacing * its.spacing * its.spacing),  // 1e-3
        per_spacing(reciprocal(spu_splats(its.spacing))) {}
};

}  // namespace
}  // namespace softcell::spu
