#pragma once
// A Bullet world with settings that give the same result in every run, and its rigid bodies.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "ppu/bullet/rigid_shape.h"
#include "softcell/soft_bodies/contact.h"
#include "softcell/soft_bodies/mesh.h"

class btDiscreteDynamicsWorld;
class btRigidBody;

namespace softcell::ppu {

/// Milliseconds of one call of BulletWorld::step().
struct StepTimes {
  double physics_ms = 0;    ///< in Bullet
  double soft_body_ms = 0;  ///< in BulletSoftBodies, called by Bullet
};

/// Owns the world and its rigid bodies. Metres, kilograms, seconds; y is up; gravity is 9.81 m/s^2 downwards
/// until set. Rigid bodies are numbered from 0 in the order they are added. Used by one thread.
///
/// Substeps have a fixed length, nothing is processed in random order, and nothing sleeps: the result depends on the calls made, not on the
/// clock. Bullet computes rotations with the C library's sine and cosine, so with another C library the last bits may differ as soon as a
/// rigid body rotates.
class BulletWorld {
 public:
  BulletWorld();
  ~BulletWorld();
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  /// @param size  edge lengths, positive    @param mass  kg; 0 for a box that never moves
  /// @param position  of its centre         @param friction  coefficient, multiplied with the other body's
  /// @param restitution  0..1, multiplied with the other body's
  /// @param rotation  of unit length
  /// @throws std::invalid_argument  an argument is not as stated.
  std::size_t add_box(const Eigen::Vector3f& size, float mass, const Eigen::Vector3f& position,
                      float friction, float restitution = 0,
                      const Eigen::Quaternionf& rotation = Eigen::Quaternionf::Identity());

  /// Adds the convex hull of a mesh, which never moves. The mesh's origin lies at `position`.
  /// @throws std::invalid_argument  the mesh has no positions.
  std::size_t add_convex(const TriangleMesh& mesh, const Eigen::Vector3f& position, float friction,
                         float restitution = 0);

  /// Adds a body of one or several shapes of the same density, which may overlap.
  /// @throws std::invalid_argument  as add_box() and make_bullet_shape(); no shapes, or both a mass and is_moved.
  std::size_t add_body(std::span<const RigidShape> shapes, const RigidBodySettings& settings);

  /// Moves a body, evenly, so that it arrives at the end of the next substep. It carries along what it touches; nothing stops it.
  /// @param rotation  of unit length  @pre it was added with is_moved; all numbers are finite
  void move_to(std::size_t body, const Eigen::Vector3f& position, const Eigen::Quaternionf& rotation);
  /// Places it there now, without a motion. @pre as above
  void teleport(std::size_t body, const Eigen::Vector3f& position, const Eigen::Quaternionf& rotation);

  /// Joins two bodies so that they only rotate against each other about an axis. They do not collide with each other.
  struct Hinge {
    std::size_t a = 0, b = 0;
    Eigen::Vector3f point{0, 0, 0}, axis{1, 0, 0};  ///< in the world, now; the axis of unit length
    float speed = 0;                                ///< rad/s, of b against a: the motor's target
    float torque = 0;                               ///< N m, at most; 0: no motor
  };
  /// @pre the two differ, and one of them has a mass; torque 0 or above
  void add_hinge(const Hinge& hinge);

  /// Puts all rigid bodies back to the places where they were added, at rest, and forgets contacts.
  void reset();

  Eigen::Matrix4f pose(std::size_t body) const;  ///< from the body's frame to the world's

  /// Where a body is and how it moves: metres, m/s, rad/s.
  struct Motion {
    Eigen::Vector3f position{0, 0, 0};  ///< of its centre
    Eigen::Quaternionf rotation = Eigen::Quaternionf::Identity();
    Eigen::Vector3f velocity{0, 0, 0}, angular_velocity{0, 0, 0};
  };
  bool moves(std::size_t body) const;  ///< whether its mass is above 0
  Motion motion(std::size_t body) const;
  /// Puts a body elsewhere, with the given velocities. Its contacts are found anew. @pre moves(body); the rotation has unit length
  void teleport(std::size_t body, const Motion& motion);

  btRigidBody& rigid_body(std::size_t body);  ///< for what is not offered here
  std::size_t rigid_bodies() const;

  void set_gravity(const Eigen::Vector3f& gravity);  ///< m/s^2

  /// Simulates `seconds` in `substeps` equal steps.
  /// @throws std::invalid_argument  seconds not positive, or no substeps.
  /// @throws std::runtime_error     a soft body is not finite.
  StepTimes step(float seconds, int substeps);

  /// Replaces the content of `contacts` by the contacts of the last substep, soft bodies' particles included. Contacts without an impulse
  /// are left out.
  void contacts(std::vector<Contact>& contacts) const;

  /// The point where a ray enters a rigid body.
  struct RayHit {
    std::size_t body = 0;
    float share = 0;                    ///< 0..1, fraction of the ray
    Eigen::Vector3f position{0, 0, 0};  ///< metres
  };
  /// The rigid bodies that a ray enters, the nearest first. @pre from and to are finite, metres, and differ
  std::vector<RayHit> cast_ray(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const;

  /// Whether a box along the axes, metres, overlaps no rigid body and no sphere of a soft one. @pre low < high, finite
  bool is_free(const Eigen::Vector3f& low, const Eigen::Vector3f& high) const;

  /// For BulletSoftBodies, and for everything that is not offered here.
  btDiscreteDynamicsWorld& world();
  const btDiscreteDynamicsWorld& world() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace softcell::ppu
