#pragma once
// Draws a scene: what the world and the orchestrator hand over becomes a frame of the renderer.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "scene.h"
#include "simulation_3d.h"
#include "softcell/render/renderer.h"

namespace softcell::demos {

/// What of the soft bodies is drawn.
enum class View { kMesh, kLattice };

/// Holds the meshes of one simulation in one renderer. Both must outlive it.
class SceneView {
 public:
  SceneView(const Scene& scene, const Simulation3d& simulation, render::Renderer& renderer, View view);

  /// Draws the newest frame that the SPEs have finished.
  const render::Image& draw();

 private:
  void update_lattices();
  render::Camera tilted_camera() const;

  const Scene& scene_;
  const Simulation3d& simulation_;
  render::Renderer& renderer_;
  View view_;

  std::vector<render::SkinnedDraw> skinned_;
  std::vector<render::StaticDraw> statics_;  // boxes, then obstacles
  struct LatticeBuffers {
    std::vector<Eigen::Vector3f> particles;
    std::vector<std::array<std::uint32_t, 2>> links;
  };
  std::vector<LatticeBuffers> lattice_buffers_;
  std::vector<render::LatticeDraw> lattices_;
};

}  // namespace softcell::demos
