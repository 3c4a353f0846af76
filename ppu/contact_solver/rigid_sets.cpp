#include "ppu/contact_solver/rigid_sets.h"

#include <algorithm>

#include "softcell/base/assert.h"

namespace softcell::ppu {

using Eigen::Vector3f;

namespace {

void write_columns(const Eigen::Matrix3f& matrix, float (&columns)[3][4]) {
  for (int column = 0; column < 3; ++column) Vector3f::Map(columns[column]) = matrix.col(column);
}

void write_mobility(const ContactRigid& rigid, spu::SolveRigid& solved) {
  if (!rigid.held) {
    solved.inverse_mass = rigid.inverse_mass;
    return write_columns(rigid.inverse_inertia, solved.inverse_inertia);
  }
  solved.held = 1;
  write_columns(rigid.held->linear, solved.linear);
  write_columns(rigid.held->coupling, solved.coupling);
  write_columns(rigid.held->coupling.transpose(), solved.coupled);
  write_columns(rigid.held->angular, solved.inverse_inertia);
}

}  // namespace

void RigidSets::begin(std::span<ContactRigid> rigids) {
  rigids_ = rigids;
  together_.reset(rigids.size());
  named_.assign(rigids.size(), false);
  set_of_.assign(rigids.size(), kNone);
  number_in_.assign(rigids.size(), 0);
  sets_.clear();
  members_.clear();
  solved_ = {};
}

void RigidSets::join(std::uint32_t rigid, std::uint32_t other) {
  SC_ASSERT(rigids_[rigid].inverse_mass > 0 && rigids_[other].inverse_mass > 0,
            "nothing moves rigid body {} or {}", rigid, other);
  named_[rigid] = named_[other] = true;
  together_.unite(rigid, other);
}

/// Sorts sets by their first members, and members by their numbers.
void RigidSets::arrange(ContactWorker& worker) {
  const auto count = static_cast<std::uint32_t>(rigids_.size());
  for (std::uint32_t i = 0; i < count; ++i)
    if (named_[i]) ++number_in_[together_.find(i)];  // at a set's first member: the number of members
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!named_[i]) continue;
    const std::uint32_t first = together_.find(i);
    if (first == i && number_in_[i] <= kMost) {
      set_of_[i] = sets();
      const std::uint32_t begin = sets_.empty() ? 0 : sets_.back().first + sets_.back().count;
      sets_.push_back({.first = begin, .count = number_in_[i]});
    }
    set_of_[i] = set_of_[first];
  }
  if (sets_.empty()) return;
  members_.resize(sets_.back().first + std::size_t{sets_.back().count});
  solved_ = worker.rigid_room(members_.size() + sets_.size());
  std::fill(solved_.begin(), solved_.end(), spu::SolveRigid{});
  for (Set& set : sets_) set.count = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    if (set_of_[i] == kNone) continue;
    Set& set = sets_[set_of_[i]];
    number_in_[i] = set.count++;
    spu::SolveRigid& solved = solved_[set.first + set_of_[i] + number_in_[i]];
    write_mobility(rigids_[i], solved);
    members_[set.first + number_in_[i]] = {i, rigids_[i].velocity, rigids_[i].spin, &solved};
  }
}

std::uint16_t RigidSets::number_in(std::uint32_t set, std::uint32_t rigid) const {
  const bool moves = rigids_[rigid].inverse_mass > 0;
  SC_ASSERT(!moves || set_of_[rigid] == set, "rigid body {} is in set {}, not in {}", rigid, set_of_[rigid],
            set);
  return static_cast<std::uint16_t>(moves ? number_in_[rigid] : sets_[set].count);
}

std::span<spu::SolveRigid> RigidSets::of(std::uint32_t set) const {
  return solved_.subspan(sets_[set].first + std::size_t{set}, sets_[set].count + std::size_t{1});
}

void RigidSets::put() const {
  for (const Member& member : members_) {
    const ContactRigid& rigid = rigids_[member.rigid];
    Vector3f::Map(member.solved->velocity) = rigid.velocity - member.velocity;
    Vector3f::Map(member.solved->spin) = rigid.spin - member.spin;
  }
}

void RigidSets::take() const {
  for (const Member& member : members_) {
    ContactRigid& rigid = rigids_[member.rigid];
    rigid.velocity = member.velocity + Vector3f::Map(member.solved->velocity);
    rigid.spin = member.spin + Vector3f::Map(member.solved->spin);
  }
}

}  // namespace softcell::ppu
