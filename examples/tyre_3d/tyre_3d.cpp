// A soft tyre on a rigid rim in a Bullet program: the wheel rolls over a bump.

#include <btBulletDynamicsCommon.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <utility>
#include <vector>

#include "softcell/bullet/bullet_soft_bodies.h"
#include "softcell/soft_bodies/shapes.h"

using namespace softcell::ppu;

int main() try {
  // A Bullet world as in any program. Its shapes and bodies are declared first, so that the world is destroyed before them.
  btStaticPlaneShape ground({0, 1, 0}, 0);
  btRigidBody floor(0, nullptr, &ground);
  btBoxShape bar({0.1f, 0.08f, 1});
  btRigidBody bump(0, nullptr, &bar);
  bump.setWorldTransform(btTransform(btQuaternion::getIdentity(), {1.5f, 0, 0}));
  btCylinderShapeZ disc({0.4f, 0.4f, 0.12f});
  btVector3 inertia;
  disc.calculateLocalInertia(20, inertia);
  btRigidBody rim(20, nullptr, &disc, inertia);
  rim.setWorldTransform(btTransform(btQuaternion::getIdentity(), {0, 0.72f, 0}));
  rim.setActivationState(DISABLE_DEACTIVATION);
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity({0, -9.81f, 0});
  for (btRigidBody* const body : {&floor, &bump, &rim}) world.addRigidBody(body);

  // The tyre: a torus about the z axis, and what of it lies on the rim.
  TriangleMesh mesh = make_torus(0.52f, 0.16f, 64, 24);
  for (auto* const vectors : {&mesh.positions, &mesh.normals})
    for (Eigen::Vector3f& v : *vectors) v = {v.x(), -v.z(), v.y()};
  SoftBodySettings rubber;
  rubber.cell_size = 0.08f;  // metres
  rubber.half_width = 1;
  rubber.alpha = 0.7f;
  rubber.damping = 0.2f;
  BulletSoftBodies soft_bodies(world);
  SoftBody<3>& tyre = soft_bodies.add(make_soft_body_model(mesh, rubber), {0, 0.72f, 0});
  std::vector<std::uint32_t> bead;
  for (std::uint32_t i = 0; i < tyre.positions().size(); ++i)
    if (std::hypot(tyre.position(i).x(), tyre.position(i).y() - 0.72f) < 0.46f) bead.push_back(i);
  soft_bodies.attach(tyre, Patch<3>::of_particles(std::move(bead)), rim);

  rim.setLinearVelocity({3, 0, 0});
  rim.setAngularVelocity({0, 0, -3 / 0.68f});
  tyre.add_velocity({3, 0, 0});
  tyre.add_angular_velocity({0, 0, -3 / 0.68f});
  for (int frame = 0; frame < 90; ++frame) {
    world.stepSimulation(1 / 60.0f, 4, 1 / 240.0f);
    if (frame % 15 != 14) continue;
    const btVector3 axle = rim.getWorldTransform().getOrigin();
    std::printf("%.2f s: the axle is at %.2f m, %.2f m above the ground, and rolls at %.1f m/s\n",
                (frame + 1) / 60.0, static_cast<double>(axle.x()), static_cast<double>(axle.y()),
                static_cast<double>(rim.getLinearVelocity().x()));
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "tyre_3d: %s\n", error.what());
  return 1;
}
