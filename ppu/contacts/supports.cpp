#include "ppu/contacts/supports.h"

#include <algorithm>
#include <utility>

#include "ppu/numbers/sorted_lists.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

constexpr std::size_t kMostTogether =
    6;  // bodies; of larger heaps each is solved as if the others were walls

}  // namespace

void Supports::hold(std::span<ContactRigid> rigids, std::span<const RigidTouch> touches,
                    std::span<const Press> presses, float step) {
  SC_ASSERT(step > 0, "a substep of {} s", step);
  count_ = 0;
  if (touches.empty() || presses.empty()) return;
  const auto for_each_side = [&](std::size_t touch, const auto& work) {
    work(touches[touch].a);
    work(touches[touch].b);
  };
  sort_into_lists(rigids.size(), touches.size(), for_each_side, first_, touch_);
  const auto moves = [&](std::uint32_t rigid) { return rigids[rigid].inverse_mass > 0; };
  together_.reset(rigids.size());
  for (const RigidTouch& touch : touches)
    if (moves(touch.a) && moves(touch.b)) together_.unite(touch.a, touch.b);
  pressed_.clear();
  for (const Press& press : presses) pressed_.push_back(press.rigid);
  std::ranges::sort(pressed_, {},
                    [&](std::uint32_t rigid) { return std::pair(together_.find(rigid), rigid); });
  pressed_.erase(std::unique(pressed_.begin(), pressed_.end()), pressed_.end());
  for (std::size_t first = 0, end = 0; first < pressed_.size(); first = end) {
    const std::uint32_t name = together_.find(pressed_[first]);
    while (end < pressed_.size() && together_.find(pressed_[end]) == name) ++end;
    set_.clear();
    for (std::uint32_t rigid = name; rigid < rigids.size(); ++rigid)
      if (moves(rigid) && together_.find(rigid) == name) set_.push_back(rigid);
    if (set_.size() <= kMostTogether)
      look_at(set_, false, rigids, touches, presses, step);
    else
      for (std::size_t i = first; i < end; ++i)
        look_at(std::span(pressed_).subspan(i, 1), true, rigids, touches, presses, step);
  }
}

void Supports::look_at(std::span<const std::uint32_t> set, bool alone, std::span<ContactRigid> rigids,
                       std::span<const RigidTouch> touches, std::span<const Press> presses, float step) {
  if (count_ == sets_.size()) sets_.emplace_back();
  SupportedSet& looked_at = sets_[count_];
  looked_at.begin(rigids, set);
  for (const std::uint32_t rigid : set) {
    for (std::uint32_t i = first_[rigid]; i < first_[rigid + 1]; ++i) {
      const RigidTouch& touch = touches[touch_[i]];
      const std::uint32_t other = touch.a == rigid ? touch.b : touch.a;
      const bool is_member = rigids[other].inverse_mass > 0;
      // That of two members comes once.
      if (!is_member || (!alone && other > rigid)) looked_at.add(touch, step);
    }
  }
  if (looked_at.hold(presses, step)) ++count_;
}

void Supports::add_impulse(std::uint32_t rigid, const Eigen::Vector3f& point,
                           const Eigen::Vector3f& impulse) {
  for (SupportedSet& set : std::span(sets_).first(count_)) set.add_impulse(rigid, point, impulse);
}

void Supports::release() {
  const std::span<SupportedSet> sets = std::span(sets_).first(count_);
  for (SupportedSet& set : sets) set.give_impulses();
  for (SupportedSet& set : sets) set.give_support();
}

}  // namespace softcell::ppu
