// Edges and tips do not cut into bodies that fall on them.

#include "ppu/contacts/sharp_contacts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "contact_world.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

constexpr float kCell = 0.1f;

/// A cube of 6 x 6 x 6 cells, as high as `height` of what it is at rest.
struct PressedCube {
  explicit PressedCube(float height) {
    for (std::size_t i = 0; i < contact.lattice().particles.size(); ++i) {
      positions.push_back(contact.lattice().rest_position(i));
      positions.back().y() *= height;
    }
    body.model = &contact;
    body.positions = positions;
  }
  DeformedPlace at(int x, int y, int z) const {
    const auto& cells = contact.lattice().cells;
    const auto cell = std::ranges::find(cells, cells.front() + Eigen::Vector3i(x, y, z));
    DeformedPlace place{static_cast<std::uint32_t>(cell - cells.begin()), {0.5f, 0.1f, 0.5f}};
    EXPECT_LT(place.cell, cells.size());
    return place;
  }
  ContactModel contact{
      make_soft_body_model(make_box({6 * kCell, 6 * kCell, 6 * kCell}, kCell), settings_of(kCell))};
  std::vector<Vector3f> positions;
  ContactBody body;
};

/// Cells keep six tenths of their volume, and an edge gets no deeper than half a cell.
TEST(SharpContacts, HaveRoomUntilCellsAreSqueezed) {
  const Vector3f up = Vector3f::UnitY();
  for (const float height : {1.0f, 0.9f, 0.75f, 0.6f, 0.3f, -0.2f}) {
    const PressedCube cube(height);
    for (const float depth : {0.0f, 0.02f, 0.045f, 0.1f}) {
      const float room = std::max(0.0f, std::min(height - 0.6f, 0.5f - depth / kCell));
      EXPECT_NEAR(room_to_squeeze(cube.body, cube.at(2, 0, 2), up, depth), room * kCell, 1e-5f)
          << height << ", " << depth << " m deep";
    }
  }
}

TEST(SharpContacts, FeelCellsBehindTheTouchedOne) {
  PressedCube cube(1);
  const auto lower = [&](std::uint32_t cell, float by) {
    for (unsigned k : {2u, 3u, 6u, 7u})
      cube.positions[cube.contact.lattice().corners[cell][k]].y() -= by * kCell;
  };
  lower(cube.at(2, 2, 2).cell, 0.2f);  // its volume is 0.8; that of the one above grows
  cube.body.positions = cube.positions;
  EXPECT_NEAR(room_to_squeeze(cube.body, cube.at(2, 0, 2), Vector3f::UnitY(), 0), 0.2f * kCell, 1e-5f);
  EXPECT_NEAR(room_to_squeeze(cube.body, cube.at(2, 0, 2), -Vector3f::UnitY(), 0), 0.4f * kCell, 1e-5f);
  EXPECT_NEAR(room_to_squeeze(cube.body, cube.at(4, 0, 2), Vector3f::UnitY(), 0), 0.4f * kCell, 1e-5f);
}

TEST(SharpContacts, AreThoseOnFewCells) {
  const PressedCube cube(1);  // 343 particles: 49 on a face
  const auto touching = [&](std::uint32_t cells) {
    std::vector<SoftContact> contacts(2 * cells);  // two points of each
    for (std::size_t i = 0; i < contacts.size(); ++i) contacts[i].a.cell = static_cast<std::uint32_t>(i / 2);
    return contacts;
  };
  auto none = touching(4);
  SharpContacts sharp_contacts;
  EXPECT_FALSE(sharp_contacts.keep(none, cube.body));
  for (const std::uint32_t cells : {1u, 6u, 16u, 17u, 36u}) {
    auto contacts = touching(cells);
    contacts[0].room = 0.01f;
    const bool sharp = cells <= 16;
    EXPECT_EQ(sharp_contacts.keep(contacts, cube.body), sharp) << cells;
    EXPECT_EQ(contacts[0].room < SoftContact::kNoLimit, sharp) << cells;
  }
}

struct SharpThing {
  const char* name;
  std::unique_ptr<btCollisionShape> shape;
  Vector3f position;
  std::vector<Vector3f> tips;
};

