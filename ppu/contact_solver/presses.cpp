#include "ppu/contact_solver/presses.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace softcell::ppu {
namespace {

/// Whether supports may hold a rigid body that something presses in a direction: they know nothing of the axes along which its engine does
/// not let it move.
bool moves_freely_along(const ContactRigid& rigid, const Eigen::Vector3f& direction) {
  constexpr float kNearlyAll = 0.9f;
  if (rigid.inverse_mass == 0) return false;
  return !rigid.held || direction.dot(rigid.held->linear * direction) > kNearlyAll * rigid.inverse_mass;
}

}  // namespace

/// Points near each other move the same particles. The mobility of each point is therefore taken for its share of all their impulses.
void Presses::add(const ContactGroup& group, const ContactBody& body, std::span<const ContactRigid> rigids) {
  const auto for_each_press = [&](const auto& work) {
    for (const SoftContact& contact : group.contacts)
      if (moves_freely_along(rigids[contact.rigid], contact.normal)) work(contact);
  };
  moved_by_all_.resize(std::max(moved_by_all_.size(), body.velocities.size()));
  for_each_press([&](const SoftContact& contact) {
    for (const std::uint32_t particle : contact.a.particle) moved_by_all_[particle] = 0;
  });
  for_each_press([&](const SoftContact& contact) {
    for (std::size_t k = 0; k < 8; ++k)
      moved_by_all_[contact.a.particle[k]] += contact.a.share[k] * body.inverse_masses[contact.a.particle[k]];
  });
  for_each_press([&](const SoftContact& contact) {
    float mobility = 0;
    for (std::size_t k = 0; k < 8; ++k) mobility += contact.a.share[k] * moved_by_all_[contact.a.particle[k]];
    mobility = std::max(mobility, contact.a.mobility(body.inverse_masses));
    presses_.push_back({contact.rigid, contact.acts_at, contact.normal, 1 / mobility,
                        contact.a.of(body.velocities), contact.friction, body.spacing()});
  });
}

}  // namespace softcell::ppu
