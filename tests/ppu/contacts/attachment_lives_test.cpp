// How attachments are made, moved, put to sleep and ended, and what is refused.

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "attached_world.h"
#include "softcell/soft_bodies/fracture.h"
#include "softcell/soft_bodies/state_hash.h"

namespace softcell::ppu::attached {
namespace {

class AttachmentLives : public SolvedByBoth {};
INSTANTIATE_TEST_SUITE_P(SolvedBy, AttachmentLives, kBothSolvers, SolvedByBoth::name);

/// As docs/guide/soft-bodies.md has it: the place of a weld is the middle of its patch, which lies below the point that the ray meets.
TEST_P(AttachmentLives, AHandTakesABodyWhereARayMeetsItWithoutAJolt) {
  AttachedWorld w(GetParam(), {0, 0, 0});
  SoftBody<3>& body = w.add(block({0.4f, 0.4f, 0.4f}), settings_of(kCell, 0.5f, 0.5f), {0, 0, 0});
  const auto hit = w.bodies.cast_ray({0.05f, 2, 0.03f}, {0.05f, -2, 0.03f});
  ASSERT_TRUE(hit);
  ASSERT_EQ(hit->body, &body);
  const AttachmentId hand = w.bodies.attach(*hit->body, Patch<3>::of_surface(hit->hit.position, 1.5f * kCell),
                                            {.compliance = 1e-4f});
  const Vector3f offset = w.bodies.attachment_ends(hand)->patch - hit->hit.position;
  EXPECT_LT(offset.y(), -0.1f * kCell);
  const Vector3f before = body.centre_of_mass();
  for (int i = 0; i < 60; ++i) {
    w.bodies.move_attachment(hand, hit->hit.position + offset, Eigen::Quaternionf::Identity(), kStep);
    w.run(1);
    ASSERT_LT(w.bodies.attachment(hand)->force.norm(), 1e-2f) << i;
  }
  EXPECT_LT((body.centre_of_mass() - before).norm(), 1e-5f);
  w.bodies.move_attachment(hand, hit->hit.position + offset + Vector3f(0, 1, 0),
                           Eigen::Quaternionf::Identity(), 1);
  w.run(240);
  EXPECT_NEAR(body.centre_of_mass().y(), before.y() + 1, 0.01f) << "it comes along";
}

TEST_P(AttachmentLives, FollowAPointThatTheProgramMoves) {
  AttachedWorld w(GetParam(), {0, 0, 0});
  SoftBody<3>& body = w.add(block({0.3f, 0.3f, 0.3f}), settings_of(kCell, 0.5f, 0.5f), {0, 0, 0});
  const auto top = top_of(body);
  const AttachmentId hand = w.bodies.attach(body, Patch<3>::of_particles(top));
  const Vector3f start = middle_of(body, top);
  const Eigen::Quaternionf turn(Eigen::AngleAxisf(1, Vector3f::UnitY()));
  w.bodies.move_attachment(hand, start + Vector3f(1, 0.5f, 0), turn, 0.5f);
  w.run(15);
  EXPECT_LT((middle_of(body, top) - start - Vector3f(0.5f, 0.25f, 0)).norm(), 1e-3f) << "evenly";
  w.run(240);
  EXPECT_LT((middle_of(body, top) - start - Vector3f(1, 0.5f, 0)).norm(), 1e-3f);
  EXPECT_LT(ContactWorld::fastest(body), 0.2f);
  const Vector3f arm = body.position(top.back()) - body.position(top.front());
  EXPECT_GT(arm.normalized().dot((turn * (body.model().lattice().rest_position(top.back()) -
                                          body.model().lattice().rest_position(top.front())))
                                     .normalized()),
            0.999f);
}

TEST(Attachments, WhereAWeldIsHeldIsWhereItMayBeMovedTo) {
  ContactWorld w({0, 0, 0});
  const SoftBody<3>& body = w.add(make_box({0.6f, 0.6f, 0.6f}, 0.2f), {.cell_size = 0.2f}, {0, 0, 0});
  for (const auto& patch : {Patch<3>::of_cells({2, 5, 8}), Patch<3>::of_surface({0, 0.3f, 0}, 0.25f)}) {
    const AttachmentId weld = w.bodies.attach(body, patch);
    w.run(1);
    const Vector3f before = body.centre_of_mass();
    for (int i = 0; i < 5; ++i) {
      w.bodies.move_attachment(weld, w.bodies.attachment_ends(weld)->other);
      w.run(60);
    }
    EXPECT_LT((body.centre_of_mass() - before).norm(), 1e-4f);
    w.bodies.detach(weld);
  }
}

TEST(Attachments, ASleeperFollowsWhatItHangsFromHoweverSlow) {
  ContactWorld w;
  w.bodies.let_sleep(SleepSettings{});
  const SoftBody<3>& body =
      w.add(make_box({0.6f, 0.6f, 0.6f}, 0.2f), {.cell_size = 0.2f, .damping = 0.3f}, {0, 0, 0});
  btRigidBody& carrier = w.add(std::make_unique<btBoxShape>(btVector3(0.5f, 0.1f, 0.5f)), 0, {0, 0.4f, 0});
  carrier.setCollisionFlags(btCollisionObject::CF_KINEMATIC_OBJECT);
  carrier.setActivationState(DISABLE_DEACTIVATION);
  w.bodies.attach(body, Patch<3>::of_surface({0, 0.3f, 0}, 0.5f), carrier);
  w.run(300);
  ASSERT_TRUE(body.asleep());
  float x = 0;
  for (; x < 0.3f; x += 0.024f / 60) {
    carrier.setWorldTransform(btTransform(btQuaternion::getIdentity(), btVector3(x, 0.4f, 0)));
    w.run(1);
  }
  EXPECT_NEAR(body.centre_of_mass().x(), 0.3f, 0.02f);
}

/// The smaller part of a cut body is another body than before, and its attachment is that body's.
TEST(Attachments, APieceThatSleepsFollowsWhatItHangsFrom) {
  ContactWorld w;
  w.bodies.let_sleep(SleepSettings{});
  const SoftBody<3>& body =
      w.add(make_box({0.6f, 1.2f, 0.6f}, 0.2f), {.cell_size = 0.2f, .damping = 0.3f}, {0, -0.3f, 0});
  SoftBody<3>& carrier = w.add(make_box({0.6f, 0.6f, 0.6f}, 0.2f), {.cell_size = 0.2f}, {0, 1.2f, 0});
  const AttachmentId hold = w.bodies.attach(carrier, Patch<3>::of_particles(top_of(carrier)));
  w.bodies.attach(carrier, Patch<3>::of_surface({0, 0.9f, 0}, 0.5f), body,
                  Patch<3>::of_surface({0, 0.3f, 0}, 0.5f));
  const auto pieces = w.bodies.cut(body, Cut::plane({0, -0.101f, 0}, {0, 1, 0}));
  ASSERT_EQ(pieces.size(), 1u);
  const SoftBody<3>& piece = *pieces.front();
  EXPECT_LT(piece.model().mass(), body.model().mass());
  for (int i = 0; i < 1200 && !piece.asleep(); ++i) {
    w.run(1);
    ASSERT_EQ(piece.asleep(), carrier.asleep()) << "frame " << i;
  }
  ASSERT_TRUE(piece.asleep());
  const float before = piece.centre_of_mass().y();
  w.bodies.detach(hold);
  w.run(1);
  EXPECT_FALSE(piece.asleep());
  w.run(30);
  EXPECT_LT(piece.centre_of_mass().y(), before - 0.5f) << "both fall";
}

/// The program may move a static or kinematic body so slowly that what hangs from it counts as resting.
TEST(Attachments, WhatSleepsFollowsTheRigidBodyThatTheProgramMoves) {
  for (const bool is_kinematic : {false, true}) {
    SCOPED_TRACE(is_kinematic);
    AttachedWorld w(Who::kPpu);
    w.bodies.let_sleep(SleepSettings{.seconds = 0.5f});
    btRigidBody& beam = w.add(std::make_unique<btBoxShape>(btVector3(0.5f, 0.1f, 0.5f)), 0, {0, 2, 0});
    if (is_kinematic) {
      beam.setCollisionFlags(beam.getCollisionFlags() | btCollisionObject::CF_KINEMATIC_OBJECT);
      beam.setActivationState(DISABLE_DEACTIVATION);
    }
    const SoftBody<3>& body = w.add(block({0.6f, 0.3f, 0.3f}), stiff(), {0, 1.75f, 0});
    w.bodies.attach(body, Patch<3>::of_surface({0, 1.9f, 0}, 0.2f), beam);
    w.run(240);
    ASSERT_TRUE(body.asleep());
    const float before = body.centre_of_mass().y();
    bool slept = false;
    for (int frame = 1; frame <= 300; ++frame) {
      btTransform there = beam.getWorldTransform();
      there.setOrigin({0, 2 + 0.1f * static_cast<float>(frame) / 300, 0});
      beam.setWorldTransform(there);
      w.run(1);
      slept |= body.asleep();
    }
    EXPECT_FALSE(slept);
    EXPECT_NEAR(body.centre_of_mass().y(), before + 0.1f, 0.005f);
    w.run(120);
    EXPECT_TRUE(body.asleep());
  }
}

TEST(Attachments, WhatIsAttachedSleepsAndWakesTogether) {
  ContactWorld w;
  w.bodies.let_sleep(SleepSettings{.speed = 0.1f, .seconds = 0.2f});
  SoftBody<3>& upper = w.add(block({0.3f, 0.3f, 0.3f}), settings_of(kCell, 0.7f, 0.4f), {0, 0, 0});
  SoftBody<3>& lower = w.add(block({0.3f, 0.3f, 0.3f}), settings_of(kCell, 0.7f, 0.4f), {0, -0.8f, 0});
  btRigidBody& weight = w.add(std::make_unique<btBoxShape>(btVector3(0.1f, 0.1f, 0.1f)), 2, {0, -1.5f, 0});
  const AttachmentId weld = w.bodies.attach(upper, Patch<3>::of_particles(top_of(upper)));
  w.bodies.attach(upper, Patch<3>::of_surface({0, -0.15f, 0}, 0.12f), lower,
                  Patch<3>::of_surface({0, -0.65f, 0}, 0.12f), {.kind = AttachmentKind::kRope});
  w.bodies.attach(lower, Patch<3>::of_surface({0, -0.95f, 0}, 0.12f), weight,
                  {.kind = AttachmentKind::kRope});
  for (int i = 0; i < 1200 && !upper.asleep(); ++i) {
    w.run(1);
    ASSERT_EQ(upper.asleep(), lower.asleep());
  }
  ASSERT_TRUE(upper.asleep());
  const Vector3f rest = to_eigen(weight.getWorldTransform().getOrigin());
  w.run(120);
  EXPECT_TRUE(upper.asleep());
  EXPECT_LT((to_eigen(weight.getWorldTransform().getOrigin()) - rest).norm(), 1e-4f)
      << "it hangs on what sleeps";
  weight.activate();
  weight.setLinearVelocity({1, 0, 0});
  w.run(1);
  EXPECT_FALSE(upper.asleep());
  EXPECT_FALSE(lower.asleep());
  weight.setDamping(0.3f, 0.3f);  // nothing else ends its swinging
  for (int i = 0; i < 2400 && !upper.asleep(); ++i) w.run(1);
  ASSERT_TRUE(upper.asleep());
  w.bodies.detach(weld);
  EXPECT_FALSE(upper.asleep());
  w.run(30);
  EXPECT_LT(lower.centre_of_mass().y(), -1) << "all of it falls";
}

TEST(Attachments, ThingsThatVanishTakeTheirAttachmentsWithThem) {
  ContactWorld w;
  SoftBody<3>& first = w.add(block({0.3f, 0.3f, 0.3f}), settings_of(kCell), {0, 0, 0});
  SoftBody<3>& second = w.add(block({0.3f, 0.3f, 0.3f}), settings_of(kCell), {0.5f, 0, 0});
  const Patch<3> of_first = Patch<3>::of_surface({0.15f, 0, 0}, 0.1f),
                 of_second = Patch<3>::of_surface({0.35f, 0, 0}, 0.1f);
  const AttachmentId rope =
      w.bodies.attach(first, of_first, second, of_second, {.kind = AttachmentKind::kRope});
  btSphereShape shape(0.1f);
  auto rigid = std::make_unique<btRigidBody>(1, nullptr, &shape);
  EXPECT_THROW(w.bodies.attach(first, of_first, *rigid), std::invalid_argument) << "it is not in the world";
  w.world.addRigidBody(rigid.get());
  const AttachmentId weld = w.bodies.attach(first, of_first, *rigid);
  w.run(2);
  w.world.removeRigidBody(rigid.get());
  rigid.reset();
  EXPECT_NO_THROW(w.bodies.attach(first, of_first, second, of_second, {.kind = AttachmentKind::kRope}));
  w.run(2);
  ASSERT_FALSE(w.bodies.attachment(weld));
  auto ended = w.bodies.poll_ended_attachments();
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].id, weld);
  EXPECT_EQ(ended[0].reason, EndedAttachment::Reason::kGone);
  EXPECT_THROW(w.bodies.detach(weld), std::invalid_argument);
  w.bodies.remove(second);
  EXPECT_FALSE(w.bodies.attachment(rope));
  EXPECT_EQ(w.bodies.poll_ended_attachments().size(), 2u);
  w.run(2);
}

