#pragma once
// Turns the shapes of rigid bodies into meshes and draws for the renderer.

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "scene/rigid_body.h"
#include "softcell/render/renderer.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::demos {

/// A part of a rigid body in the list of draws.
struct DrawnPart {
  std::size_t body = 0, draw = 0;                              ///< their numbers
  Eigen::Matrix4f pose_in_body = Eigen::Matrix4f::Identity();  ///< from the part's frame to the body's
};

/// Adds a mesh to the renderer.
using AddStatic = std::function<render::StaticMeshId(const ppu::TriangleMesh& mesh)>;

/// Appends the parts of all bodies to the draws.
std::vector<DrawnPart> add_parts(std::span<const RigidBody> bodies, const AddStatic& add_static,
                                 std::vector<render::StaticDraw>& statics);

}  // namespace softcell::demos
