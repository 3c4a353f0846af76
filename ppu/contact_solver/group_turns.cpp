#include "ppu/contact_solver/group_turns.h"

namespace softcell::ppu {

void GroupTurns::weigh(std::span<ContactGroup> with_rigid, std::span<const ContactBody> bodies,
                       std::span<const ContactRigid> rigids) {
  // As a share of the soft bodies' mass. In one iteration, a lighter rigid body passes on little of one soft body's impulse to another.
  constexpr float kLight = 0.2f;
  touched_rigids_.assign(rigids.size(), {});
  for (std::size_t i = 0; i < with_rigid.size(); ++i) {
    const float mass = bodies[with_rigid[i].a].model->mass();
    for (const SoftContact& contact : with_rigid[i].contacts) {
      if (rigids[contact.rigid].inverse_mass == 0) continue;
      TouchedRigid& touched = touched_rigids_[contact.rigid];
      if (touched.first == TouchedRigid::kNobody)
        touched = {.first = i, .by_several = false, .lightest = mass};
      if (touched.first != i) touched.by_several = true;
      touched.lightest = std::min(touched.lightest, mass);
    }
  }
  for (ContactGroup& group : with_rigid) {
    for (const SoftContact& contact : group.contacts) {
      const float inverse_mass = rigids[contact.rigid].inverse_mass;
      const TouchedRigid& touched = touched_rigids_[contact.rigid];
      if (inverse_mass == 0) continue;
      group.heavy = group.heavy || inverse_mass * bodies[group.a].model->mass() < 1;
      group.alternates =
          group.alternates ||
          (touched.by_several && (contact.on_held || kLight * inverse_mass * touched.lightest > 1));
    }
  }
}

}  // namespace softcell::ppu
