// What each kind of attachment does: a weld carries, a rope gets no longer, a hinge turns; where they give, and where they break.

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "attached_world.h"
#include "ppu/attachments/attachments.h"

namespace softcell::ppu::attached {
namespace {

class AttachmentKinds : public SolvedByBoth {};
INSTANTIATE_TEST_SUITE_P(SolvedBy, AttachmentKinds, kBothSolvers, SolvedByBoth::name);

float mass_of(const SoftBody<3>& body, const std::vector<std::uint32_t>& particles) {
  float mass = 0;
  for (const std::uint32_t i : particles) mass += body.model().masses()[i];
  return mass;
}

/// A hundred times the weight of the patch hangs from it: most of it is a rigid body that is welded to the soft one's lower end.
TEST_P(AttachmentKinds, AWeldCarriesAHundredTimesItsPatchWithoutCreep) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of attachments";
  AttachedWorld w(GetParam());
  SoftBody<3>& body = w.add(block({0.4f, 0.4f, 0.4f}), stiff(), {0, 2, 0});
  const auto top = top_of(body);
  const auto bottom = particles_where(body, [](const Vector3f& p) { return p.y() < -0.15f; });
  const float load = 100 * mass_of(body, top) - body.model().mass();
  ASSERT_GT(load, 10);
  btRigidBody& weight = w.add(std::make_unique<btBoxShape>(btVector3(0.2f, 0.2f, 0.2f)), load, {0, 1.55f, 0});
  const AttachmentId weld = w.bodies.attach(body, Patch<3>::of_particles(top));
  w.bodies.attach(body, Patch<3>::of_particles(bottom), weight);
  std::vector<Vector3f> before;
  for (const std::uint32_t i : top) before.push_back(body.position(i));
  float worst = 0;
  // SPEs take five times as long for it here; they have been seen to carry it for 600 s, too.
  const int seconds = GetParam() == Who::kPpu ? 600 : 60;
  for (int second = 0; second < seconds; ++second) {
    w.run(60);
    for (std::size_t i = 0; i < top.size(); ++i)
      worst = std::max(worst, (body.position(top[i]) - before[i]).norm());
  }
  EXPECT_LT(worst, 0.01f * kCell);
  const auto state = w.bodies.attachment(weld);
  ASSERT_TRUE(state);
  EXPECT_NEAR(state->force.y(), 9.81f * (load + body.model().mass()),
              0.02f * 9.81f * (load + body.model().mass()));
  EXPECT_LT(weight.getLinearVelocity().length(), 0.05f);
}

/// A cantilever: one body is held whole, the other sticks out from it.
TEST_P(AttachmentKinds, AWeldOfTwoBodiesCarriesTorque) {
  AttachedWorld w(GetParam());
  SoftBodySettings settings = settings_of(kCell, 0.6f, 0.4f);
  settings.half_width = 3;
  SoftBody<3>& left = w.add(block({0.4f, 0.4f, 0.4f}), settings, {0, 0, 0});
  SoftBody<3>& right = w.add(block({0.4f, 0.4f, 0.4f}), settings, {0.42f, 0, 0});
  w.bodies.attach(left, all_of(left));
  w.bodies.attach(left, Patch<3>::of_surface({0.2f, 0, 0}, 0.25f), right,
                  Patch<3>::of_surface({0.22f, 0, 0}, 0.25f));
  w.run(300);
  EXPECT_NEAR(right.centre_of_mass().y(), 0, 0.1f * kCell);
  const Vector3f at_rest = right.centre_of_mass();
  w.run(60);
  EXPECT_LT((right.centre_of_mass() - at_rest).norm(), 1e-4f);
  EXPECT_NEAR(right.centre_of_mass().x(), 0.42f, 0.03f);
}

/// A spring of a known stiffness gives as Hooke says.
TEST_P(AttachmentKinds, ComplianceGives) {
  AttachedWorld w(GetParam());
  SoftBody<3>& body = w.add(block({0.3f, 0.3f, 0.3f}), stiff(), {0, 0, 0});
  const auto top = top_of(body);
  const float weight = 9.81f * body.model().mass();
  const float before = middle_of(body, top).y();
  w.bodies.attach(body, Patch<3>::of_particles(top), {.compliance = 0.05f / weight});
  w.run(1200);
  EXPECT_NEAR(before - middle_of(body, top).y(), 0.05f, 0.002f);
}

TEST_P(AttachmentKinds, AHingeTurnsAboutItsAxisOnly) {
  AttachedWorld w(GetParam(), {0, -9.81f, 0});
  SoftBody<3>& door = w.add(block({0.8f, 0.8f, 0.2f}), stiff(), {0.4f, 0, 0});
  const Patch<3> edge =
      Patch<3>::of_particles(particles_where(door, [](const Vector3f& p) { return p.x() < -0.25f; }));
  w.bodies.attach(door, edge,
                  {.kind = AttachmentKind::kHinge, .point = Vector3f(0, 0, 0), .axis = {0, 1, 0}});
  door.add_particle_velocity(0, {0, 0, 0});
  for (std::uint32_t i = 0; i < door.model().particles(); ++i)
    door.add_particle_velocity(i, {0, 0, -2 * door.position(i).x()});
  float turned = 0;
  Vector3f last = door.centre_of_mass();
  for (int i = 0; i < 240; ++i) {
    w.run(1);
    const Vector3f now = door.centre_of_mass();
    turned += std::atan2(last.x() * now.z() - last.z() * now.x(), last.x() * now.x() + last.z() * now.z());
    last = now;
    ASSERT_NEAR(std::hypot(now.x(), now.z()), 0.4f, 0.05f) << i;
    ASSERT_NEAR(now.y(), 0, 0.1f) << i;
  }
  EXPECT_NEAR(std::abs(turned), 2 * 4, 1.0f) << "radians, at 2 a second for 4 s";
}

/// A pendulum, and one that falls into its rope.
TEST_P(AttachmentKinds, ARopeIsNeverLongerThanItsLength) {
  if (kSlowBuild && GetParam() == Who::kSpes)
    GTEST_SKIP() << "too slow with sanitizers, which run it on the PPU";
  for (const Vector3f& throw_at :
       {Vector3f(0, 0, 0), Vector3f(4, 0, 1), Vector3f(0, -6, 0), Vector3f(8, 8, 0)}) {
    AttachedWorld w(GetParam());
    SoftBody<3>& body = w.add(block({0.4f, 0.4f, 0.4f}), settings_of(kCell, 0.5f, 0.1f), {0, 0, 0});
    const auto top = top_of(body);
    const Vector3f hook(0, 0.2f + 1.0f, 0);
    constexpr float kLength = 1.5f;
    w.bodies.attach(body, Patch<3>::of_particles(top),
                    {.kind = AttachmentKind::kRope, .point = hook, .length = kLength});
    body.add_velocity(throw_at);
    float longest = 0;
    for (int i = 0; i < 600; ++i) {
      w.run(1);
      longest = std::max(longest, (middle_of(body, top) - hook).norm());
    }
    EXPECT_LT(longest, 1.01f * kLength) << throw_at.transpose();
    EXPECT_GT(longest, 0.99f * kLength) << throw_at.transpose();
  }
}

/// What hangs keeps swinging: a rope takes no more energy than a simulation without damping may lose.
TEST_P(AttachmentKinds, APendulumKeepsItsEnergy) {
  if (kSlowBuild && GetParam() == Who::kSpes)
    GTEST_SKIP() << "too slow with sanitizers, which run it on the PPU";
  AttachedWorld w(GetParam());
  SoftBody<3>& body = w.add(block({0.3f, 0.3f, 0.3f}), settings_of(kCell, 1, 0.3f), {2, 2, 0});
  w.bodies.attach(body, all_of(body), {.kind = AttachmentKind::kRope, .point = Vector3f(0, 2, 0)});
  float fastest = 0;
  for (int i = 0; i < 60 * 20; ++i) {
    w.run(1);
    if (i > 60 * 16) fastest = std::max(fastest, body.linear_momentum().norm() / body.model().mass());
  }
  const float expected = std::sqrt(2 * 9.81f * 2);
  EXPECT_LT(fastest, 1.01f * expected);
  EXPECT_GT(fastest, 0.93f * expected);
}

/// The rope pulls its ends together: each comes nearer by at most a quarter of a cell in a substep, and bodies get no faster than that.
TEST_P(AttachmentKinds, ARopeThatIsTooShortHauls) {
  AttachedWorld w(GetParam(), {0, 0, 0});
  SoftBody<3>& left = w.add(block({0.4f, 0.4f, 0.4f}), settings_of(kCell, 0.6f, 0.3f), {-1.2f, 0, 0});
  SoftBody<3>& right = w.add(block({0.4f, 0.4f, 0.4f}), settings_of(kCell, 0.6f, 0.3f), {1.2f, 0, 0});
  const AttachmentId rope = w.bodies.attach(left, Patch<3>::of_surface({-1, 0, 0}, 0.15f), right,
                                            Patch<3>::of_surface({1, 0, 0}, 0.15f),
                                            {.kind = AttachmentKind::kRope, .length = 0.5f});
  constexpr float kMost = 0.25f * kCell;  // in a substep
  float gap = w.bodies.attachment_ends(rope)->patch.x() - w.bodies.attachment_ends(rope)->other.x();
  gap = std::abs(gap);
  for (int i = 0; i < 120; ++i) {
    w.run(1);
    const float now = w.bodies.attachment(rope)->gap;
    EXPECT_LT(gap - now, 2 * 1.1f * (2 * kMost)) << "two ends in two substeps, " << i;
    gap = now;
    EXPECT_LT(std::max(ContactWorld::fastest(left), ContactWorld::fastest(right)), kMost / kStep) << i;
  }
  EXPECT_LT(gap, 0.55f);
}

/// However little a rope gives, and however far it is too long: it pulls its body in, and does not throw it.
TEST(Attachments, AnErrorOfPositionAsksForNoMoreThanAQuarterOfACellASubstep) {
  for (const float compliance : {0.0f, 1e-9f, 1e-5f}) {
    ContactWorld w;
    const auto model = make_soft_body_model(block({0.3f, 0.3f, 0.3f}), settings_of(kCell));
    const SoftBody<3>& body = w.bodies.add(model, {0, 0, 0});
    w.world.setGravity({0, 0, 0});
    w.bodies.attach(body, Patch<3>::of_surface({0, 0.15f, 0}, 0.1f),
                    {.kind = AttachmentKind::kRope,
                     .point = Vector3f(0, 3, 0),
                     .length = 0.2f,
                     .compliance = compliance});
    float fastest = 0;
    for (int i = 0; i < 240; ++i) {
      w.run(1);
      fastest = std::max(fastest, ContactWorld::fastest(body));
    }
    EXPECT_LT(fastest, 4 * 0.25f * kCell / kStep) << compliance << ": shape matching adds to it";
    EXPECT_GT(body.centre_of_mass().y(), 2) << compliance << ": it comes";
  }
}

/// By the momentum of the body, not by what the attachment says of itself.
/// @return  force on the body in each substep, with the break force given; 0 after it broke
std::vector<float> forces_on(Who who, float break_force, bool suddenly, AttachmentKind kind,
                             int* broken_at = nullptr) {
  AttachedWorld w(who, {0, 0, 0});
  SoftBody<3>& body = w.add(block({0.4f, 0.4f, 0.4f}), settings_of(kCell, 0.5f, 0.2f), {0, 0, 0});
  AttachmentSettings<3> settings{.kind = kind, .break_force = break_force};
  if (kind == AttachmentKind::kRope) settings.point = Vector3f(0, 1, 0);
  const auto upper = particles_where(body, [](const Vector3f& p) { return p.y() > 0.05f; });
  const AttachmentId id = w.bodies.attach(body, Patch<3>::of_particles(upper), settings);
  std::vector<float> forces;
  if (suddenly) body.add_velocity({0, -3, 0});
  for (int i = 0; i < 480; ++i) {
    const float gravity = suddenly ? 0.0f : 0.05f * static_cast<float>(i);
    w.world.setGravity({0, -gravity, 0});
    const Eigen::Vector3d before = momentum_of(body);
    w.run(1, 1);
    const Eigen::Vector3d changed = momentum_of(body) - before;
    forces.push_back(static_cast<float>(changed.norm() == 0 ? 0 : (changed / (1.0 / 60)).y()) +
                     gravity * body.model().mass());
    if (broken_at != nullptr && *broken_at < 0 && !w.bodies.attachment(id)) *broken_at = i;
  }
  return forces;
}

TEST_P(AttachmentKinds, BreakWhenTheyWouldCarryMore) {
  if (kSlowBuild && GetParam() == Who::kSpes)
    GTEST_SKIP() << "too slow with sanitizers, which run it on the PPU";
  for (const AttachmentKind kind : {AttachmentKind::kWeld, AttachmentKind::kHinge, AttachmentKind::kRope}) {
    for (const bool suddenly : {false, true}) {
      const std::vector<float> held = forces_on(GetParam(), 1e9f, suddenly, kind);
      const float most = *std::max_element(held.begin(), held.end());
      for (const float share : {0.3f, 0.6f, 0.9f}) {
        const float force = share * most;
        int broken_at = -1;
        const std::vector<float> broke = forces_on(GetParam(), force, suddenly, kind, &broken_at);
        ASSERT_GE(broken_at, 0) << share << " suddenly: " << suddenly;
        for (int i = 0; i < broken_at; ++i) EXPECT_LE(broke[i], 1.05f * force);
        // It carries no more than its break force, and breaks when the one that holds carries that.
        EXPECT_NEAR(broke[broken_at], force, 0.05f * force) << share << " suddenly: " << suddenly;
        EXPECT_GE(held[broken_at], 0.95f * force) << share << " suddenly: " << suddenly;
        EXPECT_NEAR(broke.back(), 0, 0.01f * force);
      }
    }
  }
}

TEST(Attachments, AHungBodyCarriesOneThatStandsOnIt) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers, which run the other tests of attachments";
  for (const bool on_spes : {false, true}) {
    std::unique_ptr<SpeRuntime> spes =
        on_spes ? std::make_unique<SpeRuntime>(SpeRuntimeOptions{.spes = 2}) : nullptr;
    ContactWorld w({0, -9.81f, 0}, spes.get());
    SoftBody<3>& hung = w.add(block({0.8f, 0.3f, 0.8f}), settings_of(kCell, 0.7f, 0.3f), {0, 0, 0});
    SoftBody<3>& standing = w.add(block({0.3f, 0.3f, 0.3f}), settings_of(kCell, 0.7f, 0.3f), {0, 0.32f, 0});
    std::vector<AttachmentId> ropes;
    for (const float x : {-0.35f, 0.35f})
      for (const float z : {-0.35f, 0.35f})
        ropes.push_back(w.bodies.attach(hung, Patch<3>::of_surface({x, 0.15f, z}, 0.1f),
                                        {.kind = AttachmentKind::kRope, .point = Vector3f(x, 1.5f, z)}));
    w.run(400);
    float carried = 0;
    for (const AttachmentId rope : ropes) carried += w.bodies.attachment(rope)->force.y();
    const float weight = 9.81f * (hung.model().mass() + standing.model().mass());
    EXPECT_NEAR(carried, weight, 0.03f * weight);
    EXPECT_GT(ContactWorld::lowest_drawn(standing), -0.15f);
    EXPECT_LT(ContactWorld::fastest(standing), 0.05f);
  }
}

