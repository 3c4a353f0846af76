#pragma once
// Draws a scene in two dimensions as if it were cut out of card and laid on squared paper: soft and rigid bodies, with fixed ones hatched;
// over them, on request, the particles or the lattices; and the hands that hold particles.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "moved_2d.h"
#include "rigid_shape_2d.h"
#include "scene/look.h"
#include "scene/scene_2d.h"
#include "simulation/simulation_2d.h"
#include "soft_shape_2d.h"
#include "softcell/render/renderer.h"

namespace softcell::demos {

/// Holds the shapes of one simulation in one renderer. Both must outlive it. Used by one thread.
class SceneView2d {
 public:
  SceneView2d(const Scene2d& scene, const Simulation2d& simulation, render::Renderer& renderer, View2d view);

  /// Draws the simulation as it is now.
  const render::Image& draw();

  /// Draws a copy of the simulation, which may go on meanwhile. The picture is in the renderer. Only what has
  /// moved is redrawn, so nobody else may draw frames with this renderer.
  void draw(const Shown2d& shown, const Look& look);

 private:
  using Link = std::array<std::uint32_t, 2>;

  /// A soft body with its particles, for the views that show them.
  struct SoftBody {
    std::shared_ptr<const ppu::SoftBodyModel<2>> model;
    render::Colour colour;
    SoftShape2d shape;
    std::vector<Eigen::Vector2f> particles;  // all, in order
    std::vector<Eigen::Vector2f> outer, at_cut,
        inner;                // at_cut: outer particles at a cut, with a smaller circle
    std::vector<Link> edges;  // of all cells
  };
  struct RigidBody {
    RigidShape2d shape;  // about the body's position
    render::Shape2dId id;
    bool firm;                         // it never moves
    std::optional<float> mark_radius;  // for circles, whose rotation a mark shows
    std::vector<render::Vertex2d> vertices;
    std::vector<Eigen::Vector2f> outline;
    std::array<Eigen::Vector2f, 1> mark;
  };

  void add_rigid_body(const RigidBody2d& body);
  void follow_bodies(const Shown2d& shown);
  std::unique_ptr<SoftBody> make_soft_body(const SoftBody2dPlacement& body,
                                           std::shared_ptr<const ppu::SoftBodyModel<2>> model);
  void draw_rigid_body(std::size_t index, const Pose2d& pose);
  void draw_soft_body(std::size_t index, View2d view);
  void draw_ropes(const Shown2d& shown);
  void draw_hands(const Shown2d& shown);
  std::optional<render::PixelRect> changes(const Shown2d& shown, View2d view);
  float line_width() const;

  const Scene2d& scene_;
  const Simulation2d& simulation_;
  render::Renderer& renderer_;
  View2d view_;
  Shown2d now_;

  Stickers stickers_;
  WholeSkins wholes_;
  std::vector<RigidBody> rigid_bodies_;
  std::vector<std::unique_ptr<SoftBody>> soft_bodies_;
  std::vector<std::vector<Eigen::Vector2f>> ropes_;    // the points of each rope as it is drawn
  std::vector<std::array<Eigen::Vector2f, 2>> hands_;  // the particle, the hand

  Moved2d moved_;
  std::optional<View2d> drawn_view_;  // of the previous picture

  Drawing2d drawing_;  // the frame that is being made
};

}  // namespace softcell::demos
