#pragma once
// From where a scene in three dimensions is seen.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "look.h"
#include "scene.h"
#include "softcell/render/camera.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::demos {

/// A camera where the user has moved it: about the point it looks at, never over the top, then with that point. The same bits on
/// every host.
render::Camera moved_by(render::Camera camera, const Look& look);

/// The scene's camera where the user has moved it, in the ground's frame.
/// @param tilt  from the ground's frame, in which the world is simulated, to the observer's
render::Camera seen_from(const Scene& scene, const Look& look, const Eigen::Matrix3f& tilt);

/// A box around a body, or a part of one, in a frame of its own.
struct SolidBox {
  ppu::Bounds<3> bounds;
  Eigen::Matrix4f pose = Eigen::Matrix4f::Identity();  ///< of the frame: turned and moved
};

/// Appends the boxes of the scene's rigid bodies and obstacles. @param poses  of its boxes, then of its rigid bodies
void append_rigid(const Scene& scene, std::span<const Eigen::Matrix4f> poses, std::vector<SolidBox>& boxes);

/// Moves the eye back, away from what it looks at, until it is in none of these boxes.
render::Camera kept_outside(render::Camera camera, std::span<const SolidBox> bodies);

/// Moves the scene's camera along its line of sight and sideways so that it shows everything that moves, where it is at the beginning
/// and on the ground below. A scene in which nothing moves keeps its camera.
void frame_bodies(Scene& scene);

/// Half a line.
struct Ray {
  Eigen::Vector3f from{0, 0, 0};
  Eigen::Vector3f along{0, 0, -1};  ///< unit length
};

/// From the eye through (x, y) of a picture, counted from its upper left corner in the units of its size.
Ray ray_through(const render::Camera& camera, int x, int y, int picture_width, int picture_height);

}  // namespace softcell::demos
