// A soft body in a Bullet program: a jelly falls on the floor, and a box falls on the jelly.
//
//   jelly_3d jelly.obj

#include <btBulletDynamicsCommon.h>

#include <cstdio>
#include <exception>

#include "softcell/bullet/bullet_soft_bodies.h"
#include "softcell/mesh_import/mesh_import.h"

using namespace softcell::ppu;

int main(int argc, char** argv) try {
  // A Bullet world as in any program. Its shapes and bodies are declared first, so that the world is destroyed before them.
  btStaticPlaneShape ground({0, 1, 0}, 0);
  btRigidBody floor(0, nullptr, &ground);
  btBoxShape cube({0.25f, 0.25f, 0.25f});
  btVector3 inertia;
  cube.calculateLocalInertia(8, inertia);
  btRigidBody box(8, nullptr, &cube, inertia);
  box.setWorldTransform(btTransform(btQuaternion::getIdentity(), {0, 3, 0}));
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity({0, -9.81f, 0});
  world.addRigidBody(&floor);
  world.addRigidBody(&box);

  // The soft body: seven lines.
  SoftBodySettings jelly;
  jelly.cell_size = 0.2f;  // metres
  jelly.density = 300;     // kg/m^3
  jelly.damping = 0.2f;
  const auto model = make_soft_body_model(import_mesh(argc > 1 ? argv[1] : "jelly.obj"), jelly);
  BulletSoftBodies soft_bodies(world);
  SoftBody<3>& body = soft_bodies.add(model, {0, 0.6f, 0});

  for (int frame = 0; frame < 240; ++frame) {
    world.stepSimulation(1 / 60.0f, 2, 1 / 120.0f);
    if (frame % 40 != 39) continue;
    std::printf("%.1f s: the box is at height %.2f m, the middle of the jelly at %.2f m\n",
                (frame + 1) / 60.0, static_cast<double>(box.getWorldTransform().getOrigin().y()),
                static_cast<double>(body.centre_of_mass().y()));
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "jelly_3d: %s\n", error.what());
  return 1;
}
