#pragma once
// The camera of a scene in three dimensions, and where the user has moved it.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "look.h"
#include "scene.h"
#include "softcell/render/camera.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::demos {

/// A camera that the user has moved: first about the point it looks at, never over the top, then together with that point. The same bits on
/// every host.
render::Camera moved_by(render::Camera camera, const Look& look);

/// The scene's camera where the user has moved it, in the ground's frame.
/// @param tilt  from the ground's frame, in which the world is simulated, to the observer's
render::Camera seen_from(const Scene& scene, const Look& look, const Eigen::Matrix3f& tilt);

/// A box around a body, or around a part of one, in its own frame.
struct SolidBox {
  ppu::Bounds<3> bounds;
  Eigen::Matrix4f pose = Eigen::Matrix4f::Identity();  ///< of the frame: rotation and position
};

/// Appends the boxes of the scene's rigid bodies and obstacles. @param poses  of the scene's boxes, then of its rigid bodies
void append_rigid(const Scene& scene, std::span<const Eigen::Matrix4f> poses, std::vector<SolidBox>& boxes);

/// Moves the eye back, away from the point it looks at, until it is in none of these boxes.
render::Camera kept_outside(render::Camera camera, std::span<const SolidBox> bodies);

/// Moves the scene's camera along its line of sight and sideways so that it shows everything that moves, both at its place at the beginning
/// and on the ground below. A scene in which nothing moves keeps its camera.
void frame_bodies(Scene& scene);

/// A half-line.
struct Ray {
  Eigen::Vector3f from{0, 0, 0};
  Eigen::Vector3f along{0, 0, -1};  ///< unit length
};

/// The ray from the eye through (x, y) of a picture, counted from the picture's upper left corner in the units of its size.
Ray ray_through(const render::Camera& camera, int x, int y, int picture_width, int picture_height);

}  // namespace softcell::demos
