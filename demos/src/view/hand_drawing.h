#pragma once
// Draws the hands that hold bodies in three dimensions: a glove, and a thread from its fingertips to the held point.

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "softcell/render/renderer.h"

namespace softcell::demos {

/// One thread uses it.
class HandDrawing {
 public:
  using Hand = std::array<Eigen::Vector3f, 2>;  ///< the held point, and the hand, metres

  /// Adds nothing to the renderer before the first hand is drawn.
  explicit HandDrawing(render::Renderer& renderer) : renderer_(renderer) {}

  /// Appends the draws that show the hands. Gloves have the same size in every picture, whatever the scene's size.
  /// @param lattices  refer to this object's memory until the next call
  void append(std::span<const Hand> hands, const render::Camera& camera,
              std::vector<render::StaticDraw>& statics, std::vector<render::LatticeDraw>& lattices);

 private:
  render::Renderer& renderer_;
  bool has_glove_ = false;
  render::StaticMeshId glove_;
  std::vector<Hand> threads_;
};

}  // namespace softcell::demos
