#pragma once
// A hand's hold on a soft body in two dimensions: as in three dimensions (surface_grip.h), by a patch that gives.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "grip.h"
#include "patch_grip.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::demos {

/// Holds a particle, and the patch of the body around it (patch_grip.h).
///
/// One thread uses it. Allocates in the constructor, and when the body yields. Deterministic: it computes in double precision and sums in
/// the order of particles.
class SoftGrip2d final : public Grip<2> {
 public:
  /// @param body  must outlive this object  @pre it has the particle
  SoftGrip2d(ppu::SoftBody<2>& body, std::uint32_t particle);

  Eigen::Vector2f point() const override { return body_.position(particle_); }
  void pull(const HandMotion<2>& hand, const Eigen::Vector2f& gravity, float step) override;
  void let_go(const Eigen::Vector2f& velocity) override;
  std::optional<HeldPart<2>> part() const override { return HeldPart<2>(body_, grip_.patch(), point()); }
  bool holds(const void* body) const override { return &body_ == body; }
  std::optional<std::unique_ptr<Grip<2>>> follow(
      std::span<const ppu::BrokenSoftBody2d> broken) const override;

  float patch_radius() const { return grip_.patch().radius; }  ///< metres, along the body

 private:
  ppu::SoftBody<2>& body_;
  std::uint32_t particle_;
  PatchGrip<2> grip_;
};

}  // namespace softcell::demos
