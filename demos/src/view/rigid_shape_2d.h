#pragma once
// How a rigid body in two dimensions is drawn: its outline, and triangles whose surface slopes down towards the edge.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "scene/scene_2d.h"
#include "softcell/render/frame_2d.h"

namespace softcell::demos {

struct RigidShape2d {
  std::vector<Eigen::Vector2f> outline;  ///< counter-clockwise, about the body's position, metres
  std::vector<render::Vertex2d> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// @param rounding  radius of corners, metres; smaller shapes have smaller ones
/// @param bevel  width of the sloping part at the edge, metres, likewise; 0: the shape is flat
RigidShape2d rigid_shape_2d(const RigidBody2d& body, float rounding, float bevel);

}  // namespace softcell::demos