/// Determinants of masses and inertias were 0 or infinite in single precision, and positions NaN after the first step.
TEST_P(AttachmentKinds, AttachmentsHoldFromAMillimetreToAKilometre) {
  for (const float scale : {0.001f, 0.01f, 100.0f, 1000.0f}) {
    SCOPED_TRACE(scale);
    const float cell = scale / 4;
    AttachedWorld w(GetParam(), {0, -9.81f * scale, 0});
    const TriangleMesh mesh = make_box({2 * scale, scale, scale}, cell);
    const float x = -4 * scale;  // the other attachments of AttachedWorld are at more than 0
    SoftBody<3>& left = w.add(mesh, settings_of(cell), {x, 0, 0});
    SoftBody<3>& right = w.add(mesh, settings_of(cell), {x + 2 * scale, 0, 0});
    const float half = 0.5f * scale;
    btRigidBody& box = w.add(std::make_unique<btBoxShape>(btVector3(half, half, half)), left.model().mass(),
                             {-1.5f * scale, 0, 0});
    w.bodies.attach(left, Patch<3>::of_surface({x - scale, 0, 0}, half), box);
    w.bodies.attach(left, Patch<3>::of_surface({x + scale, 0, 0}, half), right,
                    Patch<3>::of_surface({x + scale, 0, 0}, half));
    w.run(15);
    const float fallen = 0.5f * 9.81f * scale * 0.25f * 0.25f;
    for (const SoftBody<3>* const body : {&left, &right})
      EXPECT_NEAR(body->centre_of_mass().y(), -fallen, 0.05f * fallen);
    EXPECT_NEAR(height_of(box), -fallen, 0.05f * fallen);
  }
}

