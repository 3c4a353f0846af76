#include "scene_camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

render::Camera orbited(render::Camera camera, const Look& look) {
  if (look.turn == 0 && look.rise == 0 && look.distance == 1) return camera;  // the scene's own, to the bit
  constexpr float kLowest = 0.03f, kHighest = 1.5f;                           // above the horizon, radians
  const Eigen::Vector3f from_target = camera.eye - camera.target;
  const float distance = from_target.norm();
  SC_ASSERT(distance > 0 && look.distance > 0, "a camera {} m from its target, {} times as far away",
            distance, look.distance);
  const float turn = std::atan2(from_target.x(), from_target.z()) + look.turn;
  const float rise = std::clamp(std::asin(std::clamp(from_target.y() / distance, -1.0f, 1.0f)) + look.rise,
                                kLowest, kHighest);
  const Eigen::Vector3f direction(std::cos(rise) * std::sin(turn), std::sin(rise),
                                  std::cos(rise) * std::cos(turn));
  camera.eye = camera.target + look.distance * distance * direction;
  return camera;
}

}  // namespace

render::Camera seen_from(const Scene& scene, const Look& look, const Eigen::Matrix3f& tilt) {
  // The world is simulated in the ground's frame; what tilts there is the observer.
  const Eigen::Matrix3f to_ground = tilt.transpose();
  render::Camera camera = orbited(scene.camera, look);
  camera.eye = to_ground * camera.eye;
  camera.target = to_ground * camera.target;
  camera.up = to_ground * camera.up;
  return camera;
}

Ray ray_through(const render::Camera& camera, int x, int y, int picture_width, int picture_height) {
  SC_ASSERT(picture_width > 0 && picture_height > 0, "a picture of {} by {} pixels", picture_width,
            picture_height);
  SC_ASSERT(camera.eye != camera.target, "the camera at ({}, {}, {}) looks at itself", camera.eye.x(),
            camera.eye.y(), camera.eye.z());
  const Eigen::Vector3f forward = (camera.target - camera.eye).normalized();
  const Eigen::Vector3f right = forward.cross(camera.up).normalized();
  const Eigen::Vector3f up = right.cross(forward);
  const float half_height = 0.5f * static_cast<float>(picture_height);
  const float scale = camera.tan_half_fov_y / half_height;
  const float across = scale * (static_cast<float>(x) - 0.5f * static_cast<float>(picture_width));
  const float above = scale * (half_height - static_cast<float>(y));
  return {camera.eye, (forward + across * right + above * up).normalized()};
}

}  // namespace softcell::demos
