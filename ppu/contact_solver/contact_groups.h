#pragma once
// The contacts of one substep, in groups that are solved together.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/contact_solver/contact_worker.h"
#include "ppu/contact_solver/rigid_sets.h"
#include "ppu/contacts/contact_group.h"

namespace softcell::ppu {

/// The contacts of a pair of bodies, as seen from a, or of one body with rigid ones.
struct ContactGroup {
  std::uint32_t a = 0, b = 0;
  bool with_rigid = false;
  bool by_worker = false;  ///< the worker solves them: they are in `solved`
  bool heavy = false;      ///< with a rigid body that is heavier than a
  /// It alternates with groups that touch the same light rigid body: one iteration each in turn.
  bool alternates = false;
  bool fast = false;     ///< the two bodies may pass through each other in the substep
  bool sharp = false;    ///< some of its contacts limit how far a moves on as a whole
  bool on_held = false;  ///< some of its contacts are SoftContact::on_held: the worker ignores that
  std::vector<SoftContact> contacts;  ///< found by this thread; those with rigid bodies always are
  FoundContacts solved;
  /// The worker's set of rigid bodies; kNone: impulses do not move the rigid bodies.
  std::uint32_t rigid_set = RigidSets::kNone;

  std::size_t size() const { return by_worker ? solved.contacts.size() : contacts.size(); }
  bool is_of_one_body() const { return !with_rigid && a == b; }
  float impulse(std::size_t contact) const {
    return by_worker ? solved.contacts[contact].impulse : contacts[contact].impulse;
  }
  /// The impulse on the soft body of a contact with a rigid one, kg m/s.
  Eigen::Vector3f whole_impulse(std::size_t contact) const {
    const SoftContact& found = contacts[contact];
    const Eigen::Vector3f friction =
        by_worker ? Eigen::Vector3f(solved.contacts[contact].friction_impulse) : found.friction_impulse;
    return impulse(contact) * found.normal + friction;
  }
  /// Calls work(contact) for each SoftContact, or for each spu::SolveContact if the worker has found and solves them.
  template <typename Work>
  void for_each_contact(const Work& work) const {
    if (by_worker)
      for (const spu::SolveContact& contact : solved.contacts) work(contact);
    else
      for (const SoftContact& contact : contacts) work(contact);
  }
};

/// Keeps allocated memory from substep to substep.
class ContactGroups {
 public:
  void clear() { count_ = pair_count_ = 0; }
  /// Appends an empty group, valid until the next call.
  ContactGroup& append(std::uint32_t a, std::uint32_t b, bool with_rigid);
  /// Removes the group that was appended last if it has no contacts.
  void drop_last_if_empty() { count_ -= groups_[count_ - 1].size() == 0; }
  /// Moves the groups of pairs, which were appended last, before those with rigid bodies. @param with_rigid  number of these
  void put_pairs_first(std::size_t with_rigid);

  std::size_t size() const { return count_; }
  bool empty() const { return count_ == 0; }
  ContactGroup& operator[](std::size_t group) { return groups_[group]; }
  const ContactGroup& operator[](std::size_t group) const { return groups_[group]; }

  std::span<ContactGroup> all() { return {groups_.data(), count_}; }
  std::span<const ContactGroup> all() const { return {groups_.data(), count_}; }
  /// Ascending by (a, b).
  std::span<ContactGroup> of_pairs() { return all().first(pair_count_); }
  std::span<const ContactGroup> of_pairs() const { return all().first(pair_count_); }
  /// Ascending by a.
  std::span<ContactGroup> with_rigid() { return all().subspan(pair_count_); }
  std::span<const ContactGroup> with_rigid() const { return all().subspan(pair_count_); }

 private:
  std::vector<ContactGroup> groups_;  // those from count_ on keep their room
  std::size_t count_ = 0;
  std::size_t pair_count_ = 0;
};

}  // namespace softcell::ppu
