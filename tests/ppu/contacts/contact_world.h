#pragma once
// A Bullet world with soft bodies that touch with their surfaces, for tests of contacts.

#include <btBulletDynamicsCommon.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "ppu/bullet/bullet_vector.h"
#include "softcell/bullet/bullet_soft_bodies.h"
#include "softcell/soft_bodies/shapes.h"
#include "softcell/soft_bodies/skinned_mesh.h"
#include "support/drawn_overlap.h"
#include "support/slow_build.h"

namespace softcell::ppu {

inline constexpr float kStep = 1.0f / 120;  ///< a substep in seconds

class ContactWorld {
 public:
  /// @param solvers  who steps the bodies and has their contacts; null: the thread that steps the world
  explicit ContactWorld(const Eigen::Vector3f& gravity = {0, -9.81f, 0}, SolverFactory* solvers = nullptr)
      : owned_(solvers != nullptr
                   ? std::make_unique<BulletSoftBodies>(world, *solvers, ContactMethod::kSurface)
                   : std::make_unique<BulletSoftBodies>(world, ContactMethod::kSurface)),
        bodies(*owned_) {
    world.getSolverInfo().m_splitImpulse = 1;
    world.setGravity(to_bullet(gravity));
  }
  ~ContactWorld() {
    for (const auto& body : rigid_) world.removeRigidBody(body.get());
  }

  /// @param mass  kg; 0: it never moves
  btRigidBody& add(std::unique_ptr<btCollisionShape> shape, float mass, const Eigen::Vector3f& position,
                   float friction = 1, float restitution = 0) {
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape.get(), inertia);
    info.m_startWorldTransform.setOrigin(to_bullet(position));
    info.m_friction = friction;
    info.m_restitution = restitution;
    shapes_.push_back(std::move(shape));
    rigid_.push_back(std::make_unique<btRigidBody>(info));
    world.addRigidBody(rigid_.back().get());
    return *rigid_.back();
  }
  btRigidBody& add_floor(float friction = 1, float restitution = 0) {
    return add(std::make_unique<btBoxShape>(btVector3(50, 1, 50)), 0, {0, -1, 0}, friction, restitution);
  }

  SoftBody<3>& add(const TriangleMesh& mesh, const SoftBodySettings& settings,
                   const Eigen::Vector3f& position) {
    return bodies.add(make_soft_body_model(mesh, settings), position);
  }

  /// @param substeps  of each frame of 1/60 s
  void run(int frames, int substeps = 2) {
    for (int i = 0; i < frames * substeps; ++i)
      world.stepSimulation(1.0f / 60 / static_cast<float>(substeps), 0);
  }

  static std::vector<Eigen::Vector3f> drawn(const SoftBody<3>& body) {
    std::vector<Eigen::Vector3f> positions(body.model().mesh().positions.size()), normals(positions.size());
    skin(body, positions, normals);
    return positions;
  }
  static float lowest_drawn(const SoftBody<3>& body) {
    float lowest = std::numeric_limits<float>::max();
    for (const Eigen::Vector3f& p : drawn(body)) lowest = std::min(lowest, p.y());
    return lowest;
  }
  /// How deep a point is in what is drawn, metres; 0 outside. By brute force: of a mesh that is folded, its nearest triangle does not tell on
  /// which side of it a point is.
  static float depth_in_drawn(const SoftBody<3>& body, const Eigen::Vector3f& point) {
    return tests::DrawnBody(body).depth(point);
  }
  static float fastest(const SoftBody<3>& body) {
    float fastest = 0;
    for (const Eigen::Vector3f& v : body.velocities()) fastest = std::max(fastest, v.norm());
    return fastest;
  }

 private:
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> rigid_;

 public:
  btDiscreteDynamicsWorld world{&dispatcher_, &broadphase_, &solver_, &configuration_};

 private:
  std::unique_ptr<BulletSoftBodies> owned_;

 public:
  BulletSoftBodies& bodies;
};

/// The settings of the tests' bodies.
inline SoftBodySettings settings_of(float cell_size, float alpha = 0.5f, float damping = 0.1f) {
  SoftBodySettings settings;
  settings.cell_size = cell_size;
  settings.alpha = alpha;
  settings.damping = damping;
  settings.friction = 0.6f;
  return settings;
}

}  // namespace softcell::ppu
