#pragma once
// A hand's hold on a soft body: by a patch of its surface, which gives, and never so hard that the body tears.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "grip.h"
#include "patch_grip.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::demos {

/// Holds a point of a body's surface, and the patch of the body around it (patch_grip.h).
///
/// One thread uses it. Allocates in the constructor, and when the body yields. Deterministic: it computes in double precision and sums in
/// the order of particles.
class SurfaceGrip final : public Grip<3> {
 public:
  /// @param body   must outlive this object
  /// @param point  metres, on the body's surface as it is now. If it is outside of the body, the nearest particle is held.
  SurfaceGrip(ppu::SoftBody<3>& body, const Eigen::Vector3f& point);

  const ppu::SoftBody<3>& body() const { return body_; }
  std::optional<HeldPart<3>> part() const override { return HeldPart<3>(body_, grip_.patch(), point()); }
  bool holds(const void* body) const override { return &body_ == body; }
  Eigen::Vector3f point() const override;
  void pull(const HandMotion<3>& hand, const Eigen::Vector3f& gravity, float step) override;
  void let_go(const Eigen::Vector3f& velocity) override;

  float patch_radius() const { return grip_.patch().radius; }  ///< metres, along the body

 private:
  /// The place of a point in a cell.
  struct Place {
    std::array<std::uint32_t, 8> corners{};  ///< of the cell
    std::array<float, 8> shares{};           ///< weights of the corners; their sum is 1
    std::uint32_t nearest() const;           ///< the corner with the largest share
  };
  static Place place_of(const ppu::SoftBody<3>& body, const Eigen::Vector3f& point);

  ppu::SoftBody<3>& body_;
  Place place_;
  PatchGrip<3> grip_;
  double patch_share_ = 0;  // HeldPoint::patch_share
};

}  // namespace softcell::demos