/// What contacts push, a particle keeps, though its attachment pushes it, too.
TEST(Attachments, LimitTheirOwnPushesOnly) {
  PatchParticles<3> patch{.particles = {0, 1, 2, 3},
                          .positions = {{0, 0, 0}, {0.1f, 0, 0}, {0, 0.1f, 0}, {0, 0, 0.1f}},
                          .masses = {1, 1, 1, 1}};
  const AttachmentFrame<3> frame;
  AttachmentRows<3> rows({}, patch, frame);
  for (Vector3f& position : patch.positions) position.x() += 0.001f;
  std::vector<Vector3f> velocities(4, Vector3f::Zero()), pushes(4, Vector3f::Zero());
  const std::vector<float> inverse_masses(4, 1);
  const float most = 0.25f * kCell / kStep;
  pushes[2] = {0, 20 * most, 0};
  rows.begin({.a = {patch.positions, velocities, pushes, inverse_masses, kCell}, .frame = &frame}, kStep);
  rows.iterate();
  rows.finish();
  EXPECT_NEAR(pushes[0].x(), -0.001f / kStep, 1e-4f) << "back by a millimetre";
  EXPECT_NEAR(pushes[2].y(), 19 * most, 0.01f * most) << "less by what the attachment may push";
}

/// What is attached costs this much more a substep. (docs/guide/soft-bodies.md has figures; here only that it is no multiple.)
TEST(Attachments, APatchOfTwentyParticlesCostsMicroseconds) {
  if (kSlowBuild) GTEST_SKIP() << "it measures time, which sanitizers change";
  const auto model = make_soft_body_model(block({0.4f, 0.4f, 0.4f}), settings_of(kCell));
  SoftBody<3> body(model);
  PatchParticles<3> patch;
  for (std::uint32_t i = 0; i < 20; ++i) {
    patch.particles.push_back(i);
    patch.positions.push_back(body.position(i));
    patch.masses.push_back(model->masses()[i]);
  }
  ContactRigid rigid;
  rigid.inverse_mass = 0.1f;
  rigid.inverse_inertia = Eigen::Matrix3f::Identity();
  std::vector<Vector3f> velocities(body.positions().size(), Vector3f(0, -0.1f, 0)),
      pushes(velocities.size(), Vector3f::Zero());
  std::vector<float> inverse_masses;
  for (const float mass : model->masses()) inverse_masses.push_back(1 / mass);
  for (const bool to_rigid : {false, true}) {
    AttachmentRows<3> rows({}, patch, AttachmentFrame<3>{});
    Attachments<3> attachments;
    attachments.add({.rows = &rows, .rigid = to_rigid ? 0 : AttachmentInStep<3>::kNone});
    const AttachedBody<3> attached{body.positions(), velocities, pushes, inverse_masses, kCell, false};
    double least = 1e9;
    for (int repeat = 0; repeat < 50; ++repeat) {
      constexpr int kSteps = 200;
      const auto begin = std::chrono::steady_clock::now();
      for (int i = 0; i < kSteps; ++i) {
        for (const std::uint32_t p : patch.particles) velocities[p].y() -= 0.08f;
        attachments.begin({&attached, 1}, {&rigid, 1}, kStep);
        for (int round = 0; round < 2; ++round) attachments.iterate(4);
        attachments.finish();
      }
      const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - begin;
      least = std::min(least, time.count() / kSteps);
    }
    RecordProperty(to_rigid ? "rigid_us" : "world_us", std::to_string(least));
    std::printf("a patch of 20 particles to %s: %.2f us a substep\n", to_rigid ? "a rigid body" : "the world",
                least);
    EXPECT_LT(least, 6) << "a busy machine has three times what is promised";
  }
}

}  // namespace
}  // namespace softcell::ppu::attached
