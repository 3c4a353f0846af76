#include "ppu/contact_solver/hits.h"

#include <algorithm>
#include <cstddef>

#include "ppu/contacts/swept_contacts.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

}  // namespace

void Hits::add_to(Bounces& bounces, std::span<const ContactGroup> groups, std::span<const ContactBody> bodies,
                  std::span<const ContactRigid> rigids, const BounceSettings& settings, float step) const {
  for (const ContactGroup& group : groups) {
    const ContactBody &a = bodies[group.a], &b = bodies[group.b];
    if ((!settings.may_bounce(a.restitution) && !group.fast && !group.sharp) || group.is_of_one_body())
      continue;
    const auto restitution_with = [&](float other) {
      const float both = settings.restitution_of(a.restitution, other);
      return group.fast ? std::max(both, kFastRestitution) : both;
    };
    BounceContact bounce{.a = group.a};
    if (!group.with_rigid) bounce.b = group.b;
    const auto add = [&](std::uint32_t other, const Vector3f& point, const Vector3f& normal,
                         float least_velocity, float along, float friction, float restitution, float room) {
      const Pair pair{group.a, other, group.with_rigid};
      const bool bounces_off = restitution > 0 && -along > settings.least_speed &&
                               !std::binary_search(pressed_.begin(), pressed_.end(), pair);
      bounce.room = bounces_off ? BounceContact::kNoLimit : room;
      if (!bounces_off && !bounce.is_sharp()) return;
      bounce.point = point, bounce.normal = normal;
      bounce.gap = -step * least_velocity, bounce.approach = -along;
      bounce.friction = friction, bounce.restitution = std::min(restitution, 1.0f);
      bounces.add(bounce);
    };
    // Contacts with rigid bodies were found here, even if the worker will solve them.
    if (group.by_worker && !group.with_rigid) {
      for (const spu::SolveContact& contact : group.solved.contacts) {
        const Vector3f normal(contact.normal);
        add(group.b, Vector3f(contact.point), normal, contact.least_velocity,
            -normal.dot(Vector3f(contact.carried)), contact.friction, restitution_with(b.restitution),
            BounceContact::kNoLimit);
      }
      continue;
    }
    for (const SoftContact& contact : group.contacts) {
      Vector3f v = contact.a.of(a.velocities);
      if (group.with_rigid) {
        const ContactRigid& rigid = rigids[contact.rigid];
        v -= rigid.velocity_at(contact.acts_at);
        bounce.rigid = contact.rigid;
        bounce.cell = contact.a.cell;
        add(rigid.number, contact.point, contact.normal, contact.least_velocity, contact.normal.dot(v),
            contact.friction, restitution_with(contact.restitution), contact.room);
      } else {
        v -= contact.b.of(b.velocities);
        add(group.b, contact.point, contact.normal, contact.least_velocity, contact.normal.dot(v),
            contact.friction, restitution_with(b.restitution), contact.room);
      }
    }
  }
}

void Hits::remember_who_presses(std::span<const ContactGroup> groups, std::span<const ContactBody> bodies,
                                std::span<const ContactRigid> rigids, const BounceSettings& settings) {
  pressed_.clear();
  for (const ContactGroup& group : groups) {
    if (!settings.may_bounce(bodies[group.a].restitution)) continue;
    for (std::size_t c = 0; c < group.size(); ++c) {
      if (!(group.impulse(c) > 0)) continue;
      const std::uint32_t other = group.with_rigid ? rigids[group.contacts[c].rigid].number : group.b;
      const Pair pair{group.a, other, group.with_rigid};
      if (pressed_.empty() || pressed_.back() != pair) pressed_.push_back(pair);
    }
  }
  std::sort(pressed_.begin(), pressed_.end());
}

}  // namespace softcell::ppu
