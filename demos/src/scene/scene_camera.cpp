#include "scene_camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "ppu/numbers/deterministic_math.h"
#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

// Sines of the lowest and highest elevation of the eye above the target's horizon: 0.03, -1.5 and 1.5 radians.
constexpr float kLowest = 0.03f, kLowestOfAll = -0.9975f, kHighest = 0.9975f;

/// Eye and target in the ground's frame, in which it is the observer that tilts.
render::Camera tilted(render::Camera camera, const Matrix3f& tilt) {
  const Matrix3f to_ground = tilt.transpose();
  camera.eye = to_ground * camera.eye;
  camera.target = to_ground * camera.target;
  camera.up = to_ground * camera.up;
  return camera;
}

Vector3f half_size(const ppu::RigidShape& shape) {
  if (shape.kind == ppu::RigidShapeKind::kBox) return 0.5f * shape.size;
  const float half = shape.kind == ppu::RigidShapeKind::kSphere ? shape.radius : 0.5f * shape.height;
  return {shape.radius, half, shape.radius};
}

}  // namespace

render::Camera moved_by(render::Camera camera, const Look& look) {
  const Vector3f shift = look.moved + look.followed;
  if (look.turn != 0 || look.rise != 0 || look.distance != 1) {  // else it is the scene's own, bit for bit
    const Vector3f from_target = camera.eye - camera.target;
    const double distance = double{from_target.norm()};
    const double x = double{from_target.x()}, y = double{from_target.y()}, z = double{from_target.z()};
    const double level = std::sqrt(x * x + z * z);
    SC_ASSERT(distance > 0 && look.distance > 0, "a camera {} m from its target, {} times as far away",
              distance, look.distance);
    // The rotation uses no inverse trigonometric function, so that it gives the same bits on every host.
    const double st = ppu::sine(double{look.turn}), ct = ppu::cosine(double{look.turn});
    const double sr = ppu::sine(double{look.rise}), cr = ppu::cosine(double{look.rise});
    const double east = level > 0 ? x / level : 0, south = level > 0 ? z / level : 1;
    const double raised = (level * sr + y * cr) / distance;
    const double forward = (level * cr - y * sr) / distance;  // below 0: over the top
    const double lowest = double{look.looks_around ? kLowestOfAll : kLowest};
    const double height =
        forward > 0 ? std::clamp(raised, lowest, double{kHighest}) : (raised > 0 ? double{kHighest} : lowest);
    const double across = std::sqrt(1 - height * height);
    const Eigen::Vector3d direction(across * (east * ct + south * st), height,
                                    across * (south * ct - east * st));
    camera.eye = camera.target + (double{look.distance} * distance * direction).cast<float>();
  }
  if (!shift.isZero(0)) camera.eye += shift, camera.target += shift;
  return camera;
}

render::Camera seen_from(const Scene& scene, const Look& look, const Matrix3f& tilt) {
  return tilted(moved_by(scene.camera, look), tilt);
}

void append_rigid(const Scene& scene, std::span<const Eigen::Matrix4f> poses, std::vector<SolidBox>& boxes) {
  SC_ASSERT(poses.size() == scene.boxes.size() + scene.rigid_bodies.size(),
            "{} poses of {} boxes and {} bodies", poses.size(), scene.boxes.size(),
            scene.rigid_bodies.size());
  const auto add = [&](const Vector3f& half, const Eigen::Matrix4f& pose) {
    boxes.push_back({.bounds = {-half, half}, .pose = pose});
  };
  for (std::size_t i = 0; i < scene.boxes.size(); ++i) add(0.5f * scene.boxes[i].size, poses[i]);
  for (std::size_t i = 0; i < scene.rigid_bodies.size(); ++i) {
    for (const RigidPart& part : scene.rigid_bodies[i].parts)
      add(half_size(part.shape), poses[scene.boxes.size() + i] * part.pose());
  }
  for (const Obstacle& obstacle : scene.obstacles) {
    SolidBox& box = boxes.emplace_back(SolidBox{.bounds = ppu::bounds(obstacle.mesh)});
    box.pose.topRightCorner<3, 1>() = obstacle.position;
  }
}

