#include "softcell/soft_bodies/soft_body.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "ppu/fracture/cracks.h"
#include "ppu/lattice/embedding.h"
#include "soft_body_scenes.h"
#include "softcell/soft_bodies/shapes.h"
#include "softcell/soft_bodies/state_hash.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

SoftBodySettings rubber() {
  return {.cell_size = 0.2f, .half_width = 2, .density = 200, .alpha = 0.5f, .damping = 0.1f};
}

TEST(SoftBody, ATimeStepIsAboveZero) {
  SoftBody<3> body(block_model({1, 1, 1}, rubber()));
  for (const float step : {0.0f, -1.0f, NAN, INFINITY})
    EXPECT_THROW(body.pull(step), std::invalid_argument) << step;
}

/// The message of a refusal, or "accepted".
std::string verdict_on(const SoftBodySettings& settings) {
  try {
    validate(settings);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

TEST(SoftBodySettings, RefuseValuesOutOfTheirRangeByName) {
  const auto sentence = [](const std::function<void(SoftBodySettings&)>& change) {
    SoftBodySettings settings = rubber();
    change(settings);
    return verdict_on(settings);
  };
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(sentence([](auto&) {}), "accepted");
  EXPECT_NE(sentence([](auto& s) { s.cell_size = 0; }).find("cell_size is 0"), std::string::npos);
  EXPECT_NE(sentence([](auto& s) { s.half_width = -1; }).find("half_width is -1"), std::string::npos);
  EXPECT_NE(sentence([](auto& s) { s.half_width = 17; }).find("half_width is 17"), std::string::npos);
  EXPECT_NE(sentence([](auto& s) { s.density = -3; }).find("density is -3"), std::string::npos);
  EXPECT_NE(sentence([](auto& s) { s.alpha = 1.5f; }).find("alpha is 1.5"), std::string::npos);
  EXPECT_NE(sentence([=](auto& s) { s.alpha = kNan; }).find("alpha is nan"), std::string::npos);
  EXPECT_NE(sentence([](auto& s) { s.damping = 2; }).find("damping is 2"), std::string::npos);
  EXPECT_NE(sentence([](auto& s) { s.friction = -1; }).find("friction is -1"), std::string::npos);
  EXPECT_NE(sentence([](auto& s) { s.restitution = 2; }).find("restitution is 2"), std::string::npos);
  EXPECT_NE(sentence([](auto& s) { s.frequency = -1.0f; }).find("frequency is -1"), std::string::npos);
  EXPECT_NE(sentence([](auto& s) { s.damping_time = -1.0f; }).find("damping_time is -1"), std::string::npos);
}

/// A message names no number that looks as if it were in the range.
TEST(SoftBodySettings, RefuseTheNextNumberBeyondALimitInAllItsDigits) {
  const auto sentence = [](const std::function<void(SoftBodySettings&)>& change) {
    SoftBodySettings settings = rubber();
    settings.plasticity = Plasticity{};
    settings.fracture = Fracture{};
    change(settings);
    return verdict_on(settings);
  };
  const float above = std::nextafter(1.0f, 2.0f), below = -std::numeric_limits<float>::denorm_min();
  const float turn = std::nextafter(3.1415927f, 4.0f);
  EXPECT_EQ(sentence([=](auto& s) { s.alpha = above; }),
            "a soft body's alpha is 1.0000001; it must be from 0 to 1");
  EXPECT_EQ(sentence([=](auto& s) { s.damping = above; }),
            "a soft body's damping is 1.0000001; it must be from 0 to 1");
  EXPECT_EQ(sentence([=](auto& s) { s.restitution = above; }),
            "a soft body's restitution is 1.0000001; it must be from 0 to 1");
  EXPECT_EQ(sentence([=](auto& s) { s.plasticity->yield = above; }),
            "a soft body's yield is 1.0000001; it must be a strain above 0 and at most 1");
  EXPECT_EQ(sentence([=](auto& s) { s.fracture->turn = turn; }),
            "a soft body's fracture.turn is 3.141593; it must be an angle in radians above 0 and at most pi");
  for (const float alpha : {below, -1e-30f})
    EXPECT_NE(sentence([=](auto& s) { s.alpha = alpha; }).find("alpha is -1e-"), std::string::npos);
  EXPECT_EQ(
      sentence([](auto& s) { s.density = -1; }),
      "a soft body's density is -1; it must be a number above 0, in kg/m^3 (of a two-dimensional body in "
      "kg/m^2)");
  constexpr float infinite = std::numeric_limits<float>::infinity();
  EXPECT_EQ(sentence([=](auto& s) { s.friction = infinite; }),
            "a soft body's friction is inf; it must be 0 or above, and finite");
  EXPECT_EQ(sentence([=](auto& s) { s.cell_size = infinite; }),
            "a soft body's cell_size is inf; it must be a length in metres above 0, and finite");
  EXPECT_EQ(sentence([=](auto& s) { s.alpha = infinite; }),
            "a soft body's alpha is inf; it must be from 0 to 1");
}

TEST(SoftBodySettings, FrequencyAndDampingTimeTakeThePlaceOfAlphaAndDamping) {
  SoftBodySettings settings = rubber();
  EXPECT_EQ(settings.alpha_of_step(0.01f), 0.5f);
  EXPECT_EQ(settings.damping_of_step(0.01f), 0.1f);
  settings.frequency = 5.0f;
  settings.damping_time = 0.2f;
  for (const float h : {1.0f / 60, 1.0f / 120}) {
    const double s = std::sin(M_PI * 5 * double{h});
    EXPECT_NEAR(settings.alpha_of_step(h), 4 * s * s, 1e-6);
    EXPECT_NEAR(settings.damping_of_step(h), 1 - std::exp(-double{h} / 0.2), 1e-6);
  }
  settings.frequency = 30.0f;
  EXPECT_EQ(settings.alpha_of_step(1.0f / 60), 1.0f);
}

TEST(SoftBodyModel, SplitsParticlesIntoOuterAndInner) {
  const auto model = block_model({6, 6, 6}, rubber());
  EXPECT_EQ(model->particles(), 343u);
  EXPECT_EQ(model->inner().size(), 27u) << "two layers are outer";
  EXPECT_EQ(model->outer().size(), 316u);
  EXPECT_NEAR(model->mass(), 200 * 1.2f * 1.2f * 1.2f, 1e-2f);
  EXPECT_TRUE(model->embedding().groups.empty());
  EXPECT_FLOAT_EQ(model->contact_radius(), 0.03f);
}

TEST(SoftBodyModel, OfAMeshEmbedsIt) {
  const TriangleMesh mesh = make_sphere(0.5f, 6);
  const auto model = make_soft_body_model(mesh, rubber());
  EXPECT_EQ(model->embedding().slot_of_vertex.size(), mesh.positions.size());
  EXPECT_EQ(model->outer().size() + model->inner().size(), model->particles());
}

TEST(SoftBodyModel, RefusesALatticeOfAnotherSpacing) {
  const Eigen::Vector3i cell(0, 0, 0);
  EXPECT_THROW(make_soft_body_model(lattice_from_cells({&cell, 1}, 0.1f, Vector3f::Zero()), rubber()),
               std::runtime_error);
}

/// A body that moves, turns and is out of shape.
SoftBody<3> moving_body() {
  SoftBody<3> body(block_model({4, 3, 2}, rubber()), {1, 2, 3});
  body.add_velocity({1, -2, 0.5f});
  body.add_angular_velocity({0.5f, 1, -2});
  for (std::size_t i = 0; i < body.model().particles(); ++i) {
    const Vector3f x = body.position(i) + 0.02f * Vector3f(float(i % 3) - 1, float(i % 5) - 2, float(i % 2));
    body.set_particle(i, x, body.velocities()[i]);
  }
  return body;
}

/// The face between two cells is as strong as the weaker one.
TEST(SoftBodyModel, TakesStrengthsOfALatticeAloneInBothDimensions) {
  SoftBodySettings settings{.cell_size = 0.5f};
  settings.fracture = Fracture{};
  const std::vector<Eigen::Vector3i> cubes{{0, 0, 0}, {1, 0, 0}};
  const auto solid = make_soft_body_model(lattice_from_cells(cubes, 0.5f, {2, 0, 0}), settings,
                                          [](const Vector3f& at) { return at.x(); });
  EXPECT_EQ(solid->cracks().strength, std::vector<float>{2.25f});
  const std::vector<Eigen::Vector2i> squares{{0, 0}, {1, 0}};
  const auto flat = make_soft_body_model(lattice_from_cells(squares, 0.5f, {2, 0}), settings, 0.5f,
                                         [](const Eigen::Vector2f& at) { return at.x(); });
  EXPECT_EQ(flat->cracks().strength, std::vector<float>{2.25f});
}

TEST(SoftBodyModel, SaysWhereAStrengthIsRefusedAndInAllItsDigits) {
  const auto refusal_of = [](float strength) -> std::string {
    try {
      make_soft_body_model(make_box({1, 0.5f, 0.5f}, 1), {.cell_size = 0.5f},
                           [=](const Vector3f& at) { return at.x() > 0 ? strength : 1; });
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal_of(0), "accepted");
  EXPECT_EQ(refusal_of(-1e-9f),
            "the strength of a soft body at (0.25, 0, 0) is -1e-09; it must be 0 or above, and finite");
  EXPECT_EQ(refusal_of(NAN),
            "the strength of a soft body at (0.25, 0, 0) is nan; it must be 0 or above, and finite");
}

TEST(SoftBody, BeginsAtRestInItsPlace) {
  const SoftBody<3> body(block_model({2, 2, 2}, rubber()), {1, 2, 3});
  EXPECT_TRUE(body.bounds().low.isApprox(Vector3f(0.8f, 2, 2.8f)));
  EXPECT_TRUE(body.bounds().high.isApprox(Vector3f(1.2f, 2.4f, 3.2f)));
  EXPECT_TRUE(body.centre_of_mass().isApprox(Vector3f(1, 2.2f, 3)));
  EXPECT_EQ(fastest(body), 0);
}

TEST(SoftBody, PaddedPositionsAreAlwaysThePositions) {
  SoftBody<3> body = moving_body();
  const auto check = [&](const char* after) {
    for (std::size_t i = 0; i < body.positions().size(); ++i) {
      const Eigen::Vector4f& padded = body.padded_positions()[i];
      ASSERT_EQ(Vector3f(padded.head<3>()), body.position(i)) << after;
      ASSERT_EQ(padded.w(), 0) << after;
    }
  };
  check("set_particle");
  body.advance_inner(0.01f, {0, -10, 0});
  check("advance_inner");
  body.translate({1, 0, 0});
  check("translate");
  body.move_without_force(Eigen::Quaternionf(Eigen::AngleAxisf(1, Vector3f::UnitZ())), {0, 1, 0});
  check("move_without_force");
  body.reset_deformation();
  check("reset_deformation");
}

TEST(SoftBody, InnerParticlesAreIntegratedInBulletsOrder) {
  SoftBody<3> body(block_model({4, 4, 4}, rubber()));
  const std::uint32_t inner = body.model().inner()[0];
  const Vector3f x = body.position(inner);
  body.advance_inner(0.1f, {0, -10, 0});
  EXPECT_TRUE(body.velocities()[inner].isApprox(Vector3f(0, -1, 0)));
  EXPECT_TRUE(body.position(inner).isApprox(x + Vector3f(0, -0.1f, 0)));
  EXPECT_EQ(body.velocities()[body.model().outer()[0]], Vector3f(0, 0, 0)) << "an outer one is the engine's";
}

TEST(SoftBody, PullsConserveMomentum) {
  SoftBody<3> body = moving_body();
  const Vector3f p = body.linear_momentum(), l = body.angular_momentum();
  const auto before = body.velocities()[0];
  body.pull(1.0f / 60);
  EXPECT_NE(body.velocities()[0], before);
  EXPECT_LT((body.linear_momentum() - p).norm(), 1e-4f * p.norm());
  EXPECT_LT((body.angular_momentum() - l).norm(), 1e-3f * l.norm());
}

TEST(SoftBody, ASpeedLimitSlowsOnlyWhatIsFaster) {
  SoftBody<3> body(block_model({1, 1, 1}, rubber()));
  body.set_particle(0, body.position(0), {3, 0, 4});
  body.set_particle(1, body.position(1), {0, 0.5f, 0});
  body.limit_speed(1);
  EXPECT_TRUE(body.velocities()[0].isApprox(Vector3f(0.6f, 0, 0.8f)));
  EXPECT_EQ(body.velocities()[1], Vector3f(0, 0.5f, 0));
}

TEST(SoftBody, ATeleportTurnsVelocitiesWithTheBody) {
  SoftBody<3> body = moving_body();
  const auto revision = body.revision();
  const Vector3f centre = body.centre_of_mass(), p = body.linear_momentum(), l = body.angular_momentum();
  const Eigen::Quaternionf turn(Eigen::AngleAxisf(2, Vector3f(1, 2, -1).normalized()));
  body.move_without_force(turn, {5, -1, 2});
  EXPECT_NE(body.revision(), revision);
  EXPECT_TRUE(body.centre_of_mass().isApprox(centre + Vector3f(5, -1, 2), 1e-5f));
  EXPECT_TRUE(body.linear_momentum().isApprox(turn * p, 1e-4f));
  EXPECT_TRUE(body.angular_momentum().isApprox(turn * l, 1e-3f));
  // The shape is the same: the next pull does the same in the turned frame.
  SoftBody<3> still = moving_body();
  still.pull(1.0f / 60);
  body.pull(1.0f / 60);
  for (std::size_t i = 0; i < body.velocities().size(); ++i) {
    ASSERT_LT((body.velocities()[i] - turn * still.velocities()[i]).norm(), 1e-3f) << "particle " << i;
  }
}

TEST(SoftBody, ResetTakesAwayTheDeformationOnly) {
  SoftBody<3> body = moving_body();
  const Eigen::Quaternionf turn(Eigen::AngleAxisf(2.5f, Vector3f(1, 2, -1).normalized()));
  body.move_without_force(turn, {0, 0, 0});
  const Vector3f centre = body.centre_of_mass(), p = body.linear_momentum(), l = body.angular_momentum();
  const Vector3f diagonal = turn * (moving_body().position(59) - moving_body().position(0));
  ASSERT_GT(body.deformation(), 0.02f);
  body.reset_deformation();
  EXPECT_LT(body.deformation(), 1e-5f);
  EXPECT_TRUE(body.centre_of_mass().isApprox(centre, 1e-5f));
  EXPECT_TRUE(body.linear_momentum().isApprox(p, 1e-4f));
  EXPECT_TRUE(body.angular_momentum().isApprox(l, 1e-3f));
  EXPECT_GT((body.position(59) - body.position(0)).normalized().dot(diagonal.normalized()), 0.98f)
      << "it lost its orientation";
  const auto before = body.velocities()[0];
  body.pull(1.0f / 60);
  EXPECT_LT((body.velocities()[0] - before).norm(), 1e-3f) << "rigid motion of the rest shape is left alone";
}

TEST(SoftBody, ACopyIsASavedState) {
  SoftBody<3> body = moving_body();
  body.pull(1.0f / 60);
  const SoftBody<3> saved = body;
  const auto run = [&] {
    for (int i = 0; i < 5; ++i) body.pull(1.0f / 60);
    return state_hash(body);
  };
  const auto first = run();
  body = saved;
  EXPECT_EQ(run(), first);
}

/// Programs that save bodies in a file do so.
TEST(SoftBody, ASavedStateIsSetInAnotherBody) {
  SoftBody<3> body(block_model({2, 2, 2}, rubber()), {0, 1, 0});
  body.add_angular_velocity({1, 2, 3});
  for (int i = 0; i < 3; ++i) body.pull(1.0f / 120);
  const std::vector<Vector3f> positions(body.positions().begin(), body.positions().end());
  const std::vector<Vector3f> velocities(body.velocities().begin(), body.velocities().end());
  SoftBody<3> other(body.shared_model());
  const std::uint32_t revision = other.revision(), resets = other.resets();
  other.set_state(positions, velocities);
  EXPECT_NE(other.revision(), revision) << "couplings notice it";
  EXPECT_NE(other.resets(), resets);
  EXPECT_EQ(state_hash(other), state_hash(body));
  for (std::size_t i = 0; i < positions.size(); ++i)
    EXPECT_EQ(other.padded_positions()[i].head<3>(), positions[i]);

  const auto refusal_of = [&](std::span<const Vector3f> x, std::span<const Vector3f> v) -> std::string {
    try {
      other.set_state(x, v);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal_of(positions, std::span(velocities).first(1)),
            "a soft body of 27 particles was given 1 velocity");
  EXPECT_EQ(refusal_of(std::span(positions).first(26), velocities),
            "a soft body of 27 particles was given 26 positions");
  std::vector<Vector3f> bad = velocities;
  bad[26].y() = NAN;
  EXPECT_EQ(refusal_of(positions, bad),
            "a soft body of 27 particles was given a velocity that is not finite, for particle 26");
  EXPECT_EQ(state_hash(other), state_hash(body)) << "nothing has changed";
}

TEST(StateHash, SeesEveryParticleVelocityAndTheOrderOfBodies) {
  SoftBody<3> a = moving_body(), b = moving_body();
  EXPECT_EQ(state_hash(a), state_hash(b));
  b.set_particle(7, b.position(7), b.velocities()[7] + Vector3f(0, 0, 1e-6f));
  EXPECT_NE(state_hash(a), state_hash(b));
  const SoftBody<3>* ab[] = {&a, &b};
  const SoftBody<3>* ba[] = {&b, &a};
  EXPECT_NE(state_hash(ab), state_hash(ba));
  EXPECT_EQ(state_hash(ab), state_hash(b, state_hash(a)));
}

// In two dimensions likewise.

SoftBody<2> plane_body() {
  std::vector<Eigen::Vector2i> cells;
  for (int x = 0; x < 4; ++x)
    for (int y = 0; y < 3; ++y) cells.push_back({x, y});
  SoftBody<2> body(make_soft_body_model(lattice_from_cells(cells, 0.2f), {.cell_size = 0.2f, .density = 5}));
  for (std::size_t i = 0; i < body.model().particles(); ++i) {
    const Eigen::Vector2f x = body.position(i);
    body.set_particle(i, x + Eigen::Vector2f(0.3f * x.y() * x.y(), 0.1f * x.x()),
                      {1 - x.y(), 2 + 0.5f * x.x() * x.x()});
  }
  return body;
}

TEST(SoftBody2d, TeleportsAsARigidBody) {
  SoftBody<2> body = plane_body();
  const Eigen::Vector2f centre = body.centre_of_mass(), p = body.linear_momentum();
  const float l = body.angular_momentum(), bent = body.deformation();
  const Eigen::Rotation2Df turn(0.7f);
  const std::uint32_t resets = body.resets(), revision = body.revision();
  body.move_without_force(turn, {5, -1});
  EXPECT_TRUE(body.centre_of_mass().isApprox(centre + Eigen::Vector2f(5, -1), 1e-5f));
  EXPECT_TRUE(body.linear_momentum().isApprox(turn * p, 1e-4f));
  EXPECT_NEAR(body.angular_momentum(), l, 1e-3f * std::abs(l));
  EXPECT_NEAR(body.deformation(), bent, 1e-4f);
  EXPECT_NE(body.resets(), resets);
  EXPECT_NE(body.revision(), revision);
}

TEST(SoftBody2d, GetsItsShapeBackAndKeepsWhatMoves) {
  SoftBody<2> body = plane_body();
  ASSERT_GT(body.deformation(), 0.02f);
  const Eigen::Vector2f centre = body.centre_of_mass(), p = body.linear_momentum();
  const float l = body.angular_momentum();
  ASSERT_GT(std::abs(l), 0.01f);
  body.reset_deformation();
  EXPECT_LT(body.deformation(), 1e-5f);
  EXPECT_TRUE(body.centre_of_mass().isApprox(centre, 1e-5f));
  EXPECT_TRUE(body.linear_momentum().isApprox(p, 1e-4f));
  EXPECT_NEAR(body.angular_momentum(), l, 1e-3f * std::abs(l));
}

TEST(SoftBody2d, TurnsAboutItsCentre) {
  SoftBody<2> body = plane_body();
  const Eigen::Vector2f p = body.linear_momentum();
  const float before = body.angular_momentum();
  body.add_angular_velocity(2);
  EXPECT_TRUE(body.linear_momentum().isApprox(p, 1e-4f));
  float inertia = 0;
  for (std::size_t i = 0; i < body.model().particles(); ++i)
    inertia += body.model().masses()[i] * (body.position(i) - body.centre_of_mass()).squaredNorm();
  EXPECT_NEAR(body.angular_momentum(), before + 2 * inertia, 1e-3f * inertia);
}

TEST(SoftBody2d, WithoutContactsAllParticlesAreInner) {
  SoftBodySettings settings{.cell_size = 0.2f, .density = 5};
  settings.contacts = false;
  const std::vector<Eigen::Vector2i> cells{{0, 0}, {1, 0}};
  SoftBody<2> body(make_soft_body_model(lattice_from_cells(cells, 0.2f), settings));
  EXPECT_TRUE(body.model().outer().empty());
  EXPECT_EQ(body.model().inner().size(), 6u);
  body.keep_inner_inside();  // inside of nothing
  EXPECT_TRUE(body.positions()[5].allFinite());
}

}  // namespace
}  // namespace softcell::ppu
