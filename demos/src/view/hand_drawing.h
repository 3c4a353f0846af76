#pragma once
// The hands that hold bodies in three dimensions: a glove, and a thread from its fingertips to the point that it holds.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "softcell/render/renderer.h"

namespace softcell::demos {

/// One thread uses it.
class HandDrawing {
 public:
  using Hand = std::array<Eigen::Vector3f, 2>;  ///< the point that is held, and the hand, metres

  /// Nothing is added to the renderer before the first hand is drawn.
  explicit HandDrawing(render::Renderer& renderer) : renderer_(renderer) {}

  /// Appends what shows the hands. Gloves are as large on every picture, whatever the scene's size.
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
