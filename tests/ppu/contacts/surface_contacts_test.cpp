// What must be true of contacts of what is drawn, in a Bullet world.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "contact_world.h"
#include "softcell/soft_bodies/state_hash.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

TriangleMesh cube(float edge, float cell) { return make_box({edge, edge, edge}, cell); }

TEST(SurfaceContacts, WhatIsDrawnRestsOnWhatIsBelow) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of this file";
  constexpr float kCell = 0.1f;
  const TriangleMesh meshes[] = {cube(8 * kCell, kCell), cube(7.3f * kCell, kCell),
                                 make_sphere(3.4f * kCell, 12), make_penguin(0.9f)};
  for (const TriangleMesh& mesh : meshes) {
    ContactWorld w;
    w.add_floor();
    const SoftBody<3>& body = w.add(mesh, settings_of(kCell, 0.6f, 0.3f), {0, 0.55f, 0});
    w.run(400);
    EXPECT_NEAR(ContactWorld::lowest_drawn(body), 0, 0.05f * kCell) << mesh.positions.size();
    EXPECT_LT(ContactWorld::fastest(body), 0.05f) << mesh.positions.size();
  }
}

/// Two triangles of four kilometres, and strips as long and as wide as a cell.
TEST(SurfaceContacts, AGroundOfLongTrianglesIsAsLevelAsABox) {
  constexpr float kCell = 0.1f, kFar = 2000;
  for (const float width : {kFar, 2 * kCell}) {
    btTriangleMesh ground;
    for (float z = -std::max(width, 1.0f); z < std::max(width, 1.0f); z += width) {
      const btVector3 a(-kFar, 0, z), b(kFar, 0, z), c(-kFar, 0, z + width), d(kFar, 0, z + width);
      ground.addTriangle(a, c, b);
      ground.addTriangle(b, c, d);
    }
    ContactWorld w;
    w.add(std::make_unique<btBvhTriangleMeshShape>(&ground, true), 0, {0, 0, 0});
    const SoftBody<3>& body = w.add(cube(6 * kCell, kCell), settings_of(kCell, 0.6f, 0.3f), {0, 0.4f, 0});
    w.run(200);
    EXPECT_NEAR(ContactWorld::lowest_drawn(body), 0, 0.05f * kCell) << width;
    EXPECT_LT(ContactWorld::fastest(body), 0.05f) << width;
  }
}

TEST(SurfaceContacts, NothingPassesAThinWall) {
  constexpr float kCell = 0.1f;
  for (const float speed : {5.0f, 20.0f, 100.0f}) {
    ContactWorld w({0, 0, 0});
    w.add(std::make_unique<btBoxShape>(btVector3(0.05f * kCell, 3, 3)), 0, {1, 0, 0});
    SoftBody<3>& body = w.add(make_sphere(0.4f, 8), settings_of(kCell), {0, 0, 0});
    body.add_velocity({speed, 0, 0});
    for (int i = 0; i < 60; ++i) {
      w.run(1);
      for (const Vector3f& p : ContactWorld::drawn(body))
        ASSERT_LT(p.x(), 1.02f) << speed << " m/s, frame " << i;
    }
  }
}

/// At 100 m/s small cells go 40 of their length in a substep, and the wall is a tenth of one thick.
TEST(SurfaceContacts, NothingSmallPassesAThinWall) {
  constexpr float kCell = 0.02f;
  for (const int kind : {0, 1, 2}) {
    for (const float speed : {40.0f, 70.0f, 100.0f}) {
      ContactWorld w({0, 0, 0});
      const btVector3 half(0.05f * kCell, 3, 3);
      std::unique_ptr<btCollisionShape> wall = std::make_unique<btBoxShape>(half);
      if (kind == 1) {
        auto hull = std::make_unique<btConvexHullShape>();
        for (int i = 0; i < 8; ++i)
          hull->addPoint({(i & 1 ? 1.0f : -1.0f) * half.x(), (i & 2 ? 1.0f : -1.0f) * half.y(),
                          (i & 4 ? 1.0f : -1.0f) * half.z()});
        hull->setMargin(0);
        wall = std::move(hull);
      }
      btRigidBody& body_of_wall = w.add(std::move(wall), 0, {1, 0, 0});
      if (kind == 2) {
        body_of_wall.setCollisionFlags(body_of_wall.getCollisionFlags() |
                                       btCollisionObject::CF_KINEMATIC_OBJECT);
        body_of_wall.setLinearVelocity({-1, 0, 0});
      }
      SoftBody<3>& body = w.add(make_sphere(0.1f, 8), settings_of(kCell), {0.02f, 0.03f, 0.01f});
      body.add_velocity({speed, 0.2f * speed, 0.1f * speed});
      body.add_angular_velocity({10, 20, 30});
      for (int i = 0; i < 30; ++i) {
        w.run(1);
        for (const Vector3f& p : ContactWorld::drawn(body))
          ASSERT_LT(p.x(), 1.02f) << "wall " << kind << ", " << speed << " m/s, frame " << i;
      }
    }
  }
}

/// What a round body lies on.
enum class Ground { kPlane, kBox, kThinBox, kTriangles, kTiles };

