#pragma once
// The records of attach_job.h as registers.

#include <spu_intrinsics.h>
#include <stdint.h>

#include "attach_job.h"

namespace softcell::spu {

struct Point {
  vec_float4 carried;  // x y z, and the mass
  vec_float4 error;    // x y z, and the mass of pushes
  vec_float4 arm;      // x y z, and the weight
  vec_float4 impulse;  // x y z, and the slot
  vec_float4 pushed;
  vec_float4 missing;
};
static_assert(sizeof(Point) == sizeof(AttachPoint), "the same bytes");

struct Row {
  vec_float4 carried;  // x y z, and the most along the rope
  vec_float4 error;    // x y z, and the mass of pushes
  vec_float4 arm;      // x y z, and the mass along the rope
  vec_float4 impulse;  // x y z, and the push of the rope
  vec_float4 along;    // x y z, and the most that pushes leave
  vec_float4 inverse[3];
};
static_assert(sizeof(Row) == sizeof(AttachRow), "the same bytes");

struct Entry {
  vec_float4 weight;  // of each row
  vec_float4 pushed;  // x y z, and the root
  vec_uint4 slot;     // and zeros
};
static_assert(sizeof(Entry) == sizeof(AttachEntry), "the same bytes");

struct Link {
  AttachKind kind;
  uint32_t points, rows, entries[2], rigid, pushes, breaks;
  vec_float4 terms;  // softness, most impulse, most pushes of the two bodies
  vec_float4 arms;   // x y z, and the inverse sum
  vec_float4 inverse_inertia[3];
  vec_float4 inverse[4];
  vec_float4 inverse_of_pushes[4];
  uint32_t broke, once, pad[2];
};
static_assert(sizeof(Link) == sizeof(AttachLink), "the same bytes");

}  // namespace softcell::spu
