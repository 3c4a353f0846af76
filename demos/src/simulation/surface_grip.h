#pragma once
// How a hand holds a soft body: by a patch of its surface, which gives, and never so hard that the body tears.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>

#include "grip.h"
#include "hand_patch.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::demos {

/// A point of one body's surface that a hand holds, and the patch of the body around it (hand_patch.h).
///
/// The impulse J that moves the point as the hand wants is limited by the body's mass. It reaches the body in two ways:
///
///     patch:  dv_i = (1 - s) J w_i / sum m w        w falls from 1 at the point to 0 at the patch's rim
///     body:   dv_i = s (J / M + I^-1 (r x J) x r_i)  as if the body were rigid, which deforms nothing
///
/// The share s grows to 1 as the point comes out of its place in the body: the patch is pulled out so far and no farther.
///
/// One thread uses it. Allocates in the constructor only. Deterministic: double precision, sums in the order of particles.
class SurfaceGrip final : public Grip<3> {
 public:
  /// @param body   outlives this
  /// @param point  metres, of the body's surface as it is now. Outside of the body, its nearest particle is held.
  SurfaceGrip(ppu::SoftBody<3>& body, const Eigen::Vector3f& point);

  const ppu::SoftBody<3>& body() const { return body_; }
  bool holds(const void* body) const override { return &body_ == body; }
  Eigen::Vector3f point() const override;
  void pull(const HandMotion<3>& hand, const Eigen::Vector3f& gravity, float step) override;
  void let_go(const Eigen::Vector3f& velocity) override;

  float patch_radius() const { return patch_.radius; }  ///< metres, along the body

 private:
  /// Of a point in a cell.
  struct Place {
    std::array<std::uint32_t, 8> corners{};  ///< of the cell
    std::array<float, 8> shares{};           ///< their sum 1
    std::uint32_t nearest() const;           ///< the corner that has the largest share
  };
  static Place place_of(const ppu::SoftBody<3>& body, const Eigen::Vector3f& point);

  ppu::SoftBody<3>& body_;
  Place place_;
  HandPatch<3> patch_;
  double patch_response_ = 0;  // change of the point's velocity when the patch gets dv = w
  Eigen::Vector3d point_at_rest_{0, 0, 0};
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();  // of the body as a whole, for a warm start
};

}  // namespace softcell::demos
