#include "soft_grip_2d.h"

#include <memory>
#include <optional>
#include <span>

#include "followed_particle.h"

namespace softcell::demos {

using Eigen::Vector2f;

SoftGrip2d::SoftGrip2d(ppu::SoftBody<2>& body, std::uint32_t particle)
    : body_(body), particle_(particle), grip_(body, particle) {}

void SoftGrip2d::pull(const HandMotion<2>& hand, const Vector2f& gravity, float step) {
  const HeldPoint<2> held{.position = point().cast<double>(),
                          .velocity = body_.velocities()[particle_].cast<double>(),
                          .at_rest = grip_.rest().positions[particle_].cast<double>()};
  grip_.pull(held, hand, gravity, step);
}

std::optional<std::unique_ptr<Grip<2>>> SoftGrip2d::follow(
    std::span<const ppu::BrokenSoftBody2d> broken) const {
  FollowedParticle<2> held{&body_, particle_};
  if (!held.follow(broken)) return std::nullopt;
  if (held.body == nullptr) return nullptr;
  return std::make_unique<SoftGrip2d>(*held.body, held.number);
}

void SoftGrip2d::let_go(const Vector2f& velocity) { grip_.let_go(velocity); }

}  // namespace softcell::demos
