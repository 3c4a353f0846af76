#pragma once
// Draws a scene in three dimensions.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "hand_drawing.h"
#include "mesh_looks.h"
#include "moved_3d.h"
#include "rigid_drawing.h"
#include "rope_drawing.h"
#include "rotation_axes.h"
#include "scene/look.h"
#include "scene/scene.h"
#include "scene/scene_camera.h"
#include "simulation/shown.h"
#include "simulation/simulation_3d.h"
#include "softcell/render/renderer.h"

namespace softcell::demos {

/// Holds the meshes of one simulation in one renderer. Both must outlive it.
class SceneView {
 public:
  SceneView(const Scene& scene, const Simulation3d& simulation, render::Renderer& renderer, View view);

  /// Draws the newest frame that the SPEs have finished.
  const render::Image& draw();
  /// The same with the camera turned about the point it looks at. @param turn  radians, counter-clockwise from above
  const render::Image& draw(float turn);

  /// Draws a copy of the simulation, which may go on meanwhile. The camera is kept outside of bodies. The picture is in the renderer.
  void draw(const Shown3d& shown, const Look& look);

 private:
  void draw(const Shown3d& shown, int view, const render::Camera& camera);
  render::MeshId add_skinned_mesh(const ppu::SoftBodyModel<3>& model);
  void follow_bodies(const Shown3d& shown);
  void update_meshes(const Shown3d& shown);
  void update_lattices(const Shown3d& shown);
  void draw_mesh(const Shown3d& shown, float opacity);
  void draw_lattice(const Shown3d& shown);
  void draw_rotations(const Shown3d& shown);
  void draw_contacts(const Shown3d& shown);
  /// Where this picture can differ from the last one.
  std::optional<render::PixelRect> changes(const Shown3d& shown);
  void draw_ropes_and_hands(const Shown3d& shown);

  const Scene& scene_;
  const Simulation3d& simulation_;
  render::Renderer& renderer_;
  View view_;
  Shown3d now_;
  std::vector<SolidBox> boxes_;  // of all bodies

  MeshLooks looks_;
  // Parts of static draws with materials of their own; never changes.
  std::vector<std::vector<render::PartDraw>> parts_;
  std::vector<render::SkinnedDraw> skinned_;
  std::vector<std::vector<render::PartDraw>> skinned_parts_;  // likewise, of skinned_
  std::vector<render::StaticDraw> statics_;                   // boxes, obstacles, parts of rigid bodies
  std::vector<DrawnPart> rigid_parts_;
  Moved3d moved_;
  std::vector<Moved3d::Box> static_boxes_;  // around statics_ in their own frames
  std::vector<Moved3d::Box> restless_;      // around soft bodies and ropes as they are drawn
  HandDrawing hands_;
  RopeDrawing ropes_;
  std::vector<render::StaticDraw> with_more_;  // statics_, ropes and hands
  struct LatticeBuffers {
    std::shared_ptr<const ppu::SoftBodyModel<3>> model;  // whose mesh and links are drawn
    std::vector<Eigen::Vector3f> particles;
    std::vector<std::array<std::uint32_t, 2>> links;
  };
  std::vector<LatticeBuffers> lattice_buffers_;
  std::vector<render::LatticeDraw> lattices_;
  RotationAxes rotations_;
  std::vector<Eigen::Vector3f> points_;  // contacts
  Lines normals_;                        // at contacts
  std::vector<Eigen::Vector3f> marked_;  // at most one of them
  std::vector<render::LatticeDraw> marks_, marks_with_hands_;
  render::FrameDescription frame_;  // the frame that is being made
};

}  // namespace softcell::demos
