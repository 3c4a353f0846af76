#include "ppu/plans/sum_list.h"
#include "softcell/base/assert.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace softcell::ppu {

namespace {

/// Rounds down, also below zero.
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
  SC_ASSERT(restart > 0, "sums start anew at multiples of {}", restart);
  SumLevel level;
  for (std::size_t i = 0; i < sums.size(); ++i) {
    level.terms.push(sums[i].terms);
    level.rules.push_back(i == 0 ? SumLevel::Rule{} : rule_of(sums[i - 1], sums[i], restart));
  }
  return level;
}

void SumListWriter::begin(std::span<const std::uint16_t> terms) {
  end_chain();
  in_run_ = false;
  terms_.assign(terms.begin(), terms.end());
  if (terms_.empty()) terms_.push_back(0);
}

void SumListWriter::go_on(std::uint16_t before, std::uint16_t joins, std::uint16_t leaves) {
  end_chain();
  if (!in_run_) {
    run_at_ = list_.halfwords.size();
    push(spu::kSumRun);
  }
  in_run_ = true;
  ++list_.halfwords[run_at_];
  for (const std::uint16_t offset : {before, joins, leaves}) push(offset);
  list_.additions += 2;
}

/// Splits a chain into its longest beginning in which nothing leaves, its longest end in which nothing joins, and the rest, which has both,
/// or a slot that adds nothing.
void SumListWriter::end_chain() {
  if (terms_.empty()) return;
  const auto grown = std::ranges::find_if(steps_, [](const Step& step) { return step.leaves != 0; });
  const auto slid = std::find_if(steps_.rbegin(), std::make_reverse_iterator(grown), [](const Step& step) {
                      return step.joins != 0;
                    }).base();
  push(terms_.size());
  push(static_cast<std::size_t>(grown - steps_.begin()));
  push(static_cast<std::size_t>(slid - grown));
  push(static_cast<std::size_t>(steps_.end() - slid));
  for (const std::uint16_t offset : terms_) push(offset);
  std::for_each(steps_.begin(), grown, [&](const Step& step) { push(step.joins); });
  std::for_each(grown, slid, [&](const Step& step) {
    push(step.joins);
    push(step.leaves);
  });
  std::for_each(slid, steps_.end(), [&](const Step& step) { push(step.leaves); });
  list_.additions += terms_.size() - 1 + steps_.size() + static_cast<std::size_t>(slid - grown);
  terms_.clear();
  steps_.clear();
}

SumList SumListWriter::finish() {
  SC_ASSERT(steps_.empty() || follows_chain(), "{} steps of no chain", steps_.size());
  end_chain();
  push(0);
  return std::move(list_);
}

SumList write_sum_list(const SumLevel& level, std::uint32_t slot_bytes) {
  SC_ASSERT(slot_bytes > 0 && slot_bytes % spu::kSumOffsetUnit == 0, "slots of {} bytes", slot_bytes);
  const auto offset = [&](std::uint32_t slot) {
    SC_ASSERT(slot <= SumListFormat({slot_bytes, 1}).max_slot(), "slot {} of {} bytes has no offset", slot,
              slot_bytes);
    return sum_list_offset(slot, slot_bytes);
  };
  SC_ASSERT(level.rules.size() == level.size(), "{} rules for {} sums", level.rules.size(), level.size());
  SumListWriter writer;
  std::vector<std::uint16_t> terms;
  for (std::size_t i = 0; i < level.size(); ++i) {
    const SumLevel::Rule& rule = level.rules[i];
    if (rule.follows) {
      writer.follow(offset(rule.joins), offset(rule.leaves));
      continue;
    }
    terms.clear();
    for (const std::uint32_t slot : level.terms[i]) terms.push_back(offset(slot));
    writer.begin(terms);
  }
  return writer.finish();
}

}  // namespace softcell::ppu
