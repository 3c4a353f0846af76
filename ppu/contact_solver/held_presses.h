#pragma once
// Rigid bodies that press on particles which attachments hold.
//
// Such a rigid body feels what holds the particles, however light they are: contacts leave out the particles' masses
// (ContactBody::inverse_masses_if_held). An attachment that cannot stop the rigid body breaks. If it were felt all the same, the particles
// would keep the impulse that it does not carry (docs/notes/performance.md).

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/attachments/attachments.h"
#include "ppu/contact_solver/contact_groups.h"
#include "ppu/contacts/contact_body.h"
#include "ppu/obstacles/contact_rigid.h"

namespace softcell::ppu {

/// Used by one thread; keeps allocated memory.
class HeldPresses {
 public:
  /// Finds the particles that rigid bodies cannot push away, however heavy these are, and holds them (ContactBody::hold()). Otherwise each
  /// round would give way by no more than the particles' own masses resist.
  void hold(std::span<ContactBody> bodies, AttachmentSolver<3>& attachments,
            std::span<const ContactRigid> rigids, float step);

  /// Finds out which groups feel what holds the particles that rigid bodies press on, and sets SoftContact::on_held of their contacts. Call
  /// it after hold(), and after rigid bodies are held by their supports.
  /// @param groups  those with rigid bodies, SoftContact::on_held set for each contact of a moving one with held particles
  void choose(std::span<ContactGroup> groups, std::span<const ContactBody> bodies,
              AttachmentSolver<3>& attachments, std::span<const ContactRigid> rigids);

 private:
  /// A rigid body that presses on held particles at some points.
  struct Press {
    std::uint32_t rigid = 0;  ///< index
    int contacts = 0;
    int contacts_of_body = 0;                           ///< how many of them with one soft body
    Eigen::Vector3f points{0, 0, 0}, normals{0, 0, 0};  ///< sums
    /// kg m/s: that body's share of one impulse in the middle of the points.
    float impulse_to_stop(const ContactRigid& by, const Eigen::Vector3f& held_velocity) const;
  };
  Press& press_of(std::uint32_t rigid);
  void add_presses(const ContactGroup& group);
  bool breaks_what_holds(const ContactGroup& group, const ContactBody& body, AttachmentSolver<3>& attachments,
                         std::span<const ContactRigid> rigids);
  void press_on(AttachmentSolver<3>& attachments, std::uint32_t body, const Anchor& anchor,
                float impulse) const;

  std::vector<HeldParticle<3>> held_;  // ascending by body and particle
  std::vector<Press> presses_;
};

}  // namespace softcell::ppu