/// A ball's lattice reaches beyond its drawn surface, and so into the ground. Nothing else holds these corners than contacts of their own.
struct Depth {
  float drawn, particles;  ///< in cells, at the end
};
Depth depth_of_ball(Ground ground, float alpha, float gravity, float cell) {
  btTriangleMesh triangles;
  ContactWorld w({0, -gravity, 0});
  switch (ground) {
    case Ground::kPlane:
      w.add(std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), 0), 0, {0, 0, 0});
      break;
    case Ground::kBox:
      w.add_floor();
      break;
    case Ground::kThinBox:
      w.add(std::make_unique<btBoxShape>(btVector3(5, cell, 5)), 0, {0, -cell, 0});
      break;
    case Ground::kTriangles:
      triangles.addTriangle({-20, 0, -20}, {-20, 0, 20}, {20, 0, 20});
      triangles.addTriangle({-20, 0, -20}, {20, 0, 20}, {20, 0, -20});
      w.add(std::make_unique<btBvhTriangleMeshShape>(&triangles, true), 0, {0, 0, 0});
      break;
    case Ground::kTiles:  // four meet below the ball
      for (const float x : {-1.0f, 1.0f})
        for (const float z : {-1.0f, 1.0f})
          w.add(std::make_unique<btBoxShape>(btVector3(1, 2 * cell, 1)), 0, {x, -2 * cell, z});
      break;
  }
  SoftBodySettings settings = settings_of(cell, alpha);
  settings.half_width = 1;
  const SoftBody<3>& body = w.add(make_sphere(3 * cell, 8), settings, {0, 3.1f * cell, 0});
  w.run(180, 1);
  Depth depth{-ContactWorld::lowest_drawn(body) / cell, 0};
  for (const Vector3f& p : body.positions()) depth.particles = std::max(depth.particles, -p.y() / cell);
  return depth;
}

TEST(SurfaceContacts, NoParticleOfABallSinksIntoAnyGround) {
  for (const float gravity : {9.81f, 300.0f})
    for (const float alpha : {0.05f, 0.3f}) {
      const Depth on_plane = depth_of_ball(Ground::kPlane, alpha, gravity, 0.05f);
      for (const Ground ground : {Ground::kBox, Ground::kThinBox, Ground::kTriangles}) {
        const Depth depth = depth_of_ball(ground, alpha, gravity, 0.05f);
        EXPECT_LT(depth.drawn, 0.1f) << "ground " << static_cast<int>(ground) << ", alpha " << alpha;
        EXPECT_LT(depth.particles, on_plane.particles + 0.15f)
            << "ground " << static_cast<int>(ground) << ", alpha " << alpha << ", " << gravity << " m/s^2";
      }
    }
}

TEST(SurfaceContacts, NothingSinksInWhereTilesMeet) {
  for (const float cell : {0.02f, 0.01f})
    for (const float alpha : {0.1f, 0.3f, 0.8f}) {
      const Depth depth = depth_of_ball(Ground::kTiles, alpha, 9.81f, cell);
      EXPECT_LT(depth.drawn, 0.1f) << "cells of " << cell << " m, alpha " << alpha;
      EXPECT_LT(depth.particles, 1.8f) << "cells of " << cell << " m, alpha " << alpha;
    }
}

/// A wall of triangles has no thickness. It holds from both sides, whichever way it is wound: two triangles, or 1,800 small ones.
TEST(SurfaceContacts, NothingPassesAWallOfTriangles) {
  constexpr float kCell = 0.1f;
  for (const int pieces : {1, 30}) {
    for (const float way : {1.0f, -1.0f}) {
      btTriangleMesh wall;
      const float edge = 6.0f / static_cast<float>(pieces);
      for (int y = 0; y < pieces; ++y) {
        for (int z = 0; z < pieces; ++z) {
          const btVector3 at(0, -3 + edge * static_cast<float>(y), -3 + edge * static_cast<float>(z));
          const btVector3 up(0, edge, 0), across(0, 0, edge);
          wall.addTriangle(at, at + up, at + up + across);
          wall.addTriangle(at, at + up + across, at + across);
        }
      }
      for (const float speed : {0.5f, 5.0f, 20.0f, 100.0f}) {
        for (const TriangleMesh& mesh : {make_sphere(0.2f, 8), cube(0.4f, kCell)}) {
          ContactWorld w({0, 0, 0});
          w.add(std::make_unique<btBvhTriangleMeshShape>(&wall, true), 0, {0, 0, 0});
          SoftBody<3>& body = w.add(mesh, settings_of(kCell), {-way, 0.03f, 0.02f});
          body.add_velocity({way * speed, 0, 0});
          float deepest = -1;
          const auto behind = [&] {
            float most = -1;
            for (const Vector3f& p : ContactWorld::drawn(body)) most = std::max(most, way * p.x());
            return most / kCell;
          };
          for (int i = 0; i < (speed < 1 ? 240 : 60); ++i) {
            w.run(1);
            deepest = std::max(deepest, behind());
          }
          // At 100 m/s it is pressed flat for a moment.
          EXPECT_LT(deepest, speed < 50 ? 0.25f : 0.75f) << pieces << " pieces, " << way * speed << " m/s";
          EXPECT_LT(behind(), 0.02f) << pieces << " pieces, " << way * speed << " m/s";
          EXPECT_LT(way * body.centre_of_mass().x(), -0.05f)
              << pieces << " pieces, " << way * speed << " m/s";
          EXPECT_LT(way * body.linear_momentum().x(), 0.1f * speed * body.model().mass())
              << "it has not come to the wall";
        }
      }
    }
  }
}

