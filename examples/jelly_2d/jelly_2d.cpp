// A soft body in a Box2D program: a jelly falls on the floor, and a box falls on the jelly.

#include <box2d/box2d.h>

#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include "softcell/box2d/box2d_soft_bodies.h"

using namespace softcell::ppu;

int main() try {
  // A Box2D world as in any program.
  b2World world({0, -9.81f});
  b2BodyDef at;
  b2EdgeShape ground;
  ground.SetTwoSided({-10, 0}, {10, 0});
  world.CreateBody(&at)->CreateFixture(&ground, 0);
  at.type = b2_dynamicBody;
  at.position = {0.6f, 4};
  b2PolygonShape square;
  square.SetAsBox(0.25f, 0.25f);
  b2Body* box = world.CreateBody(&at);
  box->CreateFixture(&square, 20);  // kg/m^2

  // The soft body: its cells, written as a picture.
  const std::vector<std::string> rows{"######",  //
                                      "######",  //
                                      "##..##",  //
                                      "##..##"};
  SoftBodySettings jelly;
  jelly.cell_size = 0.2f;  // metres
  jelly.density = 30;      // kg/m^2
  jelly.damping = 0.2f;
  const auto model = make_soft_body_model(lattice_from_cells(cells_from_rows(rows), jelly.cell_size), jelly);
  Box2dSoftBodies soft_bodies(world);
  SoftBody<2>& body = soft_bodies.add(model, {0, 0.5f});

  for (int step = 0; step < 480; ++step) {
    soft_bodies.step(1 / 120.0f);  // in place of world.Step()
    if (step % 80 != 79) continue;
    std::printf("%.1f s: the box is at height %.2f m, the middle of the jelly at %.2f m\n",
                (step + 1) / 120.0, static_cast<double>(box->GetPosition().y),
                static_cast<double>(body.centre_of_mass().y()));
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "jelly_2d: %s\n", error.what());
  return 1;
}
