// Friction of what is drawn, against the formula of a block on a slope.

#include <BulletCollision/CollisionShapes/btHeightfieldTerrainShape.h>
#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <memory>
#include <vector>

#include "contact_world.h"
#include "softcell/spe_bodies/spe_runtime.h"

namespace softcell::ppu {
namespace {

/// A slope, gravity turned: a block, planks across it side by side, two triangles in each square of a grid, or a height field.
enum class Slope { kBox, kPlanks, kTriangles, kHeights };

/// The lists and meshes that Bullet's shapes only refer to.
struct Ground {
  btTriangleMesh triangles;
  std::vector<float> heights = std::vector<float>(64 * 64);
  std::unique_ptr<btBoxShape> plank;
};

std::unique_ptr<btCollisionShape> shape_of(Slope slope, float cell, Ground& ground) {
  if (slope == Slope::kBox) return std::make_unique<btBoxShape>(btVector3(500 * cell, 10 * cell, 500 * cell));
  const float square = 1.3f * cell;
  if (slope == Slope::kPlanks) {
    ground.plank = std::make_unique<btBoxShape>(btVector3(square / 2, cell, 50 * cell));
    auto shape = std::make_unique<btCompoundShape>();
    for (int i = -7; i < 53; ++i)
      shape->addChildShape(
          btTransform(btMatrix3x3::getIdentity(), {static_cast<float>(i) * square, -cell, 0}),
          ground.plank.get());
    return shape;
  }
  if (slope == Slope::kHeights) {
    auto shape = std::make_unique<btHeightfieldTerrainShape>(64, 64, ground.heights.data(), 1.0f, -1.0f, 1.0f,
                                                             1, PHY_FLOAT, false);
    shape->setLocalScaling(btVector3(square, 1, square));
    return shape;
  }
  constexpr int kSquares = 60;  // of 60 x 60, the block begins near the seventh
  const auto at = [&](int i, int j) {
    return btVector3(static_cast<float>(i - 7) * square, 0, static_cast<float>(j - 7) * square);
  };
  for (int i = 0; i < kSquares; ++i)
    for (int j = 0; j < kSquares; ++j) {
      ground.triangles.addTriangle(at(i, j), at(i, j + 1), at(i + 1, j));
      ground.triangles.addTriangle(at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
    }
  return std::make_unique<btBvhTriangleMeshShape>(&ground.triangles, true);
}

struct Slide {
  float friction = 0.5f;
  float steeper = 1.2f;  ///< than the angle of friction: tangents
  float cell = 0.1f;     ///< metres
  int substeps = 2;      ///< of a frame
  Slope on = Slope::kBox;
  float angle() const { return std::atan(steeper * friction); }
};

/// How far a flat block slides down a slope in 1 s, metres, beside the way that it would go without acceleration.
float slide_of_block(const Slide& slide, int frames_before, SolverFactory* solvers) {
  Ground ground;
  ContactWorld w({9.81f * std::sin(slide.angle()), -9.81f * std::cos(slide.angle()), 0}, solvers);
  const SoftBodySettings settings = settings_of(slide.cell, 0.7f, 0.3f);
  const float cell = slide.cell;
  w.add(shape_of(slide.on, cell, ground), 0, {0, slide.on == Slope::kBox ? -10 * cell : 0, 0},
        slide.friction / settings.friction);
  const SoftBody<3>& block =
      w.add(make_box({6 * cell, 2 * cell, 6 * cell}, cell), settings, {0, 1.02f * cell, 0});
  w.run(frames_before, slide.substeps);
  const float x = block.centre_of_mass().x(), v = block.linear_momentum().x() / block.model().mass();
  w.run(60, slide.substeps);
  return block.centre_of_mass().x() - x - v;
}

void expect_coulomb(Slide slide, std::initializer_list<float> steeper, SolverFactory* solvers) {
  // 3 % below the angle of friction it sticks, once it has come to rest.
  slide.steeper = 0.97f;
  EXPECT_NEAR(slide_of_block(slide, 120, solvers), 0, 1e-3f) << slide.friction;
  for (const float steep : steeper) {
    slide.steeper = steep;
    const float way = 0.5f * 9.81f * (std::sin(slide.angle()) - slide.friction * std::cos(slide.angle()));
    EXPECT_NEAR(slide_of_block(slide, 30, solvers), way, 0.03f * way) << slide.friction << ' ' << steep;
  }
}

void expect_coulomb(SolverFactory* solvers) {
  for (const float friction : {0.2f, 0.5f, 1.0f})
    expect_coulomb({.friction = friction}, {1.03f, 1.2f, 1.6f}, solvers);
}

TEST(Friction, ABlockSticksOrSlidesDownASlopeByCoulombsLaw) { expect_coulomb(nullptr); }

TEST(Friction, ABlockSticksOrSlidesDownASlopeByCoulombsLawOnSpes) {
  SpeRuntime spes({.spes = 2});
  expect_coulomb(&spes);
}

// Sides and corners of triangles within a plane are no edges: they used to push at the rim of the block's flat side, sideways.
TEST(Friction, TrianglesInAPlaneAreAsOneSlope) {
  SpeRuntime spes({.spes = 2});
  for (const Slope on : {Slope::kTriangles, Slope::kHeights})
    for (const float friction : {0.3f, 0.8f}) {
      expect_coulomb({.friction = friction, .cell = 0.03f, .on = on}, {1.2f}, nullptr);
      expect_coulomb({.friction = friction, .substeps = 1, .on = on}, {1.2f}, &spes);
    }
}

TEST(Friction, PlanksSideBySideAreAsOneSlope) {
  SpeRuntime spes({.spes = 2});
  for (const float friction : {0.3f, 0.8f}) {
    expect_coulomb({.friction = friction, .cell = 0.03f, .on = Slope::kPlanks}, {1.2f}, nullptr);
    expect_coulomb({.friction = friction, .substeps = 1, .on = Slope::kPlanks}, {1.2f}, &spes);
  }
}

/// A rigid block of 0.3 m that slides on a slab with a friction of 0.1.
struct SlidingBlock {
  ContactWorld w;
  btRigidBody* block;

  explicit SlidingBlock(float mass, SolverFactory* solvers = nullptr) : w({0, -9.81f, 0}, solvers) {
    constexpr float kCell = 0.1f;
    const SoftBodySettings settings = settings_of(kCell, 0.7f, 0.3f);
    w.add_floor();
    w.add(make_box({4, 0.3f, 1}, kCell), settings, {0, 0.15f, 0});
    block = &w.add(std::make_unique<btBoxShape>(btVector3(0.15f, 0.15f, 0.15f)), mass, {-1.5f, 0.45f, 0},
                   0.1f / settings.friction);
    block->setDamping(0, 0);
    w.run(40);
  }
  float speed() const { return block->getLinearVelocity().x(); }
};

/// The surface ahead of it stands a little above its bottom: what it has not pressed down yet is no step that stops it.
TEST(Friction, ARigidBlockSlidesOnASoftSurface) {
  SpeRuntime spes({.spes = 2});
  for (SolverFactory* solvers : {static_cast<SolverFactory*>(nullptr), static_cast<SolverFactory*>(&spes)})
    for (const float mass : {2.0f, 20.0f})
      for (const float speed : {0.7f, 3.0f}) {
        SCOPED_TRACE(mass);
        SlidingBlock slide(mass, solvers);
        slide.block->setLinearVelocity({speed, 0, 0});
        slide.w.run(30);
        // The heavy one goes on to press the slab down by a quarter of a cell.
        const float without_dent = speed - 0.5f * 0.1f * 9.81f;
        EXPECT_NEAR(slide.speed(), without_dent, mass < 10 ? 0.02f : 0.15f);
        EXPECT_LT(std::abs(slide.block->getAngularVelocity().z()), 0.3f);
      }
}

}  // namespace
}  // namespace softcell::ppu