/// On the floor a body is on the front of the floor's triangles; on which side of the wall's it is follows from these alone.
TEST(SurfaceContacts, AWallInTheFloorsMeshHoldsFromBothSides) {
  constexpr float kCell = 0.1f;
  for (const bool in_the_middle : {true, false})
    for (const bool fronts_meet : {true, false}) {
      SCOPED_TRACE(testing::Message() << "in the middle " << in_the_middle << ", front " << fronts_meet);
      btTriangleMesh mesh;
      const auto quad = [&](const btVector3& a, const btVector3& b, const btVector3& c, const btVector3& d) {
        mesh.addTriangle(a, b, c);
        mesh.addTriangle(a, c, d);
      };
      // The wall stands on a side of the floor's triangles, or inside of them.
      const float end = in_the_middle ? 5 : 1;
      quad({-5, 0, -5}, {-5, 0, 5}, {end, 0, 5}, {end, 0, -5});
      if (!in_the_middle) quad({1, 0, -5}, {1, 0, 5}, {5, 0, 5}, {5, 0, -5});
      if (fronts_meet)
        quad({1, 0, 5}, {1, 3, 5}, {1, 3, -5}, {1, 0, -5});
      else
        quad({1, 0, 5}, {1, 0, -5}, {1, 3, -5}, {1, 3, 5});
      for (const float speed : {0.0f, 3.0f, 15.0f}) {
        ContactWorld w({4, -9.81f, 0});
        w.add(std::make_unique<btBvhTriangleMeshShape>(&mesh, true), 0, {0, 0, 0}, 0);
        SoftBody<3>& body = w.add(cube(0.4f, kCell), settings_of(kCell), {0.3f, 0.22f, 0});
        w.run(10);
        body.add_velocity({speed, 0, 0});
        for (int i = 0; i < 40; ++i) {
          w.run(5);
          float behind = -1;
          for (const Vector3f& p : ContactWorld::drawn(body)) behind = std::max(behind, p.x() - 1);
          ASSERT_LT(behind, 0.25f * kCell) << speed << " m/s, frame " << 5 * i;
          ASSERT_GT(ContactWorld::lowest_drawn(body), -0.25f * kCell);
        }
        EXPECT_GT(body.centre_of_mass().x(), 0.7f) << "it has come to the wall";
      }
    }
}

/// The middle of a thin sheet is always near what it slides on: where it has been must not lag behind.
TEST(SurfaceContacts, AThinSheetSlidesOverAHillOfTriangles) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of this file";
  const auto height = [](float x) { return x > 0 ? -0.3f * x * x : 0.0f; };
  for (const bool upwards : {true, false}) {
    btTriangleMesh hill;
    for (int k = -40; k < 160; ++k) {
      const float x = 0.05f * static_cast<float>(k), next = x + 0.05f;
      const btVector3 a(x, height(x), -2), b(x, height(x), 2), c(next, height(next), 2),
          d(next, height(next), -2);
      hill.addTriangle(a, upwards ? b : c, upwards ? c : b);
      hill.addTriangle(a, upwards ? c : d, upwards ? d : c);
    }
    for (const float thickness : {0.02f, 0.04f, 0.1f}) {
      SCOPED_TRACE(testing::Message() << thickness << " m, upwards: " << upwards);
      ContactWorld w;
      w.add(std::make_unique<btBvhTriangleMeshShape>(&hill, true), 0, {0, 0, 0}, 0);
      SoftBody<3>& sheet = w.add(make_box({0.3f, thickness, 0.3f}, 0.05f), settings_of(0.1f), {-1, 0.1f, 0});
      w.run(20);
      sheet.add_velocity({1, 0, 0});
      w.run(150);
      const Vector3f at = sheet.centre_of_mass();
      EXPECT_GT(at.x(), 0.5f);
      EXPECT_GT(at.y(), height(at.x()));
    }
  }
}

/// Two bodies that would change places in a substep hit each other, and part as slower ones do. Momentum is kept.
TEST(SurfaceContacts, FastBodiesDoNotPassEachOther) {
  for (const float speed : {5.0f, 10.0f, 20.0f, 40.0f, 100.0f}) {
    for (const TriangleMesh& mesh : {make_sphere(0.3f, 8), make_box({0.3f, 0.5f, 0.5f}, 0.1f)}) {
      for (const float off : {0.0f, 0.1f, 0.3f}) {
        ContactWorld w({0, 0, 0});
        SoftBody<3>& left = w.add(mesh, settings_of(0.1f), {-1 - off, 0.02f, 0});
        SoftBody<3>& right = w.add(mesh, settings_of(0.1f), {1, 0, 0.01f});
        left.add_velocity({speed, 0, 0});
        right.add_velocity({-speed, 0, 0});
        w.run(60);
        const float mass = left.model().mass(), parting = -left.linear_momentum().x() / mass;
        EXPECT_LT(left.centre_of_mass().x(), right.centre_of_mass().x() - 0.4f) << speed << " m/s, " << off;
        EXPECT_GT(parting, 0.1f * speed) << off;
        EXPECT_LT(parting, 0.7f * speed) << off;
        EXPECT_LT((left.linear_momentum() + right.linear_momentum()).norm(), 1e-4f * mass * speed);
      }
    }
  }
}

