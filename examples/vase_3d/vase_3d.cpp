// A vase in a Bullet program: it falls from a shelf, and breaks.

#include <btBulletDynamicsCommon.h>

#include <cstdio>
#include <exception>

#include "softcell/bullet/bullet_soft_bodies.h"
#include "softcell/soft_bodies/shapes.h"

using namespace softcell::ppu;

int main() try {
  // A Bullet world as in any program. Its shapes and bodies are declared first, so that the world is destroyed before them.
  btStaticPlaneShape ground({0, 1, 0}, 0);
  btRigidBody floor(0, nullptr, &ground);
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity({0, -9.81f, 0});
  world.addRigidBody(&floor);

  // Stiff, and brittle: faces between cells break where these are 4 % farther apart than at rest.
  SoftBodySettings china;
  china.cell_size = 0.08f;  // metres
  china.half_width = 1;
  china.density = 500;  // kg/m^3
  china.alpha = 0.9f;
  china.damping = 0.2f;
  china.fracture = Fracture{.stretch = 0.04f};
  BulletSoftBodies soft_bodies(world);
  const SoftBody<3>& vase = soft_bodies.add(make_soft_body_model(make_vase(0.9f, 48), china), {0, 2.2f, 0});
  const double mass = vase.model().mass();

  for (int frame = 1; frame <= 120; ++frame) {
    world.stepSimulation(1 / 60.0f, 4, 1 / 240.0f);
    for (const BrokenSoftBody& broken : soft_bodies.poll_broken())
      std::printf("%.2f s: %zu faces break, %zu new pieces\n", frame / 60.0, broken.faces,
                  broken.pieces.size());
  }

  // Each piece is a soft body of its own, and nothing of the vase is lost.
  double sum = 0;
  for (std::size_t i = 0; i < soft_bodies.size(); ++i) sum += double{soft_bodies[i].model().mass()};
  std::printf("the vase of %.2f kg lies in %zu pieces of %.2f kg together\n", mass, soft_bodies.size(), sum);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "vase_3d: %s\n", error.what());
  return 1;
}
