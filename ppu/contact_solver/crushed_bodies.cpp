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

void CrushedBodies::hold_pushes(std::span<ContactGroup> groups, std::span<const ContactBody> bodies) const {
  for (ContactGroup& group : groups) {
    if (!is_crushed_[group.a] && !is_crushed_[group.b]) continue;
    const ContactBody& a = bodies[group.a];
    const ContactBody& b = bodies[group.b];
    for (SoftContact& contact : group.contacts) ppu::hold_pushes(contact, a, group.with_rigid ? nullptr : &b);
    if (!group.by_worker) continue;
    for (spu::SolveContact& contact : group.solved.contacts) ppu::hold_pushes(contact, a, b);
    group.solved.pushes = true;
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
