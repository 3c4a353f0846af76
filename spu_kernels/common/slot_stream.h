#pragma once
// Loads slots in the order of a chain before they are needed, for a processor that executes in order: the SPU.
//
//   stage   offset from the list      rows from the slot      sums
//           k + 2                     k + 1                   k
//
// A load takes 6 cycles, and an offset 17 more (load, rotate, multiply). Done one after the other they would take longer than all other
// work on a slot. Overlapped they cost only the issue of their instructions.  [SPU pipelines] documented

#include <spu_intrinsics.h>
#include <stdint.h>

#include "sum_list_job.h"

namespace softcell::spu {

/// Calls work(k) for each row. The loop is unrolled, so that arrays of rows become registers.
template <int kRows, typename Work>
__attribute__((always_inline)) inline void each_row(const Work& work) {
  static_assert(kRows >= 1 && kRows <= 3, "what is unrolled below");
  work(0);
  if constexpr (kRows > 1) work(1);
  if constexpr (kRows > 2) work(2);
}

/// Some compilers declare that the argument of si_from_ptr is no pointer to const.
inline qword address_of(const void* pointer) { return si_from_ptr(const_cast<void*>(pointer)); }

/// @tparam kRows  how many quadwords of each slot are loaded
template <int kRows, typename Slot>
class SlotStream {
 public:
  /// @param list  offsets, as in sum_list_job.h; at least one
  __attribute__((always_inline)) SlotStream(const uint16_t* list, uint32_t count, const Slot* slots)
      : next_(list), end_(list + count) {
    each_row<kRows>([&](int k) __attribute__((always_inline)) { base_[k] = address_of(&slots->row[k]); });
    fetch();
    scale();
    fetch();
    load();
    scale();
    fetch();
  }

  /// Calls use(k, row) for each row of the next slot.
  template <typename Use>
  __attribute__((always_inline)) void take(const Use& use) {
    each_row<kRows>([&](int k) __attribute__((always_inline)) { use(k, row_[k]); });
    load();
    scale();
    fetch();
  }

 private:
  __attribute__((always_inline)) void load() {
    each_row<kRows>([&](int k)
                        __attribute__((always_inline)) { row_[k] = (vec_float4)si_lqx(base_[k], offset_); });
  }

  /// Past the chain's end the list holds something else, so the offset becomes that of slot 0, which always exists.
  __attribute__((always_inline)) void scale() {
    offset_ = si_and(si_mpyui(in_words_, kSumOffsetUnit), there_);
  }

  __attribute__((always_inline)) void fetch() {
    in_words_ = (qword)spu_promote(*next_, 1);
    there_ = si_clgt(address_of(end_), address_of(next_));
    ++next_;
  }

  qword base_[kRows];
  vec_float4 row_[kRows];  // of the slot that take() uses next
  qword offset_;           // of the slot after that, in bytes
  qword in_words_;         // of the slot after these two, as in the list
  qword there_;            // all ones if the chain has such a slot
  const uint16_t *next_, *end_;
};

/// Makes the sums of one chain, in the same order as sum_slots() of sums.h.
/// @return  the place in the list after the chain
template <int kRows, typename Slot>
__attribute__((always_inline)) inline const uint16_t* sum_chain_in_order(const uint16_t* list, const Slot* in,
                                                                         Slot*& out) {
  const uint32_t terms = list[0], growing = list[1], sliding = list[2], shrinking = list[3];
  list += 4;
  const uint32_t count = terms + growing + 2 * sliding + shrinking;
  SlotStream<kRows, Slot> slots(list, count, in);
  Slot* to = out;
  vec_float4 sum[kRows], joining[kRows];
  const auto put = [&]() __attribute__((always_inline)) {
    ++to;
    each_row<kRows>([&](int k) __attribute__((always_inline)) { to->row[k] = sum[k]; });
  };
  const auto join = [&](int k, vec_float4 row) __attribute__((always_inline)) {
    sum[k] = spu_add(sum[k], row);
  };
  const auto leave = [&](int k, vec_float4 row) __attribute__((always_inline)) {
    sum[k] = spu_sub(sum[k], row);
  };

  slots.take([&](int k, vec_float4 row) __attribute__((always_inline)) { sum[k] = row; });
  for (uint32_t i = terms - 1; i != 0; --i) slots.take(join);
  put();
  for (uint32_t i = growing; i != 0; --i) {
    slots.take(join);
    put();
  }
  for (uint32_t i = sliding; i != 0; --i) {
    slots.take([&](int k, vec_float4 row) __attribute__((always_inline)) { joining[k] = row; });
    slots.take([&](int k, vec_float4 row)
                   __attribute__((always_inline)) { sum[k] = spu_add(sum[k], spu_sub(joining[k], row)); });
    put();
  }
  for (uint32_t i = shrinking; i != 0; --i) {
    slots.take(leave);
    put();
  }
  out = to;
  return list + count;
}

}  // namespace softcell::spu
