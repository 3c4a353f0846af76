#include "ppu/attachments/flat_attachments.h"

#include "ppu/numbers/keep_each_once.h"
#include "ppu/surfaces/flat_layer.h"

namespace softcell::ppu {

using Eigen::Vector2f;
using Eigen::Vector3f;

namespace {

void add_to_column(std::span<Vector3f> lifted, std::uint32_t particle, const Vector2f& change) {
  for (const std::uint32_t i : {2 * particle, 2 * particle + 1}) lifted[i].head<2>() += change;
}

}  // namespace

void FlatAttachments::clear() {
  in_plane_.clear();
  for (InPlane& plane : planes_) plane.held.clear();
}

void FlatAttachments::hold(std::uint32_t body, std::span<const std::uint32_t> particles) {
  if (planes_.size() <= body) planes_.resize(body + std::size_t{1});
  std::vector<std::uint32_t>& held = planes_[body].held;
  held.insert(held.end(), particles.begin(), particles.end());
}

void FlatAttachments::add(const AttachmentInStep<2>& attachment) {
  in_plane_.add(attachment);
  hold(attachment.a, attachment.rows->particles(false));
  if (attachment.b != AttachmentInStep<2>::kNone) hold(attachment.b, attachment.rows->particles(true));
}

void FlatAttachments::begin(InPlane& plane, const AttachedBody<3>& body) {
  keep_each_once(plane.held);
  const std::size_t particles = body.positions.size() / 2;
  plane.positions.resize(particles);
  plane.velocities.resize(particles);
  plane.pushes.resize(particles);
  plane.inverse_masses.resize(particles);
  for (const std::uint32_t i : plane.held) {
    plane.positions[i] = FlatLayer::lower(body.positions, i);
    plane.inverse_masses[i] = 0.5f * body.inverse_masses[2 * i];  // two particles of half its mass
  }
}

void FlatAttachments::place_rigids(std::span<const ContactRigid> rigids) {
  rigids_.clear();
  for (const ContactRigid& rigid : rigids)
    rigids_.push_back({.centre = rigid.centre.head<2>(),
                       .velocity = rigid.velocity.head<2>(),
                       .spin = rigid.spin.z(),
                       .inverse_mass = rigid.inverse_mass,
                       .inverse_inertia = rigid.inverse_inertia(2, 2)});
}

void FlatAttachments::append_held(std::span<const ContactRigid> rigids, float step,
                                  std::vector<HeldParticle<3>>& held) {
  place_rigids(rigids);
  held_.clear();
  in_plane_.append_held(rigids_, step, held_);
  for (const HeldParticle<2>& column : held_)
    for (const std::uint32_t particle : {2 * column.particle, 2 * column.particle + 1})
      held.push_back({column.body,
                      particle,
                      {column.velocity.x(), column.velocity.y(), 0},
                      column.most_impulse,
                      column.attachment});
}

void FlatAttachments::begin(std::span<const AttachedBody<3>> bodies, std::span<ContactRigid> rigids,
                            float step) {
  lifted_ = bodies;
  lifted_rigids_ = rigids;
  bodies_.assign(bodies.size(), {});
  for (std::size_t i = 0; i < planes_.size(); ++i) {
    InPlane& plane = planes_[i];
    if (plane.held.empty()) continue;
    begin(plane, bodies[i]);
    bodies_[i] = {plane.positions,      plane.velocities,  plane.pushes,
                  plane.inverse_masses, bodies[i].spacing, bodies[i].asleep};
  }
  place_rigids(rigids);
  lower();
  in_plane_.begin(bodies_, rigids_, step);
}

void FlatAttachments::iterate(int iterations) {
  lower();
  in_plane_.iterate(iterations);
  raise();
}

void FlatAttachments::finish() {
  lower();
  in_plane_.finish();
  raise();
}

void FlatAttachments::take_back_spin() {
  if (!in_plane_.takes_back_spin()) return;
  lower();
  in_plane_.take_back_spin();
  raise();
}

/// Copies the velocities and pushes that contacts have left to the plane.
void FlatAttachments::lower() {
  for (std::size_t i = 0; i < planes_.size(); ++i)
    for (const std::uint32_t p : planes_[i].held) {
      planes_[i].velocities[p] = FlatLayer::lower(lifted_[i].velocities, p);
      planes_[i].pushes[p] = FlatLayer::lower(lifted_[i].pushes, p);
    }
  for (std::size_t i = 0; i < rigids_.size(); ++i) {
    rigids_[i].velocity = lifted_rigids_[i].velocity.head<2>();
    rigids_[i].spin = lifted_rigids_[i].spin.z();
  }
}

/// Adds what has changed since lower() to the layer.
void FlatAttachments::raise() const {
  for (std::size_t i = 0; i < planes_.size(); ++i)
    for (const std::uint32_t p : planes_[i].held) {
      const AttachedBody<3>& lifted = lifted_[i];
      add_to_column(lifted.velocities, p, planes_[i].velocities[p] - FlatLayer::lower(lifted.velocities, p));
      add_to_column(lifted.pushes, p, planes_[i].pushes[p] - FlatLayer::lower(lifted.pushes, p));
    }
  for (std::size_t i = 0; i < rigids_.size(); ++i) {
    lifted_rigids_[i].velocity.head<2>() = rigids_[i].velocity;
    lifted_rigids_[i].spin.z() = rigids_[i].spin;
  }
}

}  // namespace softcell::ppu
