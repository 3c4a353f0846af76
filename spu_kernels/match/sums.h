#pragma once
// Sums of slots by a sum list: from particles to bars, bars to plates, plates to regions.  [LSM07]
//
// Along a row, neighbouring bars differ by one particle that joins and one that leaves. A chain adds the
// difference of the two, so a sum costs the same for every half-width. The lists say where a chain starts
// anew: rounding errors do not pile up along a body.

#include <spu_intrinsics.h>
#include <stdint.h>

#include "match/local_store.h"

namespace softcell::spu {

/// out[1], out[2], ... by `list`, which match_job.h explains. Of each slot the first `kRows` rows.
template <int kRows>
__attribute__((noinline)) void sum_slots(const uint16_t* list, const Slot* in, Slot* out) {
  const vec_float4* const from = in->row;
  vec_float4* to = out[1].row;
  for (;;) {
    const uint32_t terms = list[0];
    if (terms == 0) return;
    uint32_t steps = list[1];
    list += 2;

    const vec_float4* term = from + list[0];
    vec_float4 sum0 = term[0], sum1 = term[1], sum2 = kRows > 2 ? term[2] : sum0;
    for (uint32_t i = 1; i < terms; ++i) {
      term = from + list[i];
      sum0 = spu_add(sum0, term[0]);
      sum1 = spu_add(sum1, term[1]);
      if (kRows > 2) sum2 = spu_add(sum2, term[2]);
    }
    list += terms;
    to[0] = sum0;
    to[1] = sum1;
    if (kRows > 2) to[2] = sum2;
    to += kMatchQuadwordsPerSlot;

    for (; steps != 0; --steps) {
      const vec_float4* const joins = from + list[0];
      const vec_float4* const leaves = from + list[1];
      list += 2;
      sum0 = spu_add(sum0, spu_sub(joins[0], leaves[0]));
      sum1 = spu_add(sum1, spu_sub(joins[1], leaves[1]));
      if (kRows > 2) sum2 = spu_add(sum2, spu_sub(joins[2], leaves[2]));
      to[0] = sum0;
      to[1] = sum1;
      if (kRows > 2) to[2] = sum2;
      to += kMatchQuadwordsPerSlot;
    }
  }
}

}  // namespace softcell::spu
