#include "sum_list.h"

#include <algorithm>
#include <iterator>

namespace softcell::ppu {

namespace {

/// Rounds down, below zero too.
int block_of(int place, int restart) { return (place - (place % restart + restart) % restart) / restart; }

SumLevel::Rule rule_of(const Sum& before, const Sum& after, int restart) {
  if (before.row != after.row || block_of(before.place, restart) != block_of(after.place, restart)) return {};
  std::vector<std::uint32_t> joins, leaves;
  std::ranges::set_difference(after.terms, before.terms, std::back_inserter(joins));
  std::ranges::set_difference(before.terms, after.terms, std::back_inserter(leaves));
  if (joins.size() > 1 || leaves.size() > 1) return {};
  return {true, joins.empty() ? 0 : joins[0], leaves.empty() ? 0 : leaves[0]};
}

}  // namespace

SumLevel sum_level(const std::vector<Sum>& sums, int restart) {
  SumLevel level;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    level.terms.push(sums[i].terms);
    level.rules.push_back(i == 0 ? SumLevel::Rule{} : rule_of(sums[i - 1], sums[i], restart));
  }
  return level;
}

SumList write_sum_list(const SumLevel& level, std::uint32_t slot_bytes) {
  const auto offset = [&](std::uint32_t slot) { return sum_list_offset(slot, slot_bytes); };
  SumList list;
  std::vector<std::uint16_t>& out = list.halfwords;
  std::size_t steps_at = 0;  // of the chain under way
  for (std::size_t i = 0; i < level.size(); ++i) {
    const SumLevel::Rule& rule = level.rules[i];
    if (rule.follows) {
      out.push_back(offset(rule.joins));
      out.push_back(offset(rule.leaves));
      ++out[steps_at];
      list.additions += 2;
      continue;
    }
    const auto terms = level.terms[i];
    out.push_back(static_cast<std::uint16_t>(terms.size()));
    steps_at = out.size();
    out.push_back(0);
    for (const std::uint32_t slot : terms) out.push_back(offset(slot));
    list.additions += terms.size() - 1;
  }
  out.push_back(0);
  return list;
}

}  // namespace softcell::ppu
