#include "sum_list.h"

#include <algorithm>
#include <iterator>
#include <optional>

namespace softcell::ppu {

namespace {

struct Step {
  std::uint32_t joins = 0, leaves = 0;  // slots; 0 for none
};

std::optional<Step> step_between(const Sum& before, const Sum& after) {
  std::vector<std::uint32_t> joins, leaves;
  std::ranges::set_difference(after.terms, before.terms, std::back_inserter(joins));
  std::ranges::set_difference(before.terms, after.terms, std::back_inserter(leaves));
  if (joins.size() > 1 || leaves.size() > 1) return std::nullopt;
  return Step{joins.empty() ? 0 : joins[0], leaves.empty() ? 0 : leaves[0]};
}

/// Rounds down, below zero too.
int block_of(int place, int restart) { return (place - (place % restart + restart) % restart) / restart; }

std::optional<Step> step_to_next(const std::vector<Sum>& sums, std::size_t i, int restart) {
  if (i + 1 == sums.size()) return std::nullopt;
  const Sum &before = sums[i], &after = sums[i + 1];
  if (before.row != after.row || block_of(before.place, restart) != block_of(after.place, restart))
    return std::nullopt;
  return step_between(before, after);
}

}  // namespace

SumList write_sum_list(const std::vector<Sum>& sums, const SumListFormat& format) {
  const auto offset_of = [&](std::uint32_t slot) {
    return static_cast<std::uint16_t>(slot * (format.slot_bytes / spu::kSumOffsetUnit));
  };
  SumList list;
  std::vector<std::uint16_t>& out = list.halfwords;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const std::vector<std::uint32_t>& terms = sums[i].terms;
    out.push_back(static_cast<std::uint16_t>(terms.size()));
    const std::size_t steps_at = out.size();
    out.push_back(0);
    for (const std::uint32_t slot : terms) out.push_back(offset_of(slot));
    list.additions += terms.size() - 1;
    while (const std::optional<Step> step = step_to_next(sums, i, format.restart)) {
      out.push_back(offset_of(step->joins));
      out.push_back(offset_of(step->leaves));
      ++out[steps_at];
      list.additions += 2;
      ++i;
    }
  }
  out.push_back(0);
  return list;
}

}  // namespace softcell::ppu
