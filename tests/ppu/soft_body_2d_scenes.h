#pragma once
// Small worlds in two dimensions for the tests of soft bodies.

#include <box2d/b2_body.h>
#include <box2d/b2_fixture.h>
#include <box2d/b2_polygon_shape.h>
#include <box2d/b2_world.h>

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "softcell/box2d/box2d_soft_bodies.h"

namespace softcell::ppu {

/// A rectangle of cells, centred on 0 in x, its lowest particles at y = 0.
inline std::shared_ptr<const SoftBodyModel<2>> rectangle_model(const Eigen::Vector2i& cells,
                                                               const SoftBodySettings& settings,
                                                               float contact_radius_in_cells = 0.5f) {
  std::vector<Eigen::Vector2i> all;
  for (int x = 0; x < cells.x(); ++x)
    for (int y = 0; y < cells.y(); ++y) all.push_back({x, y});
  const Eigen::Vector2f origin(-0.5f * settings.cell_size * static_cast<float>(cells.x()), 0);
  return make_soft_body_model(lattice_from_cells(all, settings.cell_size, origin), settings,
                              contact_radius_in_cells);
}

/// For suites of tests of both methods.
inline std::string name_of_method(const testing::TestParamInfo<ContactMethod>& method) {
  return method.param == ContactMethod::kSpheres ? "Circles" : "Surface";
}

struct World2d {
  explicit World2d(float gravity = 9.81f, ContactMethod contacts = ContactMethod::kSpheres)
      : box2d(b2Vec2(0, -gravity)), soft(box2d, contacts) {}
  /// @param solvers  who steps the bodies and has their contacts
  World2d(float gravity, ContactMethod contacts, SolverFactory& solvers)
      : box2d(b2Vec2(0, -gravity)), soft(box2d, solvers, contacts) {}

  b2World box2d;
  Box2dSoftBodies soft;

  b2Body* add_box(const b2Vec2& centre, const b2Vec2& half, float density = 0) {
    b2BodyDef definition;
    definition.type = density > 0 ? b2_dynamicBody : b2_staticBody;
    definition.position = centre;
    b2Body* const body = box2d.CreateBody(&definition);
    b2PolygonShape shape;
    shape.SetAsBox(half.x, half.y);
    b2Fixture* const fixture = body->CreateFixture(&shape, density);
    fixture->SetFriction(0.6f);
    return body;
  }
  void run(float seconds, float step = 1.0f / 120) {
    for (int i = 0; i < static_cast<int>(seconds / step + 0.5f); ++i) soft.step(step);
  }
};

}  // namespace softcell::ppu
