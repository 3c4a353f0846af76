#include "ppu/spe_bodies/candidate_pairs.h"

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

// In cells. A wide margin lasts longer, a narrow one has fewer candidates.
constexpr float kMargin = 0.25f;
// Candidates that would not last for this many steps are not kept.
constexpr double kLeastSteps = 2;
// As a share of the margin: kept for rounding, and for points that count as in a cell although they are a little outside of it.
constexpr double kSpare = 0.05;

}  // namespace

void CandidatePairs::clear(std::size_t bodies) {
  ways_.assign(bodies, Way{});
  known_.clear();
  before_.clear();
  free_slots_.clear();
  next_before_ = slots_ = 0;
}

void CandidatePairs::add_way(std::uint32_t body, const Eigen::Vector3f& low, const Eigen::Vector3f& high) {
  SC_ASSERT(body < ways_.size(), "the way of body {} of {}", body, ways_.size());
  Way& way = ways_[body];
  way.last = 0.5 * (low + high).cast<double>();
  way.last_length = 0.5 * (high - low).cast<double>().norm();
  way.vector += way.last;
  way.length += way.last_length;
}

void CandidatePairs::begin_step() {
  known_.swap(before_);
  known_.clear();
  next_before_ = 0;
}

CandidatePairs::Known& CandidatePairs::of(const Pair& pair, float spacing) {
  SC_ASSERT(known_.empty() || known_.back().pair < pair, "pairs out of order, {} and {}", pair.first,
            pair.second);
  for (; next_before_ < before_.size() && before_[next_before_].pair < pair; ++next_before_)
    free_slots_.push_back(before_[next_before_].slot);
  const Way &a = ways_[pair.first], &b = ways_[pair.second];
  const Eigen::Vector3d apart = b.vector - a.vector;
  const double spread = a.length + b.length;
  Known known;
  if (next_before_ < before_.size() && before_[next_before_].pair == pair) {
    known = before_[next_before_++];
    const double moved = (apart - known.apart).norm() + (spread - known.spread);
    if (known.count != spu::kFindUnknown && moved <= (1 - kSpare) * static_cast<double>(known.margin))
      return known_.emplace_back(known);
  } else {
    known.pair = pair;
    if (free_slots_.empty()) {
      free_slots_.push_back(static_cast<std::uint32_t>(slots_++));
      // Reserves room now, so that a step in which pairs part allocates nothing.
      if (free_slots_.capacity() < slots_) free_slots_.reserve(2 * slots_);
    }
    known.slot = free_slots_.back();
    free_slots_.pop_back();
  }
  known.count = spu::kFindUnknown;
  known.apart = apart;
  known.spread = spread;
  const double speed = (b.last - a.last).norm() + a.last_length + b.last_length;  // metres a step
  const float margin = kMargin * spacing;
  known.margin = kLeastSteps * speed < static_cast<double>(margin) ? margin : 0.0f;
  return known_.emplace_back(known);
}

void CandidatePairs::end_step() {
  for (; next_before_ < before_.size(); ++next_before_) free_slots_.push_back(before_[next_before_].slot);
}

}  // namespace softcell::ppu
