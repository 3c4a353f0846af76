#include "ppu/contact_solver/given_spin.h"

#include <cstddef>

namespace softcell::ppu {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// The mean of a quantity of the anchor's particles, weighted by their shares.
template <typename OfParticle>
Vector3f of_anchor(const Anchor& anchor, const ContactBody& /*body*/, const OfParticle& of_particle) {
  Vector3f sum = Vector3f::Zero();
  for (std::size_t k = 0; k < 8; ++k) sum += anchor.share[k] * of_particle(anchor.particle[k]);
  return sum;
}
/// The kernel's weights are shares times roots of inverse masses.
template <typename OfParticle>
Vector3f of_anchor(const spu::SolveAnchor& anchor, const ContactBody& body, const OfParticle& of_particle) {
  Vector3f sum = Vector3f::Zero();
  for (std::size_t k = 0; k < 8; ++k) {
    const std::size_t particle = anchor.particle[k];
    if (particle >= body.positions.size()) continue;  // the slot of zeros
    sum += anchor.weight[k] * body.model->root_masses[particle] * of_particle(particle);
  }
  return sum;
}

/// From a point to the anchor's place before the step.
Vector3f arm_of(const auto& anchor, const ContactBody& body, const Vector3f& point) {
  return of_anchor(anchor, body, [&](std::size_t i) -> Vector3f { return body.positions[i] - point; });
}
Vector3f velocity_of(const auto& anchor, const ContactBody& body) {
  return of_anchor(anchor, body, [&](std::size_t i) -> Vector3f { return body.velocities[i]; });
}

}  // namespace

Vector3d given_spin(const ContactGroup& group, std::span<const ContactBody> bodies, float step) {
  const ContactBody &a = bodies[group.a], &b = bodies[group.b];
  Vector3d given = Vector3d::Zero();
  group.for_each_contact([&](const auto& contact) {
    const Vector3f point(contact.point), normal(contact.normal);
    const Vector3f impulse = contact.impulse * normal + Vector3f(contact.friction_impulse);
    if (!impulse.isZero(0)) {
      const Vector3f apart = arm_of(contact.a, a, point) - arm_of(contact.b, b, point);
      given += apart.cast<double>().cross(impulse.cast<double>());
    }
    if (contact.push != 0) {
      const Vector3f against = velocity_of(contact.a, a) - velocity_of(contact.b, b);
      given += double{step * contact.push} * normal.cast<double>().cross(against.cast<double>());
    }
  });
  return given;
}

}  // namespace softcell::ppu
