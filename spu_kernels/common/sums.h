#pragma once
// Makes sums of slots by a sum list (sum_list_job.h): from particles to bars, bars to plates, plates to regions.
// [LSM07]
//
// Along a row, neighbouring bars differ by one particle that joins and one that leaves. A chain adds the
// difference of the two, so a sum costs the same for every half-width. The lists say where a chain begins
// anew, so that rounding errors do not add up along a body.

#include <spu_intrinsics.h>
#include <stdint.h>

#include "common/slot_stream.h"
#include "sum_list_job.h"

namespace softcell::spu {

/// Sets a slot to zero, as slot 0 of every buffer must be.
template <typename Slot>
inline void clear(Slot& slot) {
  for (vec_float4& row : slot.row) row = spu_splats(0.0f);
}

/// The slot at an offset of a sum list.
template <typename Slot>
inline const Slot& slot_at(const Slot* slots, uint32_t offset) {
  return *reinterpret_cast<const Slot*>(reinterpret_cast<const char*>(slots) + offset * kSumOffsetUnit);
}

/// Writes out[1], out[2], ... by `list`: the first `kRows` rows of each slot, a struct of `vec_float4 row[]`.
template <int kRows, typename Slot>
__attribute__((noinline)) void sum_slots(const uint16_t* list, const Slot* in, Slot* out) {
  static_assert(kRows >= 1 && kRows <= 3, "what is unrolled below");
  const auto for_rows = [](const auto& work) __attribute__((always_inline)) {
    work(0);
    if constexpr (kRows > 1) work(1);
    if constexpr (kRows > 2) work(2);
  };
  for (;;) {
    const uint32_t terms = list[0];
    if (terms == 0) return;
    if (__builtin_expect(terms >= kSumRun, 0)) {
      const uint16_t* const end = ++list + 3 * (terms - kSumRun);
      for (; list != end; list += 3) {
        const Slot &before = slot_at(in, list[0]), &joins = slot_at(in, list[1]);
        const Slot& leaves = slot_at(in, list[2]);
        ++out;
        for_rows([&](int k) __attribute__((always_inline)) {
          out->row[k] = spu_add(before.row[k], spu_sub(joins.row[k], leaves.row[k]));
        });
      }
      continue;
    }
#ifdef __SPU__
    // The same sums in the same order, but slots are loaded ahead, because an SPU executes in order. A host's processor loads ahead itself.
    list = sum_chain_in_order<kRows>(list, in, out);
#else
    const uint32_t growing = list[1], sliding = list[2], shrinking = list[3];
    list += 4;

    vec_float4 sum[kRows];
    const Slot& first = slot_at(in, *list++);
    for_rows([&](int k) __attribute__((always_inline)) { sum[k] = first.row[k]; });
    const auto join = [&](uint32_t offset) __attribute__((always_inline)) {
      const Slot& joins = slot_at(in, offset);
      for_rows([&](int k) __attribute__((always_inline)) { sum[k] = spu_add(sum[k], joins.row[k]); });
    };
    const auto put = [&]() __attribute__((always_inline)) {
      ++out;
      for_rows([&](int k) __attribute__((always_inline)) { out->row[k] = sum[k]; });
    };
    for (const uint16_t* const end = list + (terms - 1); list != end; ++list) join(*list);
    put();
    for (const uint16_t* const end = list + growing; list != end; ++list) {
      join(*list);
      put();
    }
    for (const uint16_t* const end = list + 2 * sliding; list != end; list += 2) {
      const Slot &joins = slot_at(in, list[0]), &leaves = slot_at(in, list[1]);
      for_rows([&](int k) __attribute__((always_inline)) {
        sum[k] = spu_add(sum[k], spu_sub(joins.row[k], leaves.row[k]));
      });
      put();
    }
    for (const uint16_t* const end = list + shrinking; list != end; ++list) {
      const Slot& leaves = slot_at(in, *list);
      for_rows([&](int k) __attribute__((always_inline)) { sum[k] = spu_sub(sum[k], leaves.row[k]); });
      put();
    }
#endif
  }
}

}  // namespace softcell::spu
