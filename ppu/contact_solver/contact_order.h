#pragma once
// Finds an order in which pairs of bodies are solved, so that many pairs can be solved at the same time.
//
// Bodies are cut into slabs along the axis along which they are spread farthest. The pairs of two slabs form a unit, solved one after the
// other. Units that share no slab can be solved at the same time and form a stage:
//
//     slab       0     1     2     3
//     stage 0   0-0   1-1   2-2   3-3
//     stage 1      0-1         2-3
//     stage 2            1-2
//
// The order depends on bodies only, not on who solves them, so the result has the same bits.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "ppu/contacts/contact_body.h"

namespace softcell::ppu {

/// Used by one thread. Allocates when there is more than ever before.
class ContactOrder {
 public:
  using Pair = std::pair<std::uint32_t, std::uint32_t>;

  /// @param pairs  of bodies, ascending; a body may be paired with itself
  void arrange(std::span<const ContactBody> bodies, std::span<const Pair> pairs);

  /// Indices of pairs, in the order in which they are solved.
  std::span<const std::uint32_t> order() const { return order_; }
  /// For each unit: index of its first pair in order(); the end is appended.
  std::span<const std::uint32_t> units() const { return units_; }
  /// For each stage: index of its first unit in units(); the end is appended.
  std::span<const std::uint32_t> stages() const { return stages_; }

 private:
  void cut_into_slabs(std::span<const ContactBody> bodies);

  std::vector<std::uint32_t> slab_;  // of each body
  std::uint32_t slabs_ = 0;
  std::vector<std::pair<float, std::uint32_t>> places_;
  std::vector<std::uint32_t> stage_of_;  // of each pair of slabs
  std::vector<bool> taken_;              // of each stage, by slab
  std::vector<std::uint32_t> order_, units_, stages_;
};

}  // namespace softcell::ppu
