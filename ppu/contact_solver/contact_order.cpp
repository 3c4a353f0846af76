#include "ppu/contact_solver/contact_order.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "ppu/numbers/keep_each_once.h"

namespace softcell::ppu {
namespace {

constexpr std::uint32_t kBodiesInSlab = 6, kMostSlabs = 12;
constexpr std::uint32_t kNoStage = ~0u;

}  // namespace

void ContactOrder::cut_into_slabs(std::span<const ContactBody> bodies) {
  const auto count = static_cast<std::uint32_t>(bodies.size());
  slabs_ = std::clamp(count / kBodiesInSlab, 1u, kMostSlabs);
  slab_.assign(count, 0);
  if (slabs_ == 1) return;
  const auto middle = [&](std::uint32_t i) -> Eigen::Vector3f {
    return 0.5f * (bodies[i].box.low + bodies[i].box.high);
  };
  Eigen::Vector3f low = middle(0), high = low;
  for (std::uint32_t i = 1; i < count; ++i) {
    low = low.cwiseMin(middle(i));
    high = high.cwiseMax(middle(i));
  }
  Eigen::Index axis;
  (high - low).maxCoeff(&axis);
  places_.clear();
  for (std::uint32_t i = 0; i < count; ++i) places_.emplace_back(middle(i)[axis], i);
  std::sort(places_.begin(), places_.end());
  for (std::uint32_t i = 0; i < count; ++i)
    slab_[places_[i].second] = static_cast<std::uint32_t>(std::uint64_t{i} * slabs_ / count);
}

void ContactOrder::arrange(std::span<const ContactBody> bodies, std::span<const Pair> pairs) {
  cut_into_slabs(bodies);
  const auto unit_of = [&](std::uint32_t pair) {
    const auto [low, high] = std::minmax(slab_[pairs[pair].first], slab_[pairs[pair].second]);
    return low * slabs_ + high;
  };
  // Each pair of slabs that occurs gets the first stage in which both slabs are free.
  stage_of_.assign(std::size_t{slabs_} * slabs_, kNoStage);
  taken_.clear();
  std::vector<std::uint32_t>& units = units_;
  units.clear();
  for (std::uint32_t i = 0; i < pairs.size(); ++i) units.push_back(unit_of(i));
  // A slab with itself comes first: it has the most pairs.
  keep_each_once(units, [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(a / slabs_ != a % slabs_, a) < std::pair(b / slabs_ != b % slabs_, b);
  });
  const auto taken = [&](std::uint32_t stage, std::uint32_t slab) {
    return taken_[std::size_t{stage} * slabs_ + slab];
  };
  for (const std::uint32_t unit : units) {
    const std::uint32_t low = unit / slabs_, high = unit % slabs_;
    std::uint32_t stage = 0;
    for (;; ++stage) {
      if (std::size_t{stage} * slabs_ == taken_.size()) taken_.resize(taken_.size() + slabs_, false);
      if (!taken(stage, low) && !taken(stage, high)) break;
    }
    taken(stage, low) = taken(stage, high) = true;
    stage_of_[unit] = stage;
  }
  order_.resize(pairs.size());
  for (std::uint32_t i = 0; i < order_.size(); ++i) order_[i] = i;
  std::sort(order_.begin(), order_.end(), [&](std::uint32_t i, std::uint32_t j) {
    return std::tuple(stage_of_[unit_of(i)], unit_of(i), i) <
           std::tuple(stage_of_[unit_of(j)], unit_of(j), j);
  });
  units_.clear();
  stages_.clear();
  for (std::uint32_t i = 0; i < order_.size(); ++i) {
    const bool new_stage = i == 0 || stage_of_[unit_of(order_[i])] != stage_of_[unit_of(order_[i - 1])];
    if (new_stage) stages_.push_back(static_cast<std::uint32_t>(units_.size()));
    if (new_stage || unit_of(order_[i]) != unit_of(order_[i - 1])) units_.push_back(i);
  }
  stages_.push_back(static_cast<std::uint32_t>(units_.size()));
  units_.push_back(static_cast<std::uint32_t>(order_.size()));
}

}  // namespace softcell::ppu
