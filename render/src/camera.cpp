#include "softcell/render/camera.h"

#include <Eigen/Geometry>

#include "softcell/base/assert.h"

namespace softcell::render {

Eigen::Matrix4f look_at(const Eigen::Vector3f& eye, const Eigen::Vector3f& target,
                        const Eigen::Vector3f& up) {
  SC_ASSERT(eye != target, "the eye is at its target, ({} {} {})", eye.x(), eye.y(), eye.z());
  SC_ASSERT(up.cross(eye - target).squaredNorm() > 0, "up ({} {} {}) is along the line of sight", up.x(),
            up.y(), up.z());
  const Eigen::Vector3f back = (eye - target).normalized();
  const Eigen::Vector3f right = up.cross(back).normalized();
  const Eigen::Vector3f above = back.cross(right);
  Eigen::Matrix4f view = Eigen::Matrix4f::Identity();
  view.block<1, 3>(0, 0) = right.transpose();
  view.block<1, 3>(1, 0) = above.transpose();
  view.block<1, 3>(2, 0) = back.transpose();
  view.block<3, 1>(0, 3) = Eigen::Vector3f(-right.dot(eye), -above.dot(eye), -back.dot(eye));
  return view;
}

Eigen::Matrix4f perspective(float tan_half_fov_y, float aspect, float near_plane, float far_plane) {
  SC_ASSERT(tan_half_fov_y > 0 && aspect > 0, "tan_half_fov_y {}, aspect {}", tan_half_fov_y, aspect);
  SC_ASSERT(near_plane > 0 && far_plane > near_plane, "near plane {}, far plane {}", near_plane, far_plane);
  Eigen::Matrix4f projection = Eigen::Matrix4f::Zero();
  projection(0, 0) = 1 / (aspect * tan_half_fov_y);
  projection(1, 1) = 1 / tan_half_fov_y;
  projection(2, 2) = -(far_plane + near_plane) / (far_plane - near_plane);
  projection(2, 3) = -2 * far_plane * near_plane / (far_plane - near_plane);
  projection(3, 2) = -1;
  return projection;
}

Eigen::Matrix4f orthographic(float half_width, float near_plane, float far_plane) {
  SC_ASSERT(half_width > 0 && far_plane > near_plane, "half_width {}, near plane {}, far plane {}",
            half_width, near_plane, far_plane);
  Eigen::Matrix4f projection = Eigen::Matrix4f::Identity();
  projection(0, 0) = projection(1, 1) = 1 / half_width;
  projection(2, 2) = -2 / (far_plane - near_plane);
  projection(2, 3) = -(far_plane + near_plane) / (far_plane - near_plane);
  return projection;
}

Eigen::Matrix4f view_projection(const Camera& camera, float aspect) {
  return perspective(camera.tan_half_fov_y, aspect, camera.near_plane, camera.far_plane) *
         look_at(camera.eye, camera.target, camera.up);
}

}  // namespace softcell::render