/// A closed mesh whose fronts are outside is a room for who is inside, and a box for who falls on it. What flies about in the room goes from
/// wall to wall.
TEST(SurfaceContacts, ARoomOfTrianglesHoldsWhatIsInIt) {
  const TriangleMesh box = make_box({2, 2, 2}, 0.5f);
  btTriangleMesh walls;
  const auto corner = [&](std::uint32_t i) {
    return btVector3(box.positions[i].x(), box.positions[i].y(), box.positions[i].z());
  };
  for (const auto& t : box.triangles) walls.addTriangle(corner(t[0]), corner(t[1]), corner(t[2]));
  ContactWorld w;
  w.add(std::make_unique<btBvhTriangleMeshShape>(&walls, true), 0, {0, 0, 0});
  SoftBody<3>& inside = w.add(make_sphere(0.25f, 8), settings_of(0.1f), {0, 0, 0});
  SoftBody<3>& on_top = w.add(cube(0.5f, 0.1f), settings_of(0.1f, 0.6f, 0.4f), {0.5f, 1.6f, 0.3f});
  inside.add_velocity({20, 15, 10});
  for (int i = 0; i < 240; ++i) {
    w.run(1);
    for (const Vector3f& p : ContactWorld::drawn(inside))
      ASSERT_LT(p.cwiseAbs().maxCoeff(), 1.02f) << "frame " << i;
  }
  EXPECT_NEAR(on_top.centre_of_mass().y(), 1.25f, 0.05f);
}

/// A floor of a thousand kilometres and a body of millimetres, thrown as fast as numbers allow: no loop runs for ever.
TEST(SurfaceContacts, SizesAndSpeedsOfAllKindsEndInTime) {
  constexpr float kCell = 0.001f;
  ContactWorld w({0, 0, 0});
  w.add(std::make_unique<btBoxShape>(btVector3(1e6f, 1, 1e6f)), 0, {0, -1, 0});
  SoftBody<3>& body = w.add(cube(6 * kCell, kCell), settings_of(kCell), {0, 5 * kCell, 0});
  for (const float speed : {1.0f, 1e3f, 1e6f, 1e12f}) {
    body.add_velocity({speed, -speed, 0});
    w.run(1, 1);
    for (const Vector3f& velocity : body.velocities()) ASSERT_TRUE(velocity.allFinite()) << speed << " m/s";
  }
  body.add_velocity({3e38f, 3e38f, 0});
  EXPECT_THROW(w.run(2, 1), std::runtime_error);
}

TEST(SurfaceContacts, TwoBodiesKeepTheirMomenta) {
  ContactWorld w({0, 0, 0});
  SoftBody<3>& left = w.add(make_sphere(0.4f, 12), settings_of(0.1f), {0, 0, 0});
  SoftBody<3>& right = w.add(make_penguin(0.9f), settings_of(0.12f), {1.1f, 0.1f, 0.05f});
  left.add_velocity({3, 0.2f, 0});
  right.add_velocity({-1, 0, 0.3f});
  right.add_angular_velocity({0, 2, 1});
  const auto momentum = [&] {
    return Eigen::Vector3d((left.linear_momentum() + right.linear_momentum()).cast<double>());
  };
  const auto spin = [&] {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const SoftBody<3>* body : {&left, &right})
      for (std::size_t i = 0; i < body->model().particles(); ++i)
        sum += double{body->model().masses()[i]} *
               body->position(i).cast<double>().cross(body->velocities()[i].cast<double>());
    return sum;
  };
  const Eigen::Vector3d p = momentum(), l = spin();
  const double size = left.linear_momentum().norm();
  float most = 0;
  for (int i = 0; i < 500; ++i) {
    w.run(1);
    most = std::max(most, (left.linear_momentum() - 3 * left.model().mass() * Vector3f::UnitX()).norm());
  }
  EXPECT_GT(most, 0.5f * static_cast<float>(size)) << "they have met";
  EXPECT_LT((momentum() - p).norm(), 1e-5 * size);
  EXPECT_LT((spin() - l).norm(), 2e-3 * size)
      << "positions that are pushed apart turn nothing but in rounding";
}

