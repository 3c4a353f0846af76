#pragma once
// Draws a scene of two dimensions: soft bodies as dots, as a lattice or filled; walls and rigid bodies as
// plates before a wall; the hands that hold particles.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "moved_2d.h"
#include "scene/look.h"
#include "scene/scene_2d.h"
#include "simulation/simulation_2d.h"
#include "softcell/render/renderer.h"

namespace softcell::demos {

/// Holds the meshes of one simulation in one renderer. Both must outlive it. Used by one thread.
class SceneView2d {
 public:
  SceneView2d(const Scene2d& scene, const Simulation2d& simulation, render::Renderer& renderer, View2d view);

  /// Draws the simulation as it is now.
  const render::Image& draw();

  /// Draws what was copied from the simulation, which may go on meanwhile. The picture is in the renderer, of
  /// which only what has moved is drawn anew: nobody else may draw frames with it.
  void draw(const Shown2d& shown, const Look& look);

 private:
  using Link = std::array<std::uint32_t, 2>;

  /// What is drawn of a soft body, its buffers filled anew for each picture.
  struct Body {
    const ppu::SoftBodyModel<2>* model;
    render::MeshId mesh;
    std::vector<Eigen::Vector3f> particles;  // all, in order
    std::vector<Eigen::Vector3f> outer, inner;
    std::vector<Link> edges;    // of all cells
    std::vector<Link> outline;  // the edges of one cell alone
  };

  void add_plate(const std::vector<Eigen::Vector2f>& corners, const render::Colour& colour);
  void add_rigid_body(const RigidBody2d& body);
  void add_back_wall();
  void add_soft_body(const ppu::SoftBodyModel<2>& model);
  void place_rigid_bodies(const std::vector<Pose2d>& poses);
  void place_particles(Body& body, const std::vector<Eigen::Vector2f>& positions) const;
  void draw_as_dots(std::size_t body);
  void draw_as_lattice(std::size_t body);
  void draw_filled(std::size_t body, const std::vector<Eigen::Vector2f>& positions);
  void draw_hands(const Shown2d& shown);
  std::optional<render::PixelRect> changes(const Shown2d& shown, View2d view);

  const Scene2d& scene_;
  const Simulation2d& simulation_;
  render::Renderer& renderer_;
  View2d view_;
  Shown2d now_;

  std::vector<render::StaticDraw> statics_;  // rigid bodies in order, then what does not move
  std::vector<Body> bodies_;
  std::vector<std::array<Eigen::Vector3f, 1>> marks_;  // of circles: one sees them turn
  std::vector<std::size_t> circles_;                   // whose marks they are
  std::vector<std::array<Eigen::Vector3f, 2>> hands_;  // the particle, the hand

  std::optional<Moved2d> moved_;
  std::optional<View2d> drawn_view_;  // of the picture before

  // The frame in making.
  std::vector<render::SkinnedDraw> skinned_;
  std::vector<render::LatticeDraw> lattices_;
  std::vector<std::array<std::uint16_t, 8>> vertices_;
};

}  // namespace softcell::demos
