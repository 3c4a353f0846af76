// Soft and small bodies on what stands still: nothing sinks in, and size does not matter.

#include <gtest/gtest.h>

#include <chrono>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "contact_world.h"
#include "ppu/bodies/processor_time.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

/// The lowest that a particle comes, inner ones included, of a cube of ten cells that falls on a floor, in cells.
float lowest_particle(float cell, float alpha, int half_width, float gravity, int substeps, int frames) {
  ContactWorld w({0, -gravity, 0});
  w.add_floor();
  SoftBodySettings settings = settings_of(cell, alpha, 0.05f);
  settings.half_width = half_width;
  const SoftBody<3>& body =
      w.add(make_box({10 * cell, 10 * cell, 10 * cell}, cell), settings, {0, 5.1f * cell, 0});
  float lowest = std::numeric_limits<float>::max();
  for (int i = 0; i < frames; ++i) {
    w.run(1, substeps);
    for (const Vector3f& x : body.positions()) lowest = std::min(lowest, x.y() / cell);
  }
  return lowest;
}

TEST(SoftOnRigid, NoParticleOfAVerySoftBodySinksIn) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of this file";
  for (const float alpha : {0.0f, 0.02f})
    for (const int half_width : {1, 2})
      EXPECT_GT(lowest_particle(0.1f, alpha, half_width, 9.81f, 2, 150), -0.1f) << alpha << ' ' << half_width;
}

TEST(SoftOnRigid, NoParticleSinksInUnderStrongGravityWithOneSubstep) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of this file";
  for (const float alpha : {0.02f, 0.3f, 1.0f})
    EXPECT_GT(lowest_particle(0.05f, alpha, 2, 300, 1, 150), -0.1f) << alpha;
}

/// Two balls fall side by side, one onto the other's shoulder.
struct Scaled {
  std::vector<Vector3f> drawn;  // in cells
  std::size_t contacts = 0;     // of all frames
  double seconds = 0;           // of this thread's processor time
};

Scaled run_at_scale(float cell) {
  const float scale = cell / 0.1f;
  ContactWorld w({0, -9.81f * scale, 0});
  w.add(std::make_unique<btBoxShape>(btVector3(10 * scale, scale, 10 * scale)), 0, {0, -scale, 0});
  const auto model = make_soft_body_model(make_sphere(4 * cell, 16), settings_of(cell, 0.5f, 0.3f));
  const SoftBody<3>& left = w.bodies.add(model, {-4.1f * cell, 4.2f * cell, 0});
  const SoftBody<3>& right = w.bodies.add(model, {3.6f * cell, 5 * cell, 0});
  Scaled result;
  const auto begin = processor_time();
  std::vector<Contact> contacts;
  for (int i = 0; i < 120; ++i) {
    w.run(1);
    contacts.clear();
    w.bodies.append_contacts(contacts);
    result.contacts += contacts.size();
  }
  result.seconds = std::chrono::duration<double>(processor_time() - begin).count();
  for (const SoftBody<3>* body : {&left, &right})
    for (const Vector3f& p : ContactWorld::drawn(*body)) result.drawn.push_back(p / cell);
  return result;
}

/// Cells are 1 mm to 100 m. The scene is 16 cells wide, so this is 0.3 % of it.
TEST(SoftOnRigid, TheSceneEndsInTheSameShapeForTheSameCostAtEveryScale) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of this file";
  const Scaled expected = run_at_scale(0.1f);
  EXPECT_GT(expected.contacts, 1000u);
  for (const float cell : {0.001f, 0.003f, 0.01f, 1.0f, 100.0f}) {
    const Scaled here = run_at_scale(cell);
    float most = 0;
    for (std::size_t i = 0; i < here.drawn.size(); ++i)
      most = std::max(most, (here.drawn[i] - expected.drawn[i]).norm());
    EXPECT_LT(most, 0.05f) << "cells of " << cell << " m";
    const double contacts = static_cast<double>(here.contacts) / static_cast<double>(expected.contacts);
    EXPECT_NEAR(contacts, 1, 0.2) << "cells of " << cell << " m";
    // Hosts are noisy; what once exploded did so by a factor of 60 from 0.1 m to 3 mm.
    EXPECT_LT(here.seconds, 3 * expected.seconds) << "cells of " << cell << " m";
    RecordProperty("scale", std::to_string(cell) + ": " + std::to_string(most) + " cells, contacts times " +
                                std::to_string(contacts) + ", " + std::to_string(here.seconds) + " s");
  }
}

}  // namespace
}  // namespace softcell::ppu
