#pragma once
// The shapes of rigid bodies, as plain data and as Bullet's objects.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <memory>

class btCollisionShape;

namespace softcell::ppu {

enum class RigidShapeKind : std::uint8_t { kBox, kSphere, kCylinder, kCapsule, kCone };

/// One of the convex shapes of a rigid body. Metres; round shapes stand along their y axis.
struct RigidShape {
  RigidShapeKind kind = RigidShapeKind::kBox;
  Eigen::Vector3f size{1, 1, 1};      ///< of a box
  float radius = 0.5f;                ///< of all others
  float height = 1;                   ///< of a cylinder, capsule or cone: total height
  Eigen::Vector3f position{0, 0, 0};  ///< of its middle in the body
  Eigen::Quaternionf rotation = Eigen::Quaternionf::Identity();
};

struct RigidBodySettings {
  float mass = 0;                     ///< kg; 0: only the program moves it
  Eigen::Vector3f position{0, 0, 0};  ///< of the frame in which the shapes are placed
  Eigen::Quaternionf rotation = Eigen::Quaternionf::Identity();  ///< of unit length
  float friction = 0.6f;                                         ///< as of BulletWorld::add_box()
  float restitution = 0;
  bool is_moved = false;  ///< by BulletWorld::move_to(); its mass is 0
};

/// Whether the shape lies in the middle of its body without a rotation.
bool is_in_the_middle(const RigidShape& shape);

/// m^3
float volume_of(const RigidShape& shape);

/// @throws std::invalid_argument  a length that is not above 0, a capsule that is not higher than twice its radius.
std::unique_ptr<btCollisionShape> make_bullet_shape(const RigidShape& shape);

}  // namespace softcell::ppu
