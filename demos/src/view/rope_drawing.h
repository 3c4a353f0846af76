#pragma once
// Draws ropes as chains of thin cylinders: straight when they are taut, a parabola when they are slack.

#include <Eigen/Geometry>
#include <span>
#include <vector>

#include "simulation/shown.h"
#include "softcell/render/renderer.h"

namespace softcell::demos {

/// How far the middle of a rope hangs below the line between its ends, metres; 0 if the rope is taut.
float rope_sag(float distance, float length);

/// A box around a rope as it is drawn.
/// @param down  the direction in which slack ropes sag, of unit length
Eigen::AlignedBox3f around_rope(const ShownRope<3>& rope, const Eigen::Vector3f& down);

/// One thread uses it.
class RopeDrawing {
 public:
  /// Adds nothing to the renderer before the first rope is drawn.
  explicit RopeDrawing(render::Renderer& renderer) : renderer_(renderer) {}

  /// @param down  the direction in which slack ropes sag, of unit length
  void append(std::span<const ShownRope<3>> ropes, const Eigen::Vector3f& down,
              std::vector<render::StaticDraw>& statics);

 private:
  render::Renderer& renderer_;
  bool has_meshes_ = false;
  render::StaticMeshId cylinder_, ball_;  // of radius 1, the cylinder from y = -0.5 to 0.5
};

}  // namespace softcell::demos
