#include "ppu/supports/supports.h"

#include <algorithm>
#include <tuple>

#include "ppu/numbers/keep_each_once.h"
#include "ppu/numbers/sorted_lists.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

// A part is a body with all bodies joined to it, up to so many; larger assemblies are split into single bodies.
constexpr std::size_t kMostJoined = 64;
// Parts in a set; in larger heaps each part is solved as if only static bodies touched it.
constexpr std::size_t kMostTogether = 6;

}  // namespace

void Supports::hold(std::span<ContactRigid> rigids, const RigidLinks& links, std::span<const Press> presses,
                    float step) {
  SC_ASSERT(step > 0, "a substep of {} s", step);
  count_ = 0;
  if (links.empty() || presses.empty()) return;
  find_parts(rigids, links);
  pressed_.clear();
  for (const Press& press : presses) pressed_.push_back(press.rigid);
  const auto place = [&](std::uint32_t rigid) {
    return std::tuple(together_.find(rigid), part_of_[rigid], rigid);
  };
  keep_each_once(pressed_, [&](std::uint32_t a, std::uint32_t b) { return place(a) < place(b); });
  for (std::size_t i = 0; i < pressed_.size();) {
    const std::uint32_t heap = together_.find(pressed_[i]), part = part_of_[pressed_[i]];
    set_.clear();
    std::size_t parts = 0;
    for (std::uint32_t rigid = 0; rigid < rigids.size(); ++rigid) {
      if (rigids[rigid].inverse_mass == 0 || together_.find(rigid) != heap) continue;
      set_.push_back(rigid);
      if (part_of_[rigid] == rigid) ++parts;
    }
    const bool alone = parts > kMostTogether;
    if (alone) std::erase_if(set_, [&](std::uint32_t rigid) { return part_of_[rigid] != part; });
    look_at(rigids, links, presses, step);
    while (i < pressed_.size() &&
           (alone ? part_of_[pressed_[i]] == part : together_.find(pressed_[i]) == heap))
      ++i;
  }
}

/// Finds the part of each body, named by its lowest index, and the parts that touch.
void Supports::find_parts(std::span<const ContactRigid> rigids, const RigidLinks& links) {
  const auto moves = [&](std::uint32_t rigid) {
    return rigid != JointRow::kWorld && rigids[rigid].inverse_mass > 0;
  };
  const auto sort_links = [&](const auto& of, OfRigid& sorted) {
    const auto for_each_side = [&](std::size_t link, const auto& work) {
      for (const std::uint32_t rigid : {of[link].a, of[link].b})
        if (moves(rigid)) work(rigid);
    };
    sort_into_lists(rigids.size(), of.size(), for_each_side, sorted.first, sorted.links);
  };
  sort_links(links.touches, touches_);
  sort_links(links.joints, joints_);
  together_.reset(rigids.size());
  for (const JointRow& joint : links.joints)
    if (moves(joint.a) && moves(joint.b)) together_.unite(joint.a, joint.b);
  part_of_.resize(rigids.size());
  joined_.assign(rigids.size(), 0);
  for (std::uint32_t rigid = 0; rigid < rigids.size(); ++rigid) ++joined_[together_.find(rigid)];
  for (std::uint32_t rigid = 0; rigid < rigids.size(); ++rigid) {
    const std::uint32_t part = together_.find(rigid);
    part_of_[rigid] = joined_[part] > kMostJoined ? rigid : part;
  }
  together_.reset(rigids.size());
  for (std::uint32_t rigid = 0; rigid < rigids.size(); ++rigid) together_.unite(rigid, part_of_[rigid]);
  for (const RigidTouch& touch : links.touches)
    if (moves(touch.a) && moves(touch.b)) together_.unite(touch.a, touch.b);
}

void Supports::look_at(std::span<ContactRigid> rigids, const RigidLinks& links,
                       std::span<const Press> presses, float step) {
  if (count_ == sets_.size()) sets_.emplace_back();
  SupportedSet& looked_at = sets_[count_];
  looked_at.begin(rigids, set_);
  // A link between two members is added once. A link to a moving body that is no member is left out.
  const auto counts = [&](std::uint32_t rigid, const auto& link) {
    const std::uint32_t other = link.a == rigid ? link.b : link.a;
    if (other == JointRow::kWorld || rigids[other].inverse_mass == 0) return true;
    return other < rigid && std::ranges::binary_search(set_, other);
  };
  for (const std::uint32_t rigid : set_) {
    for (const std::uint32_t i : joints_.of(rigid))
      if (counts(rigid, links.joints[i])) looked_at.add(links.joints[i]);
    for (const std::uint32_t i : touches_.of(rigid))
      if (counts(rigid, links.touches[i])) looked_at.add(links.touches[i], step);
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
