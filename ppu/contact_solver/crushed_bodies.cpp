#include "ppu/contact_solver/crushed_bodies.h"

#include <algorithm>

#include "ppu/contacts/finite_bodies.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

}  // namespace

void CrushedBodies::begin(std::size_t bodies) {
  is_crushed_.assign(bodies, false);
  count_ = 0;
}

bool CrushedBodies::hold(std::uint32_t number, ContactBody& body, float step) {
  const bool velocities_changed = cells_.hold(body, step);
  is_crushed_[number] = cells_.count() > 0;
  if (!velocities_changed && !is_crushed_[number]) return false;
  if (count_ == crushed_.size()) crushed_.emplace_back();
  Crushed& crushed = crushed_[count_++];
  crushed.body = number;
  crushed.moment = cells_.moment();
  crushed.pushes.assign(body.pushes.begin(), body.pushes.end());
  return velocities_changed;
}

void CrushedBodies::hold_pushes(std::span<ContactGroup> groups) const {
  for (ContactGroup& group : groups) {
    if (!is_crushed_[group.a] && !is_crushed_[group.b]) continue;
    for (SoftContact& contact : group.contacts) contact.holds_pushes = true;
    if (!group.by_worker) continue;
    for (spu::SolveContact& contact : group.solved.contacts) ppu::hold_pushes(contact);
    group.solved.pushes = true;
  }
}

void CrushedBodies::hold_pushes_by_friction(std::span<const ContactGroup> groups,
                                            std::span<ContactBody> bodies,
                                            std::span<const ContactRigid> rigids) const {
  constexpr int kIterations = 3;
  for (const ContactGroup& group : groups) {
    if (!is_crushed_[group.a]) continue;
    ContactBody& body = bodies[group.a];
    for (int i = 0; i < kIterations; ++i)
      for (std::size_t c = 0; c < group.contacts.size(); ++c) {
        const SoftContact& contact = group.contacts[c];
        if (rigids[contact.rigid].inverse_mass != 0) continue;
        const Vector3f impulse = group.whole_impulse(c);
        const float pressing = group.impulse(c);
        const float left = contact.friction * pressing - (impulse - pressing * contact.normal).norm();
        const Vector3f push = contact.a.of(body.pushes);
        const Vector3f along = push - contact.normal.dot(push) * contact.normal;
        const float speed = along.norm(), mobility = contact.a.mobility(body.inverse_masses);
        if (left <= 0 || speed == 0) continue;
        contact.a.add(body.pushes, body.inverse_masses, -std::min(1 / mobility, left / speed) * along);
      }
  }
}

void CrushedBodies::add_lost_spin(LostSpin& lost, std::span<const ContactBody> bodies,
                                  const std::vector<bool>& is_free, float step) const {
  for (const Crushed& crushed : std::span(crushed_).first(count_)) {
    if (!is_free[crushed.body]) continue;
    const ContactBody& body = bodies[crushed.body];
    Vector3d given = crushed.moment;
    for (std::size_t p = 0; p < crushed.pushes.size();
         ++p) {  // they move particles together with their momenta
      const Vector3d moved = double{step} * crushed.pushes[p].cast<double>();
      given += double{body.model->masses()[p]} * moved.cross(body.velocities[p].cast<double>());
    }
    if (!given.allFinite()) refuse_to_be_infinite();
    lost.add(bodies, crushed.body, crushed.body, given);
  }
}

}  // namespace softcell::ppu
