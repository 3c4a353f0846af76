#include "ppu/contact_solver/contact_groups.h"

#include <algorithm>
#include <cstddef>

#include "softcell/base/assert.h"

namespace softcell::ppu {

ContactGroup& ContactGroups::append(std::uint32_t a, std::uint32_t b, bool with_rigid) {
  if (count_ == groups_.size()) groups_.emplace_back();
  ContactGroup& group = groups_[count_++];
  group.a = a, group.b = b, group.with_rigid = with_rigid;
  group.by_worker = group.heavy = group.alternates = group.fast = group.sharp = group.on_held = false;
  group.contacts.clear();
  group.solved = {};
  group.rigid_set = RigidSets::kNone;
  return group;
}

void ContactGroups::put_pairs_first(std::size_t with_rigid) {
  SC_ASSERT(with_rigid <= count_, "{} of {} groups", with_rigid, count_);
  pair_count_ = count_ - with_rigid;
  const auto begin = groups_.begin();
  std::rotate(begin, begin + std::ptrdiff_t(with_rigid), begin + std::ptrdiff_t(count_));
}

}  // namespace softcell::ppu
