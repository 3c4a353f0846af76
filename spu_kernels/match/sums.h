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
  static_assert(kRows == 2 || kRows == 3, "a slot has three rows");
  for (;;) {
    const uint32_t terms = list[0];
    if (terms == 0) return;
    const uint32_t steps = list[1];
    list += 2;

    const Slot& first = slot_at(in, list[0]);
    vec_float4 sum0 = first.row[0], sum1 = first.row[1], sum2 = first.row[kRows - 1];
    for (uint32_t i = 1; i < terms; ++i) {
      const Slot& term = slot_at(in, list[i]);
      sum0 = spu_add(sum0, term.row[0]);
      sum1 = spu_add(sum1, term.row[1]);
      if (kRows > 2) sum2 = spu_add(sum2, term.row[2]);
    }
    list += terms;
    const auto store = [&]() __attribute__((always_inline)) {
      ++out;
      out->row[0] = sum0;
      out->row[1] = sum1;
      if (kRows > 2) out->row[2] = sum2;
    };
    store();

    const uint16_t* const end = list + 2 * steps;
    for (; list != end; list += 2) {
      const Slot &joins = slot_at(in, list[0]), &leaves = slot_at(in, list[1]);
      sum0 = spu_add(sum0, spu_sub(joins.row[0], leaves.row[0]));
      sum1 = spu_add(sum1, spu_sub(joins.row[1], leaves.row[1]));
      if (kRows > 2) sum2 = spu_add(sum2, spu_sub(joins.row[2], leaves.row[2]));
      store();
    }
  }
}

}  // namespace softcell::spu