TEST(SurfaceContacts, AHeavyBoxRestsOnASoftOne) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of this file";
  constexpr float kCell = 0.15f;
  ContactWorld w;
  w.add_floor();
  SoftBody<3>& body = w.add(make_box({14 * kCell, 4 * kCell, 14 * kCell}, kCell),
                            settings_of(kCell, 0.7f, 0.3f), {0, 2 * kCell, 0});
  btRigidBody& box = w.add(std::make_unique<btBoxShape>(btVector3(0.4f, 0.2f, 0.4f)), 2 * body.model().mass(),
                           {0, 4 * kCell + 0.21f, 0});
  w.run(600);
  const float height = box.getWorldTransform().getOrigin().y();
  EXPECT_GT(height, 0.2f + kCell);
  w.run(600);
  EXPECT_NEAR(box.getWorldTransform().getOrigin().y(), height, 0.05f * kCell);
  EXPECT_LT(box.getLinearVelocity().length(), 0.02f);
}

TEST(SurfaceContacts, ABoxThrownAtABodyKeepsTheirMomentum) {
  ContactWorld w({0, 0, 0});
  SoftBody<3>& body = w.add(cube(0.8f, 0.1f), settings_of(0.1f), {0, 0, 0});
  const float mass = 2 * body.model().mass();
  btRigidBody& box = w.add(std::make_unique<btBoxShape>(btVector3(0.2f, 0.2f, 0.2f)), mass, {-1, 0.05f, 0});
  box.setLinearVelocity({4, 0, 0});
  w.run(120);
  const Vector3f momentum = body.linear_momentum() + mass * to_eigen(box.getLinearVelocity());
  EXPECT_LT((momentum - Vector3f(4 * mass, 0, 0)).norm(), 1e-5f * 4 * mass);
  EXPECT_GT(body.linear_momentum().x(), 0.4f * 4 * mass);
}

TEST(SurfaceContacts, ThinAndPointedThingsStayOutside) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of this file";
  constexpr float kCell = 0.1f;
  struct Thing {
    const char* name;
    std::unique_ptr<btCollisionShape> shape;
    Vector3f position, tip;
  };
  std::vector<Thing> things;
  things.push_back(
      {"cone", std::make_unique<btConeShape>(0.3f, 0.6f), {0.03f, 0.3f, 0.02f}, {0.03f, 0.6f, 0.02f}});
  things.push_back({"knife",
                    std::make_unique<btBoxShape>(btVector3(0.01f, 0.3f, 1)),
                    {0.04f, 0.3f, 0},
                    {0.04f, 0.6f, 0.13f}});
  things.push_back(
      {"wire", std::make_unique<btCapsuleShapeZ>(0.005f, 2), {0.04f, 0.3f, 0}, {0.04f, 0.3f, 0.13f}});
  for (const float radius : {0.005f, 0.02f, 0.04f}) {
    auto rod = std::make_unique<btCylinderShapeZ>(btVector3(radius, radius, 1));
    rod->setMargin(0.1f * radius);
    things.push_back({"rod", std::move(rod), {0.04f, 0.3f, 0}, {0.04f, 0.3f, 0.13f}});
  }
  for (const float radius : {0.02f, 0.1f}) {
    auto needle = std::make_unique<btConeShapeZ>(radius, 2.0f);
    needle->setMargin(0.01f * radius);
    things.push_back({"lying needle", std::move(needle), {0.04f, 0.3f, 0}, {0.04f, 0.3f, 0.33f}});
  }
  for (Thing& thing : things) {
    ContactWorld w;
    w.add_floor();
    w.add(std::move(thing.shape), 0, thing.position);
    const SoftBody<3>& body = w.add(make_sphere(0.42f, 12), settings_of(kCell, 0.7f, 0.2f), {0, 1.1f, 0});
    for (int i = 0; i < 240; ++i) {
      w.run(1);
      if (i % 6 != 0) continue;
      ASSERT_LT(ContactWorld::depth_in_drawn(body, thing.tip), 0.3f * kCell) << thing.name << ' ' << i;
    }
  }
}

TEST(SurfaceContacts, WhatRestsSleepsAndWakesWhereItIsTouched) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of this file";
  ContactWorld w;
  w.add_floor();
  w.bodies.let_sleep(SleepSettings{.speed = 0.1f, .seconds = 0.5f});
  const auto model = make_soft_body_model(make_box({1.2f, 0.4f, 1.2f}, 0.1f), settings_of(0.1f, 0.6f, 0.4f));
  SoftBody<3>& lower = w.bodies.add(model, {0, 0.21f, 0});
  SoftBody<3>& far = w.bodies.add(model, {5, 0.21f, 0});
  w.run(200);
  ASSERT_TRUE(lower.asleep() && far.asleep());
  SoftBody<3>& upper = w.bodies.add(model, {0.1f, 0.9f, 0});
  w.run(30);
  EXPECT_FALSE(lower.asleep());
  EXPECT_TRUE(far.asleep());
  w.run(900);
  EXPECT_TRUE(upper.asleep() && lower.asleep());
  EXPECT_NEAR(upper.centre_of_mass().y() - lower.centre_of_mass().y(), 0.37f, 0.08f);
}

