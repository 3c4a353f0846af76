#include "ppu/contact_solver/held_presses.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

}  // namespace

void HeldPresses::hold(std::span<ContactBody> bodies, AttachmentSolver<3>& attachments,
                       std::span<const ContactRigid> rigids, float step) {
  held_.clear();
  attachments.append_held(rigids, step, held_);
  for (const HeldParticle<3>& held : held_)
    if (!bodies[held.body].asleep) bodies[held.body].hold(held.particle, held.velocity, held.most_impulse);
  std::sort(held_.begin(), held_.end(), [](const HeldParticle<3>& a, const HeldParticle<3>& b) {
    return std::tie(a.body, a.particle, a.attachment) < std::tie(b.body, b.particle, b.attachment);
  });
}

void HeldPresses::choose(std::span<ContactGroup> groups, std::span<const ContactBody> bodies,
                         AttachmentSolver<3>& attachments, std::span<const ContactRigid> rigids) {
  presses_.clear();
  for (const ContactGroup& group : groups)
    if (group.on_held) add_presses(group);
  for (ContactGroup& group : groups) {
    if (!group.on_held) continue;
    const ContactBody& body = bodies[group.a];
    group.on_held = !breaks_what_holds(group, body, attachments, rigids);
    // All contacts with held particles see the same velocities, static ones, too. Otherwise each of two that press on a cell from both
    // sides undoes what it believes that the other has done, and more.
    for (SoftContact& contact : group.contacts) contact.on_held = group.on_held && body.holds(contact.a);
  }
}

/// Adds up the contacts with held particles by rigid bodies.
void HeldPresses::add_presses(const ContactGroup& group) {
  for (const SoftContact& contact : group.contacts) {
    if (!contact.on_held) continue;
    Press& press = press_of(contact.rigid);
    press.points += contact.acts_at;
    press.normals += contact.normal;
    ++press.contacts;
  }
}

/// Whether rigid bodies press more on a soft one than some of the attachments carry that hold it. These will break.
bool HeldPresses::breaks_what_holds(const ContactGroup& group, const ContactBody& body,
                                    AttachmentSolver<3>& attachments, std::span<const ContactRigid> rigids) {
  for (Press& press : presses_) press.contacts_of_body = 0;
  for (const SoftContact& contact : group.contacts)
    if (contact.on_held) ++press_of(contact.rigid).contacts_of_body;
  bool breaks = false;
  for (const SoftContact& contact : group.contacts) {
    const float most = body.most_impulse_if_held(contact.a);
    if (!contact.on_held || std::isinf(most)) continue;
    const float impulse =
        press_of(contact.rigid).impulse_to_stop(rigids[contact.rigid], body.velocity_if_held(contact.a));
    breaks = breaks || impulse > most;
    press_on(attachments, group.a, contact.a, impulse);
  }
  return breaks;
}

HeldPresses::Press& HeldPresses::press_of(std::uint32_t rigid) {
  const auto press = std::ranges::find(presses_, rigid, &Press::rigid);
  return press != presses_.end() ? *press : presses_.emplace_back(Press{.rigid = rigid});
}

float HeldPresses::Press::impulse_to_stop(const ContactRigid& by, const Vector3f& held_velocity) const {
  const Vector3f point = points / static_cast<float>(contacts), normal = normals.normalized();
  const float mobility = by.mobility(point, normal);
  const float share = static_cast<float>(contacts_of_body) / static_cast<float>(contacts);
  return mobility > 0 ? share * normal.dot(by.velocity_at(point) - held_velocity) / mobility : 0;
}

/// Tells the attachments that hold one of the anchor's particles. @param impulse  kg m/s
void HeldPresses::press_on(AttachmentSolver<3>& attachments, std::uint32_t body, const Anchor& anchor,
                           float impulse) const {
  for (const std::uint32_t particle : anchor.particle) {
    if (anchor.share_of(particle) == 0) continue;
    const auto is_before = [&](const HeldParticle<3>& held, std::uint32_t number) {
      return std::tie(held.body, held.particle) < std::tie(body, number);
    };
    auto held = std::lower_bound(held_.begin(), held_.end(), particle, is_before);
    for (; held != held_.end() && held->body == body && held->particle == particle; ++held)
      attachments.press(held->attachment, impulse > held->most_impulse);
  }
}

}  // namespace softcell::ppu
