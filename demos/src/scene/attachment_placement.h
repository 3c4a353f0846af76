#pragma once
// The attachments of a scene's soft bodies, in two dimensions and three.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "softcell/render/frame.h"
#include "softcell/soft_bodies/attachment.h"

namespace softcell::demos {

/// Attaches a patch of a soft body to another soft body, to a rigid body or to the world.
template <int kDimension>
struct AttachmentPlacement {
  using Vector = Eigen::Vector<float, kDimension>;

  std::string described;             ///< where it is written, for messages: "arena.toml:12:1: attach 2"
  std::size_t body = 0;              ///< number of the soft body
  std::optional<std::size_t> other;  ///< number of the soft body that it is attached to
  std::optional<std::size_t> box;    ///< or number in Scene::boxes, in three dimensions
  std::optional<std::size_t> rigid;  ///< or number in the scene's rigid_bodies
  Vector at = Vector::Zero();        ///< the middle of the patch
  float radius = 0;                  ///< of the patch
  Vector other_at = Vector::Zero();  ///< of the patch of the other soft body
  float other_radius = 0;
  ppu::AttachmentSettings<kDimension> settings;
  // How a rope is drawn:
  float thickness = 0.03f;  ///< metres
  render::Colour colour{0.32f, 0.22f, 0.12f};
};
/// Names of ppu::AttachmentKind in scene files, in the enum's order.
inline constexpr std::array<std::string_view, 3> kAttachmentKinds{"weld", "hinge", "rope"};

}  // namespace softcell::demos