/// What creeps is met, too, by more than contacts let it be in the sleeper.
TEST(SurfaceContacts, ASleeperNoticesWhatCreeps) {
  for (const float speed : {0.02f, 0.045f}) {
    ContactWorld w;
    btRigidBody& floor = w.add_floor();
    w.bodies.let_sleep(SleepSettings{});
    const SoftBody<3>& body = w.add(cube(0.4f, 0.1f), settings_of(0.1f, 0.6f, 0.4f), {0, 0.2f, 0});
    w.run(240);
    ASSERT_TRUE(body.asleep());
    btRigidBody& wall = w.add(std::make_unique<btBoxShape>(btVector3(0.5f, 1, 1)), 0, {-0.72f, 1, 0});
    wall.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
    wall.setActivationState(DISABLE_DEACTIVATION);
    const float before = body.centre_of_mass().x();
    float x = -0.72f;
    for (; x < -0.4f; x += speed / 60) {
      wall.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(x, 1, 0)));
      w.run(1);
    }
    EXPECT_NEAR(body.centre_of_mass().x(), before + 0.3f, 0.04f) << speed << " m/s";
    w.run(240);
    ASSERT_TRUE(body.asleep());
    floor.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(0, -1.3f, 0)));
    w.run(120);
    EXPECT_LT(body.bounds().low.y(), -0.2f) << "what it lay on is elsewhere";
  }
}

TEST(SurfaceContacts, ASoftBodyAndTheRigidOneOnItFallAsleepTogetherAndWakeTogether) {
  for (const float mass : {1.0f, 20.0f}) {
    ContactWorld w;
    w.add_floor();
    w.bodies.let_sleep(SleepSettings{});
    const SoftBody<3>& body = w.add(cube(0.6f, 0.2f), settings_of(0.2f, 0.8f, 0.4f), {0, 0.3f, 0});
    btRigidBody& box = w.add(std::make_unique<btBoxShape>(btVector3(0.2f, 0.2f, 0.2f)), mass, {0, 0.9f, 0});
    w.run(900);
    EXPECT_TRUE(body.asleep()) << mass;
    EXPECT_FALSE(box.isActive()) << mass;
    const btVector3 place = box.getWorldTransform().getOrigin();
    w.run(300);
    EXPECT_LT((box.getWorldTransform().getOrigin() - place).length(), 1e-4f);
    box.activate(true);
    box.setLinearVelocity({0, 3, 0});
    w.run(20);
    EXPECT_GT(box.getWorldTransform().getOrigin().y(), place.y() + 0.2f);
    w.run(40);
    EXPECT_FALSE(body.asleep()) << "it falls on it";
  }
}

TEST(SurfaceContacts, ASleeperFallsWhenTheBodyBelowIsTakenAway) {
  const std::vector<std::function<void(SoftBody<3>&)>> ways = {
      [](SoftBody<3>& lower) {
        lower.translate({5, 0, 0});
      },
      [](SoftBody<3>& lower) {
        lower.reset({5, 1, 0});
      },
  };
  for (const auto& take_away : ways) {
    ContactWorld w;
    w.add_floor();
    w.bodies.let_sleep(SleepSettings{});
    SoftBody<3>& lower = w.add(cube(0.6f, 0.2f), settings_of(0.2f, 0.8f, 0.4f), {0, 0.3f, 0});
    const SoftBody<3>& upper = w.add(cube(0.6f, 0.2f), settings_of(0.2f, 0.8f, 0.4f), {0, 0.9f, 0});
    w.run(600);
    ASSERT_TRUE(lower.asleep() && upper.asleep());
    take_away(lower);
    w.run(240);
    EXPECT_LT(upper.centre_of_mass().y(), 0.4f);
  }
}

TEST(SurfaceContacts, ARigidSleeperFallsWhateverHappensToTheSoftBodyBelow) {
  const std::vector<std::function<void(std::unique_ptr<BulletSoftBodies>&, SoftBody<3>&)>> ways = {
      [](auto& bodies, SoftBody<3>& lower) { bodies->remove(lower); },
      [](auto& /*bodies*/, SoftBody<3>& lower) {
        lower.translate({5, 0, 0});
      },
      [](auto& /*bodies*/, SoftBody<3>& lower) {
        lower.reset({5, 1, 0});
      },
      [](auto& bodies, SoftBody<3>& lower) { bodies->set_filter(lower, {.group = 1, .mask = 2}); },
      [](auto& bodies, SoftBody<3>& lower) {
        for (SoftBody<3>* piece : bodies->cut(lower, Cut::plane({0.01f, 0.3f, 0}, {1, 0, 0})))
          bodies->remove(*piece);
        bodies->remove(lower);
      },
      [](auto& bodies, SoftBody<3>& /*lower*/) { bodies.reset(); },
  };
  for (std::size_t way = 0; way < ways.size(); ++way) {
    SCOPED_TRACE(way);
    ContactWorld w;
    w.add_floor();
    auto bodies = std::make_unique<BulletSoftBodies>(w.world);
    bodies->let_sleep(SleepSettings{});
    SoftBody<3>& lower =
        bodies->add(make_soft_body_model(cube(0.6f, 0.2f), settings_of(0.2f, 0.8f, 0.4f)), {0, 0.3f, 0});
    const btRigidBody& box =
        w.add(std::make_unique<btBoxShape>(btVector3(0.2f, 0.2f, 0.2f)), 5, {0, 0.8f, 0});
    w.run(600);
    ASSERT_TRUE(lower.asleep() && !box.isActive());
    ways[way](bodies, lower);
    w.run(120);
    EXPECT_LT(box.getWorldTransform().getOrigin().y(), 0.3f);
  }
}

