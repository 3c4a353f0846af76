#pragma once
// The camera. Its matrices need no trigonometry, so that they have the same bits on every host. Any thread.

#include <Eigen/Core>

namespace softcell::render {

/// A perspective camera; metres, y up.
struct Camera {
  Eigen::Vector3f eye{0, 2, 6};
  Eigen::Vector3f target{0, 0, 0};  ///< shown in the centre of the picture; not equal to `eye`
  Eigen::Vector3f up{0, 1, 0};      ///< not parallel to the line of sight
  float tan_half_fov_y = 0.4f;      ///< tangent of half the vertical angle of view; above 0
  float near_plane = 0.1f;          ///< above 0
  float far_plane = 100;            ///< beyond near_plane
};

/// World to view: the eye at 0, looking along -z, y up.
/// @pre  eye is not target, and up is not parallel to the line between them
Eigen::Matrix4f look_at(const Eigen::Vector3f& eye, const Eigen::Vector3f& target, const Eigen::Vector3f& up);

/// View to clip space of OpenGL (-w..w in all three axes). `aspect` is width over height.
/// @pre  all are above 0, and near_plane < far_plane
Eigen::Matrix4f perspective(float tan_half_fov_y, float aspect, float near_plane, float far_plane);

/// View to clip space: the box -half_width..half_width in x and y, and near..far in front of the eye.
/// @pre  half_width is above 0, and near_plane < far_plane
Eigen::Matrix4f orthographic(float half_width, float near_plane, float far_plane);

/// World to clip space for a picture of the given proportions.
Eigen::Matrix4f view_projection(const Camera& camera, float aspect);

}  // namespace softcell::render