render::Camera kept_outside(render::Camera camera, std::span<const SolidBox> bodies) {
  const Vector3f back = (camera.eye - camera.target).normalized();
  const Vector3f margin = Vector3f::Constant(2 * camera.near_plane);
  for (std::size_t again = 0; again < bodies.size(); ++again) {  // there may be another body behind one
    bool inside = false;
    for (const auto& [bounds, pose] : bodies) {
      const Vector3f low = bounds.low - margin, high = bounds.high + margin;
      const Matrix3f to_box = pose.topLeftCorner<3, 3>().transpose();
      const Vector3f eye = to_box * (camera.eye - pose.topRightCorner<3, 1>()), way_back = to_box * back;
      if ((eye.array() <= low.array()).any() || (eye.array() >= high.array()).any()) continue;
      float way = std::numeric_limits<float>::infinity();
      for (int axis = 0; axis < 3; ++axis) {
        if (way_back[axis] == 0) continue;
        const float side = way_back[axis] > 0 ? high[axis] : low[axis];
        way = std::min(way, (side - eye[axis]) / way_back[axis]);
      }
      camera.eye += way * back;
      inside = true;
    }
    if (!inside) break;
  }
  return camera;
}

void frame_bodies(Scene& scene) {
  std::optional<ppu::Bounds<3>> all;
  const auto add = [&](const Vector3f& low, const Vector3f& high) {
    if (!all) all = ppu::Bounds<3>{low, high};
    all->low = all->low.cwiseMin(low);
    all->high = all->high.cwiseMax(high);
  };
  /// The top of what is below, onto which it may fall.
  const auto ground_below = [&](const Vector3f& low, const Vector3f& high) {
    std::optional<float> ground;
    const Vector3f middle = 0.5f * (low + high);
    for (const RigidBox& box : scene.boxes) {
      const Vector3f reach = (middle - box.position).cwiseAbs() - 0.5f * box.size;
      const float top = box.position.y() + 0.5f * box.size.y();
      if (box.mass == 0 && reach.x() < 0 && reach.z() < 0 && top <= low.y() && (!ground || top > *ground))
        ground = top;
    }
    return ground;
  };
  const auto add_with_fall = [&](const Vector3f& low, const Vector3f& high) {
    add(low, high);
    if (const auto ground = ground_below(low, high)) {
      const Vector3f fall(0, low.y() - *ground, 0);
      add(low - fall, high - fall);
    }
  };
  for (const SoftBodyPlacement& body : scene.soft_bodies) {
    const ppu::Bounds<3> box = ppu::bounds(body.mesh);
    add_with_fall(box.low + body.position, box.high + body.position);
  }
  for (const RigidBox& box : scene.boxes)
    if (box.mass > 0) {
      const Vector3f half = 0.5f * (box.rotation.toRotationMatrix().cwiseAbs() * box.size);
      add_with_fall(box.position - half, box.position + half);
    }
  for (const RigidBody& body : scene.rigid_bodies) {
    if (body.mass == 0 && !body.motion) continue;
    for (const RigidPart& part : body.parts) {
      const ppu::RigidShape& shape = part.shape;
      const Vector3f extent = shape.kind == ppu::RigidShapeKind::kBox ? shape.size
                              : shape.kind == ppu::RigidShapeKind::kSphere
                                  ? Vector3f(Vector3f::Constant(2 * shape.radius))
                                  : Vector3f(2 * shape.radius, shape.height, 2 * shape.radius);
      const Vector3f half = 0.5f * ((body.rotation * shape.rotation).toRotationMatrix().cwiseAbs() * extent);
      const Vector3f middle = body.position + body.rotation * shape.position;
      if (body.mass > 0)
        add_with_fall(middle - half, middle + half);
      else
        add(middle - half, middle + half);
    }
  }
  if (!all) return;
  constexpr float kMargin = 1.1f;
  render::Camera& camera = scene.camera;
  const float radius = std::max(0.5f * (all->high - all->low).norm(), 1e-3f);
  const float t = camera.tan_half_fov_y, distance = kMargin * radius * std::sqrt(1 + t * t) / t;
  const Vector3f back = (camera.eye - camera.target).normalized();
  camera.target = 0.5f * (all->low + all->high);
  camera.eye = camera.target + distance * back;
  camera.near_plane = std::min(camera.near_plane, 0.1f * distance);
  camera.far_plane = std::max(camera.far_plane, 10 * distance);
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