TEST(SurfaceContacts, ASleeperFallsWhateverTakesTheFloorAway) {
  btBoxShape small(btVector3(5, 0.1f, 5));
  const std::vector<std::pair<const char*, std::function<void(ContactWorld&, btRigidBody&)>>> ways = {
      {"removed", [](ContactWorld& w, btRigidBody& floor) { w.world.removeRigidBody(&floor); }},
      {"filtered",
       [](ContactWorld& w, btRigidBody& floor) {
         w.world.removeRigidBody(&floor);
         w.world.addRigidBody(&floor, btBroadphaseProxy::StaticFilter, 0);
       }},
      {"filtered in place",
       [](ContactWorld&, btRigidBody& floor) { floor.getBroadphaseHandle()->m_collisionFilterMask = 0; }},
      {"another shape", [&](ContactWorld&, btRigidBody& floor) { floor.setCollisionShape(&small); }},
      {"smaller",
       [](ContactWorld&, btRigidBody& floor) {
         floor.getCollisionShape()->setLocalScaling({1, 0.1f, 1});
       }},
      {"a trigger volume",
       [](ContactWorld&, btRigidBody& floor) {
         floor.setCollisionFlags(floor.getCollisionFlags() | btCollisionObject::CF_NO_CONTACT_RESPONSE);
       }},
      {"far away",
       [](ContactWorld& w, btRigidBody& floor) {
         floor.getWorldTransform().setOrigin({500, -1, 0});
         w.world.updateSingleAabb(&floor);
       }},
  };
  for (const auto& [name, take_away] : ways) {
    ContactWorld w;
    btRigidBody& floor = w.add_floor();
    w.bodies.let_sleep(SleepSettings{});
    const SoftBody<3>& body = w.add(cube(0.4f, 0.1f), settings_of(0.1f, 0.6f, 0.4f), {0, 0.2f, 0});
    w.run(240);
    ASSERT_TRUE(body.asleep());
    take_away(w, floor);
    w.run(30);
    EXPECT_LT(body.bounds().low.y(), -0.5f) << name;
  }
}

TEST(SurfaceContacts, ASleeperSleepsOnWhenSomethingFarIsRemoved) {
  ContactWorld w;
  w.add_floor();
  btRigidBody& far = w.add(std::make_unique<btBoxShape>(btVector3(1, 1, 1)), 0, {8, 1, 0});
  w.add(std::make_unique<btBoxShape>(btVector3(1, 1, 1)), 0, {-8, 1, 0});  // takes its place in the list
  w.bodies.let_sleep(SleepSettings{});
  const SoftBody<3>& body = w.add(cube(0.4f, 0.1f), settings_of(0.1f, 0.6f, 0.4f), {0, 0.2f, 0});
  w.run(240);
  ASSERT_TRUE(body.asleep());
  w.world.removeRigidBody(&far);
  w.run(10);
  EXPECT_TRUE(body.asleep());
}

/// Sleepers of different sizes share what says that nothing moves them.
TEST(SurfaceContacts, SleepersOfAllSizesHoldWhatTouchesThem) {
  ContactWorld w({0, 0, 0});
  w.bodies.let_sleep(SleepSettings{.speed = 0.1f, .seconds = 0.1f});
  SoftBody<3>& small = w.add(cube(0.4f, 0.1f), settings_of(0.1f), {0, 0, 0});
  SoftBody<3>& large = w.add(cube(1.2f, 0.1f), settings_of(0.1f), {5, 0, 0});
  w.run(30);
  ASSERT_TRUE(small.asleep() && large.asleep());
  SoftBody<3>& thrown = w.add(cube(0.4f, 0.1f), settings_of(0.1f), {0, 0.5f, 0});
  thrown.add_velocity({0, -2, 0});
  const Vector3f momentum = thrown.linear_momentum();
  w.run(30);
  EXPECT_FALSE(small.asleep());
  EXPECT_TRUE(large.asleep());
  EXPECT_LT((thrown.linear_momentum() + small.linear_momentum() - momentum).norm(), 0.2f * momentum.norm());
}

/// Both get another model, of other particles: the world has to notice that of each of them.
TEST(SurfaceContacts, TwoBodiesExchangeTheirStates) {
  ContactWorld w;
  w.add_floor();
  SoftBody<3>& box = w.add(make_box({0.3f, 0.3f, 0.3f}, 0.1f), settings_of(0.1f), {0, 0.3f, 0});
  SoftBody<3>& ball = w.add(make_sphere(0.3f, 6), settings_of(0.15f), {2, 0.5f, 0});
  w.run(20);
  const std::uint64_t of_box = state_hash(box), of_ball = state_hash(ball);
  box = std::move(ball);
  EXPECT_EQ(state_hash(ball), of_box);
  EXPECT_EQ(state_hash(box), of_ball);
  w.run(180);
  for (const SoftBody<3>* const body : {&box, &ball}) {
    EXPECT_GT(ContactWorld::lowest_drawn(*body), -0.01f);
    EXPECT_LT(ContactWorld::lowest_drawn(*body), 0.01f);
    EXPECT_LT(ContactWorld::fastest(*body), 0.05f);
  }
  EXPECT_NEAR(box.centre_of_mass().x(), 2, 0.02f);
  EXPECT_NEAR(ball.centre_of_mass().x(), 0, 0.02f);
}