/// Its attachments refer to particles that the body no longer has. Those made after the assignment stay.
TEST(Attachments, EndWhenABodyOfAnotherModelIsAssigned) {
  ContactWorld w;
  SoftBody<3>& body = w.add(block({0.3f, 0.3f, 0.3f}), settings_of(kCell), {0, 0, 0});
  const auto other = make_soft_body_model(block({0.2f, 0.2f, 0.2f}), settings_of(kCell));
  const AttachmentId before = w.bodies.attach(body, Patch<3>::of_surface({0, 0.15f, 0}, 0.1f));
  w.run(1);
  EXPECT_TRUE(w.bodies.attachment(before));
  body = SoftBody<3>(other, {0, 0, 0});
  const AttachmentId after = w.bodies.attach(body, Patch<3>::of_surface({0, 0.1f, 0}, 0.1f));
  w.run(1);
  EXPECT_FALSE(w.bodies.attachment(before));
  EXPECT_TRUE(w.bodies.attachment(after));
  const auto ended = w.bodies.poll_ended_attachments();
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].id, before);
}

/// The sentence of what is refused, or nothing.
template <typename Work>
std::string refusal(const Work& work) {
  try {
    work();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(Attachments, SayWhatIsOutOfRange) {
  ContactWorld w;
  SoftBody<3>& body = w.add(block({0.3f, 0.3f, 0.3f}), settings_of(kCell), {0, 0, 0});
  const Patch<3> patch = Patch<3>::of_surface({0.15f, 0, 0}, 0.1f);
  const auto refuse = [&](const Patch<3>& its_patch, const AttachmentSettings<3>& settings) {
    return refusal([&] { w.bodies.attach(body, its_patch, settings); });
  };
  EXPECT_EQ(refuse(patch, {.compliance = -1}),
            "an attachment's compliance is -1; it must be in m/N, 0 or above, and finite");
  EXPECT_EQ(refuse(patch, {.break_force = 0}),
            "an attachment's break_force is 0; it must be in newtons and above 0");
  EXPECT_EQ(refuse(patch, {.kind = AttachmentKind::kRope, .length = -2}),
            "an attachment's length is -2; it must be in metres, above 0, and finite");
  EXPECT_EQ(refuse(patch, {.length = 2}), "an attachment has a length and is no rope; only ropes have one");
  EXPECT_EQ(refuse(patch, {.point = Vector3f(0, 1, 0)}),
            "an attachment has a point and is a weld; only hinges and ropes have one");
  EXPECT_EQ(refuse(patch, {.kind = AttachmentKind::kRope}),
            "a rope to the world has no point; it needs the place of its other end");
  EXPECT_EQ(refuse(patch, {.kind = AttachmentKind::kHinge, .axis = {0, 0, 0}}),
            "a hinge's axis has no direction; it must be finite and longer than 0");
  EXPECT_EQ(refuse(Patch<3>::of_particles({0}), {.kind = AttachmentKind::kHinge}),
            "a hinge, or a weld of two soft bodies, needs patches of at least four particles that do not lie "
            "in a plane");
  EXPECT_EQ(refuse({}, {}), "a patch has 0 of particles, cells and a radius; it needs exactly one of them");
  EXPECT_EQ(refuse(Patch<3>::of_particles({64}), {}),
            "a patch has particle 64; the soft body has 64, numbered from 0");
  EXPECT_EQ(refuse(Patch<3>::of_surface({2.15f, 0, 0}, 0.5f), {}),
            "no surface of the soft body is within 0.5 m of the middle of a patch; the nearest is 2 m away");
  EXPECT_EQ(refusal([&] { w.bodies.attach(body, patch, body, patch); }),
            "a soft body cannot be attached to itself");
  EXPECT_NE(refuse(patch, {.kind = AttachmentKind::kHinge, .point = Vector3f(0, 9, 0)})
                .find("; it may be 12 times as far: a larger patch can be held there"),
            std::string::npos);
  const AttachmentId weld = w.bodies.attach(body, patch);
  EXPECT_EQ(refusal([&] {
              w.bodies.move_attachment(weld, {0, 0, 0}, Eigen::Quaternionf::Identity(), -1);
            }),
            "an attachment is moved within -1 s; it must be 0 or above, and finite");
  EXPECT_EQ(refusal([&] { w.bodies.detach(AttachmentId{7}); }), "there is no attachment 7");
  EXPECT_EQ(refusal([&] { w.bodies.detach(AttachmentId{}); }), "there is no attachment 0")
      << "a default one names none";
  EXPECT_FALSE(w.bodies.attachment(AttachmentId{}));

  BulletSoftBodies spheres(w.world, ContactMethod::kSpheres);
  SoftBody<3>& of_spheres =
      spheres.add(make_soft_body_model(block({0.3f, 0.3f, 0.3f}), settings_of(kCell)), {5, 0, 0});
  EXPECT_EQ(refusal([&] { spheres.attach(of_spheres, Patch<3>::of_particles({0})); }),
            "the soft body to be attached does not touch with its surface; attachments are solved with "
            "contacts of surfaces");
}

/// Chains of bodies swing against each other and a wall. @return  the hash of all states
std::uint64_t chains(const SpeRuntimeOptions& options) {
  SpeRuntime spes(options);
  ContactWorld w({0, -9.81f, 0}, &spes);
  w.add_floor();
  w.add(std::make_unique<btBoxShape>(btVector3(0.1f, 1, 1)), 0, {0.9f, 0.5f, 0});
  btRigidBody& weight = w.add(std::make_unique<btBoxShape>(btVector3(0.1f, 0.1f, 0.1f)), 3, {0, 0.4f, 0});
  std::vector<SoftBody<3>*> bodies;
  for (int i = 0; i < 6; ++i)
    bodies.push_back(&w.add(block({0.3f, 0.3f, 0.3f}), settings_of(kCell),
                            {0.4f * static_cast<float>(i % 2), 0.9f + 0.35f * static_cast<float>(i / 2), 0}));
  for (std::size_t i = 0; i + 2 < bodies.size(); ++i) {
    const Vector3f joint = 0.5f * (bodies[i]->centre_of_mass() + bodies[i + 2]->centre_of_mass());
    w.bodies.attach(
        *bodies[i], Patch<3>::of_surface(joint, 0.2f), *bodies[i + 2], Patch<3>::of_surface(joint, 0.2f),
        {.kind = i % 2 == 0 ? AttachmentKind::kWeld : AttachmentKind::kHinge, .break_force = 400});
  }
  for (std::size_t i = 4; i < 6; ++i) w.bodies.attach(*bodies[i], Patch<3>::of_particles(top_of(*bodies[i])));
  w.bodies.attach(*bodies[0], Patch<3>::of_surface({0, 0.75f, 0}, 0.1f), weight,
                  {.kind = AttachmentKind::kRope});
  bodies[0]->add_velocity({3, 0, 1});
  w.run(60);
  std::uint64_t hash = 0;
  for (const auto* body : bodies) hash = hash * 31 + state_hash(*body);
  return hash;
}

TEST(Attachments, TheSameBitsForAnyNumberOfSpesAndAnySchedule) {
  const std::uint64_t expected = chains({.spes = 6});
  EXPECT_EQ(chains({.spes = 1}), expected);
  EXPECT_EQ(chains({.spes = 3, .schedule = dma::parse_schedule("lazy")}), expected);
  EXPECT_EQ(chains({.spes = 2, .schedule = dma::parse_schedule("random:5")}), expected);
}

/// Random attachments to things that come and go: nothing becomes infinite, and nobody gets energy from nothing.
TEST_P(AttachmentLives, TheySurviveRandomLives) {
  for (unsigned seed = 0; seed < 6; ++seed) {
    std::mt19937 random(seed);
    const auto pick = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
    const auto number = [&](float low, float high) {
      return low + (high - low) * static_cast<float>(random() % 1000) / 1000;
    };
    const std::unique_ptr<SpeRuntime> spes =
        GetParam() == Who::kSpes ? std::make_unique<SpeRuntime>(SpeRuntimeOptions{.spes = 2}) : nullptr;
    ContactWorld w({0, -9.81f, 0}, spes.get());
    w.add_floor();
    btBoxShape shape(btVector3(0.15f, 0.15f, 0.15f));
    std::vector<std::unique_ptr<btRigidBody>> rigid;
    std::vector<AttachmentId> ids;
    const auto model = make_soft_body_model(block({0.3f, 0.3f, 0.3f}), settings_of(kCell));
    // Two cells, of a fifth of a rigid body's mass.
    const auto light = make_soft_body_model(block({2 * kCell, kCell, kCell}), settings_of(kCell));
    // A crushed cell may be too flat for a hinge, and another body too far away.
    const auto attach = [&](const auto& work) {
      try {
        ids.push_back(work());
      } catch (const std::invalid_argument& error) {
        const std::string sentence = error.what();
        EXPECT_TRUE(sentence.find("lie in a plane") != std::string::npos ||
                    sentence.find("as far from its middle") != std::string::npos)
            << sentence;
      }
    };
    for (int i = 0; i < 150; ++i) {
      const Vector3f place(number(-1, 1), number(0.3f, 2), number(-1, 1));
      switch (pick(7)) {
        case 0:
          if (w.bodies.size() < 6) w.bodies.add(pick(2) == 0 ? model : light, place);
          break;
        case 1:
          if (w.bodies.size() > 2)
            w.bodies.remove(w.bodies[static_cast<std::size_t>(pick(static_cast<int>(w.bodies.size())))]);
          break;
        case 2:
          if (rigid.size() < 4) {
            btVector3 inertia;
            shape.calculateLocalInertia(2, inertia);
            rigid.push_back(std::make_unique<btRigidBody>(2, nullptr, &shape, inertia));
            rigid.back()->getWorldTransform().setOrigin(to_bullet(place));
            w.world.addRigidBody(rigid.back().get());
          }
          break;
        case 3:
          if (!rigid.empty()) {
            w.world.removeRigidBody(rigid.back().get());
            rigid.pop_back();
          }
          break;
        default: {
          if (w.bodies.size() == 0) break;
          SoftBody<3>& body = w.bodies[static_cast<std::size_t>(pick(static_cast<int>(w.bodies.size())))];
          AttachmentSettings<3> settings{.kind = static_cast<AttachmentKind>(pick(3)),
                                         .compliance = pick(2) == 0 ? 0 : number(0, 1e-3f),
                                         .break_force = pick(2) == 0 ? 1e9f : number(1, 500)};
          if (settings.kind == AttachmentKind::kRope) settings.length = number(0.1f, 1);
          const Patch<3> patch =
              pick(2) == 0 ? Patch<3>::of_surface(body.centre_of_mass(), 0.4f) : Patch<3>::of_cells({0});
          SoftBody<3>& other = w.bodies[static_cast<std::size_t>(pick(static_cast<int>(w.bodies.size())))];
          if (settings.kind == AttachmentKind::kRope && rigid.empty()) settings.point = place;
          if (pick(2) == 0 && &other != &body) {
            settings.point.reset();
            attach([&] { return w.bodies.attach(body, patch, other, Patch<3>::of_cells({1}), settings); });
          } else if (!rigid.empty()) {
            attach([&] { return w.bodies.attach(body, patch, *rigid[0], settings); });
          } else {
            attach([&] { return w.bodies.attach(body, patch, settings); });
          }
          if (ids.size() > 8) {
            for (const AttachmentId id : ids)
              if (w.bodies.attachment(id)) w.bodies.detach(id);
            ids.clear();
          }
        }
      }
      w.run(2);
      for (std::size_t b = 0; b < w.bodies.size(); ++b) {
        // Attachments that contradict each other throw particles about.
        ASSERT_LT(ContactWorld::fastest(w.bodies[b]), 60) << seed << " " << i;
        ASSERT_LT(w.bodies[b].bounds().high.cwiseAbs().maxCoeff(), 100) << seed << " " << i;
      }
    }
    // Where nobody attaches anything any more, they calm down.
    w.run(240);
    for (std::size_t b = 0; b < w.bodies.size(); ++b)
      ASSERT_LT(ContactWorld::fastest(w.bodies[b]), 15) << seed << " " << b;
    for (const auto& body : rigid) w.world.removeRigidBody(body.get());
  }
}

}  // namespace
}  // namespace softcell::ppu::attached