std::vector<SharpThing> sharp_things() {
  std::vector<Vector3f> along;
  for (int i = -5; i <= 5; ++i) along.emplace_back(0, 0.6f, 0.07f * static_cast<float>(i));
  std::vector<SharpThing> things;
  auto cone = std::make_unique<btConeShape>(0.3f, 0.6f);
  cone->setMargin(0.001f);
  things.push_back({"cone", std::move(cone), {0, 0.3f, 0}, {{0, 0.6f, 0}}});
  things.push_back({"knife", std::make_unique<btBoxShape>(btVector3(0.005f, 0.3f, 1)), {0, 0.3f, 0}, along});
  things.push_back({"wire", std::make_unique<btCapsuleShapeZ>(0.005f, 2), {0, 0.6f, 0}, along});
  return things;
}

/// Wires were up to three cells deep in what fell on them from its own height, and stayed there.
TEST(SharpContacts, NothingCutsIntoWhatIsThrownAtIt) {
  for (const float speed : {1.0f, 4.0f, 20.0f}) {
    for (const bool ball : {false, true}) {
      for (SharpThing& thing : sharp_things()) {
        ContactWorld w;
        w.add_floor();
        w.add(std::move(thing.shape), 0, thing.position);
        const TriangleMesh mesh = ball ? make_sphere(0.42f, 12) : make_box({0.7f, 0.7f, 0.7f}, kCell);
        SoftBody<3>& body = w.add(mesh, settings_of(kCell, 0.7f, 0.2f), {0.03f, 1.05f, 0.02f});
        body.add_velocity({0, -speed, 0});
        float deepest = 0;
        for (int i = 0; i < 90; ++i) {
          w.run(1);
          if (i % 2 != 0) continue;
          const tests::DrawnBody drawn(body);
          for (const Vector3f& tip : thing.tips) deepest = std::max(deepest, drawn.depth(tip));
        }
        EXPECT_LT(deepest, 0.25f * kCell)
            << thing.name << (ball ? ", a ball at " : ", a cube at ") << speed << " m/s";
      }
    }
  }
}

/// What flies keeps its momentum with what it flies at, and does not go through it.
TEST(SharpContacts, AKnifeThatFliesIsStopped) {
  for (const float of_body : {0.1f, 1.0f}) {  // its mass
    ContactWorld w({0, 0, 0});
    SoftBody<3>& body = w.add(make_box({0.7f, 0.7f, 0.7f}, kCell), settings_of(kCell), {0, 0, 0});
    const float mass = of_body * body.model().mass();
    btRigidBody& knife =
        w.add(std::make_unique<btBoxShape>(btVector3(0.3f, 0.005f, 0.3f)), mass, {-1, 0.03f, 0});
    knife.setLinearVelocity({10, 0, 0});
    float deepest = 0;
    for (int i = 0; i < 60; ++i) {
      w.run(1);
      const btVector3 edge = knife.getWorldTransform() * btVector3(0.3f, 0, 0);
      deepest = std::max(deepest, ContactWorld::depth_in_drawn(body, to_eigen(edge)));
    }
    EXPECT_LT(deepest, 0.25f * kCell) << of_body;
    const Vector3f momentum = body.linear_momentum() + mass * to_eigen(knife.getLinearVelocity());
    EXPECT_LT((momentum - Vector3f(10 * mass, 0, 0)).norm(), 1e-5f * 10 * mass) << of_body;
  }
}

/// It is not held up as a whole by what it merely lies over: its ends hang down.
TEST(SharpContacts, ALongBodyStillHangsOverABar) {
  ContactWorld w;
  w.add(std::make_unique<btBoxShape>(btVector3(0.05f, 0.05f, 1)), 0, {0, 0, 0});
  SoftBody<3>& body =
      w.add(make_box({2.4f, 0.2f, 0.2f}, kCell), settings_of(kCell, 0.2f, 0.2f), {0, 0.16f, 0});
  float lowest = 0, thinnest = 1, deepest = 0;
  for (int i = 0; i < 90; ++i) {
    w.run(1, 4);
    float top = -1;
    for (const Vector3f& p : ContactWorld::drawn(body))
      lowest = std::min(lowest, p.y()), top = std::max(top, p.y());
    thinnest = std::min(thinnest, top - 0.05f);
    deepest = std::max(deepest, ContactWorld::depth_in_drawn(body, {0.05f, 0.05f, 0}));
    if (i == 19) {
      EXPECT_LT(lowest, -0.5f) << "in a third of a second its ends fall 0.54 m";
    }
  }
  EXPECT_LT(lowest, -0.8f);
  EXPECT_GT(thinnest, 0.11f) << "of 0.2 m, above the bar";
  EXPECT_LT(deepest, 0.1f * kCell);
}

}  // namespace
}  // namespace softcell::ppu
