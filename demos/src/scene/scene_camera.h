#pragma once
// From where a scene in three dimensions is seen.

#include <Eigen/Core>

#include "look.h"
#include "scene.h"
#include "softcell/render/camera.h"

namespace softcell::demos {

/// The scene's camera where the user has moved it, in the ground's frame: about the point it looks at, and
/// never over the top.
/// @param tilt  from the ground's frame, in which the world is simulated, to the observer's
render::Camera seen_from(const Scene& scene, const Look& look, const Eigen::Matrix3f& tilt);

/// Half a line.
struct Ray {
  Eigen::Vector3f from{0, 0, 0};
  Eigen::Vector3f along{0, 0, -1};  ///< unit length
};

/// From the eye through (x, y) of a picture, counted from its upper left corner in the units of its size.
Ray ray_through(const render::Camera& camera, int x, int y, int picture_width, int picture_height);

}  // namespace softcell::demos