TEST(SurfaceContacts, KindsOfShapesHoldABody) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of this file";
  const auto mesh = [](std::vector<btVector3> corners, btTriangleMesh& triangles) {
    triangles.addTriangle(corners[0], corners[1], corners[2]);
    triangles.addTriangle(corners[0], corners[2], corners[3]);
  };
  btTriangleMesh ground, ground_from_below;
  mesh({{-3, 0, -3}, {-3, 0, 3}, {3, 0, 3}, {3, 0, -3}}, ground);
  mesh({{-3, 0, -3}, {3, 0, -3}, {3, 0, 3}, {-3, 0, 3}}, ground_from_below);
  std::vector<std::pair<const char*, std::unique_ptr<btCollisionShape>>> shapes;
  shapes.emplace_back("plane", std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), 0));
  shapes.emplace_back("triangles", std::make_unique<btBvhTriangleMeshShape>(&ground, true));
  shapes.emplace_back("triangles wound the other way",
                      std::make_unique<btBvhTriangleMeshShape>(&ground_from_below, true));
  btTriangleMesh fine, fine_from_below;
  for (int x = -20; x < 20; ++x) {
    for (int z = -20; z < 20; ++z) {
      const auto at = [](int i, int j) {
        return btVector3(0.05f * static_cast<float>(i), 0, 0.05f * static_cast<float>(j));
      };
      mesh({at(x, z), at(x, z + 1), at(x + 1, z + 1), at(x + 1, z)}, fine);
      mesh({at(x, z), at(x + 1, z), at(x + 1, z + 1), at(x, z + 1)}, fine_from_below);
    }
  }
  shapes.emplace_back("fine triangles", std::make_unique<btBvhTriangleMeshShape>(&fine, true));
  shapes.emplace_back("fine triangles wound the other way",
                      std::make_unique<btBvhTriangleMeshShape>(&fine_from_below, true));
  auto hull = std::make_unique<btConvexHullShape>();
  for (int i = 0; i < 8; ++i)
    hull->addPoint(
        btVector3((i & 1) != 0 ? 2.f : -2.f, (i & 2) != 0 ? 0.f : -1.f, (i & 4) != 0 ? 2.f : -2.f));
  shapes.emplace_back("hull", std::move(hull));
  // Without thickness.
  auto flat_hull = std::make_unique<btConvexHullShape>();
  for (int i = 0; i < 4; ++i)
    flat_hull->addPoint(btVector3((i & 1) != 0 ? 2.f : -2.f, 0, (i & 2) != 0 ? 2.f : -2.f));
  shapes.emplace_back("flat hull", std::move(flat_hull));
  auto triangle = std::make_unique<btConvexHullShape>();
  for (const btVector3& corner : {btVector3(-3, 0, -2), btVector3(3, 0, -2), btVector3(0, 0, 3)})
    triangle->addPoint(corner);
  shapes.emplace_back("hull of a triangle", std::move(triangle));
  shapes.emplace_back("flat box", std::make_unique<btBoxShape>(btVector3(2, 0, 2)));
  shapes.emplace_back("flat cylinder", std::make_unique<btCylinderShape>(btVector3(2, 0, 2)));
  shapes.emplace_back("capsule", std::make_unique<btCapsuleShapeX>(0.0f + 0.4f, 4));
  shapes.emplace_back("cylinder", std::make_unique<btCylinderShape>(btVector3(1, 0.5f, 1)));
  shapes.emplace_back("sphere", std::make_unique<btSphereShape>(3));
  for (auto& [name, shape] : shapes) {
    ContactWorld w;
    const std::string kind = name;
    const float top = kind == "capsule" ? 0.4f : kind == "cylinder" ? 0.5f : kind == "sphere" ? 3.0f : 0.0f;
    w.add(std::move(shape), 0, {0, -top, 0});
    const SoftBody<3>& body = w.add(cube(0.8f, 0.1f), settings_of(0.1f, 0.6f, 0.4f), {0, 0.45f, 0});
    w.run(200);
    EXPECT_NEAR(body.centre_of_mass().y(), 0.37f, 0.07f) << kind;
  }
}

TEST(SurfaceContacts, HullsWithoutLengthTouchNothing) {
  for (const int points : {0, 1, 8}) {
    ContactWorld w;
    w.add_floor();
    auto hull = std::make_unique<btConvexHullShape>();
    for (int i = 0; i < points; ++i) hull->addPoint(btVector3(0.1f, 0, 0));
    w.add(std::move(hull), 0, {0, 0.3f, 0});
    const SoftBody<3>& body = w.add(cube(0.8f, 0.1f), settings_of(0.1f, 0.6f, 0.4f), {0, 0.45f, 0});
    w.run(100);
    EXPECT_NEAR(body.centre_of_mass().y(), 0.37f, 0.07f) << points;
  }
}

}  // namespace
}  // namespace softcell::ppu
