#pragma once
// Rigid bodies of several shapes, hinges between them, and bodies that the scene moves.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "ppu/bullet/rigid_shape.h"
#include "softcell/render/frame.h"

namespace softcell::demos {

/// How the scene moves a rigid body that nothing else moves, starting from its place at the beginning.
struct Motion {
  /// Where the body is at a moment. Between two stops it moves smoothly, and it is at rest at both.
  struct Stop {
    float time = 0;                   ///< seconds, ascending
    Eigen::Vector3f offset{0, 0, 0};  ///< metres, from its place at the beginning
    float angle = 0;                  ///< radians about `axis`, from its orientation at the beginning
  };
  Eigen::Vector3f axis{0, 1, 0};   ///< of unit length, through the body's position
  float spin = 0;                  ///< rad/s about the axis, always
  Eigen::Vector3f swing{0, 0, 0};  ///< metres: it moves to and fro, this far to either side
  float period = 1;                ///< seconds, of the swing
  std::vector<Stop> stops;         ///< the body is at offset 0 at time 0 if no stop is there
};

struct RigidPart {
  ppu::RigidShape shape;
  render::Colour colour{0.8f, 0.8f, 0.8f};

  /// The pose of the shape in the body's frame.
  Eigen::Matrix4f pose() const {
    Eigen::Matrix4f pose = Eigen::Matrix4f::Identity();
    pose.topLeftCorner<3, 3>() = shape.rotation.toRotationMatrix();
    pose.topRightCorner<3, 1>() = shape.position;
    return pose;
  }
};

struct RigidBody {
  std::string name;
  std::vector<RigidPart> parts;
  float mass = 0;  ///< kg; 0: only `motion` moves it
  Eigen::Vector3f position{0, 0, 0};
  Eigen::Quaternionf rotation = Eigen::Quaternionf::Identity();
  std::optional<float> friction;  ///< none: the scene's
  float opacity = 1;
  std::optional<Motion> motion;
};

/// A hinge: two rigid bodies turn against each other about an axis. Refers to Scene::rigid_bodies by number.
struct Joint {
  std::size_t a = 0, b = 0;
  Eigen::Vector3f point{0, 0, 0};  ///< metres, at the beginning
  Eigen::Vector3f axis{1, 0, 0};   ///< of unit length
  float speed = 0;                 ///< rad/s, of b relative to a: what the motor aims at
  float torque = 0;                ///< N m, most of the motor; 0: there is no motor
};

/// Where a body is.
struct Placement {
  Eigen::Vector3f position{0, 0, 0};
  Eigen::Quaternionf rotation = Eigen::Quaternionf::Identity();
};

/// The place to which the scene moves a body, with the same bits on every host. @param time  seconds since the beginning  @pre body.motion
Placement placement_at(const RigidBody& body, double time);

}  // namespace softcell::demos
