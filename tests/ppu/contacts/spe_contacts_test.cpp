// Contacts on SPEs: they find what the PPU finds, hold what it holds, and give the same bits whoever computes.

#include "ppu/spe_bodies/spe_contacts.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "contact_world.h"
#include "ppu/contact_solver/rigid_sets.h"
#include "ppu/contacts/find_contacts.h"
#include "ppu/numbers/box_around.h"
#include "softcell/soft_bodies/state_hash.h"
#include "softcell/spe_bodies/spe_runtime.h"
#include "support/slow_build.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

/// A body somewhere, turned and bent, that moves.
struct PlacedBody {
  PlacedBody(const ContactModel& model, const Vector3f& position, const Vector3f& velocity, float bend) {
    const Lattice<3>& lattice = model.lattice();
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
      const Vector3f p = lattice.rest_position(i);
      const Eigen::AngleAxisf turn(0.7f + bend * p.y(), Vector3f(1, 2, -1).normalized());
      positions.push_back(turn * p + position + bend * p.x() * p.z() * Vector3f(0.2f, 1, 0));
    }
    body.model = &model;
    body.positions = positions;
    body.velocities.assign(positions.size(), velocity);
    body.pushes.assign(positions.size(), Vector3f::Zero());
    body.inverse_masses = model.inverse_masses;
    body.box = {positions[0], positions[0]};
    for (std::size_t i = 0; i < positions.size(); ++i) {
      body.ends.push_back(positions[i] + kStep * body.velocities[i]);
      body.box.low = body.box.low.cwiseMin(positions[i]).cwiseMin(body.ends[i]);
      body.box.high = body.box.high.cwiseMax(positions[i]).cwiseMax(body.ends[i]);
    }
  }
  std::vector<Vector3f> positions;
  ContactBody body;
};

/// Both directions, as seen from a.
std::vector<SoftContact> found_by_ppu(const ContactBody& a, const ContactBody& b) {
  EndCells cells_a, cells_b;
  cells_a.begin(a), cells_b.begin(b);
  std::vector<SoftContact> contacts, other_way;
  find_contacts(a, cells_a, b, cells_b, kStep, contacts);
  if (&a == &b) return contacts;
  find_contacts(b, cells_b, a, cells_a, kStep, other_way);
  for (SoftContact& contact : other_way) {
    contact.normal = -contact.normal;
    std::swap(contact.a, contact.b);
    contacts.push_back(contact);
  }
  return contacts;
}

Vector3f vector_of(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

/// Each contact of the one is one of the other, but for those that are as near as contacts may be.
void expect_what_the_ppu_finds(const FoundContacts& found, const ContactBody& a, const ContactBody& b) {
  ASSERT_FALSE(found.by_caller);
  const std::vector<SoftContact> expected = found_by_ppu(a, b);
  int missing = 0;
  for (const SoftContact& contact : expected) {
    const auto same = [&](const spu::SolveContact& other) {
      return (vector_of(other.point) - contact.point).norm() < 1e-4f &&
             (vector_of(other.normal) - contact.normal).norm() < 1e-2f &&
             std::abs(other.least_velocity - contact.least_velocity) < 0.02f &&
             other.cell_a == contact.a.cell && other.cell_b == contact.b.cell &&
             std::abs(other.push_velocity * kStep) <= 0.0201f * 0.15f;
    };
    missing += std::none_of(found.contacts.begin(), found.contacts.end(), same);
  }
  EXPECT_LE(missing, 1 + static_cast<int>(expected.size()) / 20) << "of " << expected.size();
  EXPECT_NEAR(static_cast<double>(found.contacts.size()), static_cast<double>(expected.size()),
              1 + static_cast<double>(expected.size()) / 20);
  bool pushes = false;
  for (const spu::SolveContact& contact : found.contacts) {
    EXPECT_NEAR(vector_of(contact.normal).norm(), 1, 1e-5f);
    float mobility = 0;
    for (int k = 0; k < 8; ++k)
      mobility += contact.a.weight[k] * contact.a.weight[k] + contact.b.weight[k] * contact.b.weight[k];
    EXPECT_NEAR(contact.mass * mobility, 1, 1e-5f);
    pushes = pushes || contact.push_velocity > 0;
  }
  EXPECT_EQ(found.pushes, pushes);
}

/// A worker of its own SPEs.
struct Worker {
  SpeRuntime spes{{.spes = 2}};
  SpeContacts contacts{spes.memory(),
                       spes.jobs(),
                       {spes.kernel("contact_find"), spes.kernel("contact_solve"), spes.kernel("attach")}};

  FoundContacts found(const std::vector<ContactBody>& bodies) {
    contacts.begin(bodies, kStep);
    EXPECT_TRUE(contacts.holds(0) && contacts.holds(1));
    const ContactWorker::Pair pair{0, 1};
    contacts.find({&pair, 1});
    return contacts.found()[0];
  }
};

class SpeContactsFind : public ::testing::TestWithParam<float> {};

TEST_P(SpeContactsFind, WhatThePpuFinds) {
  const ContactModel penguin(make_soft_body_model(make_penguin(0.9f), settings_of(0.15f)));
  const ContactModel ball(make_soft_body_model(make_sphere(0.35f, 16), settings_of(0.12f)));
  Worker worker;
  std::size_t total = 0;
  for (int i = 0; i < 12; ++i) {
    const float angle = 0.5f * static_cast<float>(i);
    const Vector3f apart = 0.42f * Vector3f(std::cos(angle), 0.4f * std::sin(2 * angle), std::sin(angle));
    const PlacedBody first(penguin, {3, 2, 1}, {0.3f, 0, 0}, GetParam());
    const PlacedBody second(i % 2 == 0 ? penguin : ball, Vector3f(3, 2, 1) + apart, -3 * apart, -GetParam());
    SCOPED_TRACE(i);
    const std::vector<ContactBody> bodies{first.body, second.body};
    const FoundContacts found = worker.found(bodies);
    expect_what_the_ppu_finds(found, bodies[0], bodies[1]);
    total += found.contacts.size();
  }
  EXPECT_GT(total, 200u);
}

/// Two models of 100 KB and more each, which only some cells of are near each other.
TEST_P(SpeContactsFind, WhatThePpuFindsOfBodiesThatDoNotFitIntoALocalStoreTogether) {
  const ContactModel ball(make_soft_body_model(make_sphere(0.54f, 24), settings_of(0.12f)));
  const ContactModel box(make_soft_body_model(make_box({1.1f, 0.9f, 0.9f}, 0.12f), settings_of(0.12f)));
  for (const ContactModel* const model : {&ball, &box})
    ASSERT_GT(model->lattice().cells.size() * sizeof(spu::FindCell), spu::kFindMaxBytes / 2);
  Worker worker;
  std::size_t total = 0;
  for (int i = 0; i < 6; ++i) {
    const float angle = static_cast<float>(i);
    const Vector3f apart = 0.87f * Vector3f(std::cos(angle), 0.3f * std::sin(2 * angle), std::sin(angle));
    const PlacedBody first(ball, {3, 2, 1}, {0.3f, 0, 0}, GetParam() / 2);
    const PlacedBody second(box, Vector3f(3, 2, 1) + apart, -2 * apart, -GetParam() / 2);
    SCOPED_TRACE(i);
    const std::vector<ContactBody> bodies{first.body, second.body};
    const FoundContacts found = worker.found(bodies);
    expect_what_the_ppu_finds(found, bodies[0], bodies[1]);
    total += found.contacts.size();
  }
  EXPECT_GT(total, 300u);
}

/// Points that are deep leave by the face by which they came in, in both.
TEST(SpeContacts, WhatThePpuFindsOfBodiesThatArePressedFlatIntoEachOther) {
  const ContactModel box(make_soft_body_model(make_box({0.6f, 0.4f, 0.6f}, 0.08f), settings_of(0.1f)));
  const ContactModel ball(make_soft_body_model(make_sphere(0.3f, 14), settings_of(0.1f)));
  Worker worker;
  for (const ContactModel* const above : {&box, &ball}) {
    PlacedBody first(box, {0, 0, 0}, {0, 0, 0}, 0), second(*above, {0, 0, 0}, {0, 0, 0}, 0);
    const auto press = [](PlacedBody& placed, const Vector3f& position) {
      const Lattice<3>& lattice = placed.body.model->lattice();
      for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
        placed.positions[i] = lattice.rest_position(i).cwiseProduct(Vector3f(1.2f, 0.4f, 1.1f)) + position;
        placed.body.ends[i] = placed.positions[i];
      }
      placed.body.positions = placed.positions;
      placed.body.box = box_around<Bounds<3>>(placed.body.positions);
    };
    press(first, {0, 0, 0});
    press(second, {0.35f, 0.11f, 0.25f});
    const std::vector<ContactBody> bodies{first.body, second.body};
    const FoundContacts found = worker.found(bodies);
    expect_what_the_ppu_finds(found, bodies[0], bodies[1]);
    EXPECT_GT(found.contacts.size(), 50u);
    const auto upright = std::ranges::count_if(found.contacts, [](const spu::SolveContact& contact) {
      return vector_of(contact.normal).y() < -0.5f;
    });
    EXPECT_GT(upright, static_cast<std::ptrdiff_t>(found.contacts.size() * 8 / 10))
        << "of " << found.contacts.size() << ": the first body goes down";
  }
}

INSTANTIATE_TEST_SUITE_P(Bent, SpeContactsFind, ::testing::Values(0.0f, 0.5f, 1.5f));

/// Two bodies in each other, at more points than the kernel has room for: the PPU does it once, and then it is done in parts.
TEST(SpeContacts, BodiesThatTouchAtManyPointsAreLookedAtInParts) {
  const ContactModel ball(make_soft_body_model(make_sphere(0.35f, 24), settings_of(0.1f)));
  Worker worker;
  const PlacedBody first(ball, {0, 0, 0}, {0.1f, 0, 0}, 0), second(ball, {0.08f, 0.02f, 0}, {-0.1f, 0, 0}, 0);
  const std::vector<ContactBody> bodies{first.body, second.body};
  ASSERT_GT(found_by_ppu(bodies[0], bodies[1]).size(), spu::kFindMaxContacts);
  EXPECT_TRUE(worker.found(bodies).by_caller);
  const FoundContacts found = worker.found(bodies);
  expect_what_the_ppu_finds(found, bodies[0], bodies[1]);
  EXPECT_GT(found.contacts.size(), spu::kFindMaxContacts);
  // Apart, and back again: it is not known any more.
  const PlacedBody away(ball, {5, 0, 0}, {0, 0, 0}, 0);
  EXPECT_TRUE(worker.found({first.body, away.body}).contacts.empty());
  EXPECT_TRUE(worker.found(bodies).by_caller);
}

/// A long body bent until its ends meet.
TEST(SpeContacts, WhatAHeapHasInCommonIsFoundAlsoWhenJobsHaveNoRoomForIt) {
  const ContactModel cube(make_soft_body_model(make_box({0.4f, 0.4f, 0.4f}, 0.1f), settings_of(0.2f)));
  std::vector<PlacedBody> placed;
  for (int i = 0; i < 64; ++i)
    placed.emplace_back(cube, 0.0005f * static_cast<float>(i) * Vector3f(1, -1, 1), Vector3f::Zero(), 0.0f);
  std::vector<ContactBody> bodies;
  std::vector<ContactWorker::Pair> pairs;
  for (std::uint32_t a = 0; a < placed.size(); ++a) {
    bodies.push_back(placed[a].body);
    for (std::uint32_t b = a + 1; b < placed.size(); ++b) pairs.push_back({a, b});
  }
  Worker heap, alone;
  heap.contacts.begin(bodies, kStep);
  heap.contacts.find(pairs);
  const std::span<const FoundContacts> found = heap.contacts.found();
  std::size_t count = 0;
  for (const FoundContacts& of_pair : found) count += of_pair.contacts.size();
  EXPECT_GT(count, 150'000u) << "there is room for 131,072 at first";
  for (std::size_t p = 0; p < pairs.size(); p += 29) {
    alone.contacts.begin(bodies, kStep);
    alone.contacts.find({&pairs[p], 1});
    const std::span<const spu::SolveContact> expected = alone.contacts.found()[0].contacts;
    ASSERT_EQ(found[p].contacts.size(), expected.size()) << p;
    EXPECT_EQ(std::memcmp(found[p].contacts.data(), expected.data(), expected.size_bytes()), 0) << p;
    EXPECT_FALSE(found[p].by_caller);
  }
}

TEST(SpeContacts, ABodyMeetsItself) {
  const ContactModel model(make_soft_body_model(make_box({1.8f, 0.2f, 0.2f}, 0.1f), settings_of(0.1f)));
  PlacedBody ring(model, {0, 0, 0}, {0, 0, 0}, 0);
  const Lattice<3>& lattice = model.lattice();
  for (std::size_t i = 0; i < ring.positions.size(); ++i) {
    const Vector3f p = lattice.rest_position(i);
    const float angle = 3.7f * p.x(), radius = 0.4f - p.y();  // more than once around
    ring.positions[i] = {radius * std::cos(angle), radius * std::sin(angle), p.z()};
  }
  ring.body.ends.assign(ring.positions.begin(), ring.positions.end());
  ring.body.box = {Vector3f::Constant(-1), Vector3f::Constant(1)};
  EXPECT_TRUE(may_touch_itself(ring.body));
  Worker its;
  SpeContacts& worker = its.contacts;
  const std::vector<ContactBody> bodies{ring.body};
  worker.begin(bodies, kStep);
  const ContactWorker::Pair itself{0, 0};
  worker.find({&itself, 1});
  const FoundContacts found = worker.found()[0];
  const std::size_t expected = found_by_ppu(bodies[0], bodies[0]).size();
  ASSERT_FALSE(found.by_caller);
  EXPECT_GT(expected, 10u);
  EXPECT_NEAR(static_cast<double>(found.contacts.size()), static_cast<double>(expected),
              1 + static_cast<double>(expected) / 20);
}

/// Penguins, balls and boxes fall in a heap. @return  the hash of all states
std::uint64_t heap(const SpeRuntimeOptions& options, int frames, ls_sim::Findings* findings = nullptr) {
  SpeRuntime spes(options);
  ContactWorld w({0, -9.81f, 0}, &spes);
  w.add_floor();
  w.add(std::make_unique<btBoxShape>(btVector3(0.1f, 0.2f, 2)), 0, {0, 0.2f, 0});
  w.add(std::make_unique<btBoxShape>(btVector3(0.1f, 0.1f, 0.1f)), 4, {0.3f, 1.6f, 0});
  const auto penguin = make_soft_body_model(make_penguin(0.6f), settings_of(0.15f));
  const auto ball = make_soft_body_model(make_sphere(0.25f, 8), settings_of(0.12f));
  for (int i = 0; i < 14; ++i)
    w.bodies.add(i % 3 == 0 ? ball : penguin,
                 {0.3f * static_cast<float>(i % 3), 0.6f + 0.28f * static_cast<float>(i),
                  0.2f * static_cast<float>(i % 4)});
  w.run(frames);
  if (findings != nullptr)
    for (const ls_sim::Finding& finding : spes.findings().list()) findings->add(finding.fault);
  std::uint64_t hash = 0;
  for (std::size_t i = 0; i < w.bodies.size(); ++i) hash = hash * 31 + state_hash(w.bodies[i]);
  EXPECT_GT(hash, 0u);
  return hash;
}

TEST(SpeContacts, TheSameBitsForAnyNumberOfSpesAndAnySchedule) {
  const std::uint64_t expected = heap({.spes = 6}, 40);
  EXPECT_EQ(heap({.spes = 1}, 40), expected);
  EXPECT_EQ(heap({.spes = 3, .schedule = dma::parse_schedule("lazy")}, 40), expected);
  EXPECT_EQ(heap({.spes = 2, .schedule = dma::parse_schedule("random:3")}, 40), expected);
}

/// In the SPU's byte order, with the SPU compiler's code.
/// A small body, a large one that is folded on itself, and a small one again, both on the same other body: found one after the
/// other, the large one lies in the local store where the other body was.
TEST(SpeContacts, ABodyThatMeetsItselfLeavesNothingOfThePairBefore) {
  const auto small = make_soft_body_model(make_box({0.3f, 0.3f, 0.3f}, 0.1f), {.cell_size = 0.1f});
  const auto other = make_soft_body_model(make_box({1.2f, 0.3f, 0.3f}, 0.1f), {.cell_size = 0.15f});
  const auto large = make_soft_body_model(make_box({1.6f, 0.2f, 0.6f}, 0.1f),
                                          {.cell_size = 0.1f, .half_width = 1, .alpha = 0.02f});
  const auto state_with = [&](int spes) {
    SpeRuntime runtime({.spes = spes});
    ContactWorld w({0, 0, 0}, &runtime);
    for (int group = 0; group < 4; ++group) {
      const float x = 10.0f * static_cast<float>(group);
      w.bodies.add(small, {x, 2, 0});
      SoftBody<3>& folded = w.bodies.add(large, {x, 5, 0});
      w.bodies.add(small, {x + 0.8f, 2, 0});
      w.bodies.add(other, {x + 0.4f, 1.72f, 0});
      constexpr float kBend = 3.6f;  // about z, so far that its ends meet
      for (std::size_t p = 0; p < folded.positions().size(); ++p) {
        const Vector3f at = folded.position(p) - Vector3f(x, 5, 0);
        const float angle = kBend * at.x(), radius = 1 / kBend - at.y();
        folded.set_particle(p, {x + radius * std::sin(angle), 5 - radius * std::cos(angle), at.z()},
                            {0, 0, 0});
      }
    }
    w.run(30);
    std::uint64_t state = 0;
    for (std::size_t i = 0; i < w.bodies.size(); ++i) state = state_hash(w.bodies[i], state);
    return state;
  };
  const std::uint64_t with_one = state_with(1);  // whose jobs have several pairs each
  EXPECT_EQ(state_with(2), with_one);
  EXPECT_EQ(state_with(6), with_one);
}

TEST(SpeContacts, InterpretedKernelsGiveTheSameBits) {
  EXPECT_EQ(heap({.spes = 2, .machine = ls_sim::Machine::kSpu}, 16), heap({.spes = 2}, 16));
}

TEST(SpeContacts, CheckedKernelsFindNothingAndGiveTheSameBits) {
  SpeRuntimeOptions checked{.spes = 2, .schedule = dma::parse_schedule("random:1"), .checked = true};
  ls_sim::Findings findings;
  constexpr int kFrames = kSlowBuild ? 12 : 24;
  EXPECT_EQ(heap(checked, kFrames, &findings), heap({.spes = 2}, kFrames));
  for (const ls_sim::Finding& finding : findings.list()) ADD_FAILURE() << finding.fault.message();
}

TEST(SpeContacts, WhatIsDrawnRestsOnWhatIsBelow) {
  constexpr float kCell = 0.1f;
  SpeRuntime spes({.spes = 2});
  ContactWorld w({0, -9.81f, 0}, &spes);
  w.add_floor();
  const SoftBody<3>& body =
      w.add(make_sphere(3.4f * kCell, 12), settings_of(kCell, 0.6f, 0.3f), {0, 0.45f, 0});
  w.run(300);
  EXPECT_NEAR(ContactWorld::lowest_drawn(body), 0, 0.05f * kCell);
  EXPECT_LT(ContactWorld::fastest(body), 0.05f);
  std::vector<Contact> contacts;
  w.bodies.append_contacts(contacts);
  ASSERT_FALSE(contacts.empty());
  for (const Contact& contact : contacts) {
    EXPECT_NEAR(contact.position.y(), 0, 0.01f * kCell);
    EXPECT_GT(contact.normal.y(), 0.99f);
  }
}

/// Two bodies fly at each other, or away from each other.
/// @return  by how much the momentum of both has changed, as a share of the first one's, and that one's velocity
std::pair<double, float> fly(bool towards) {
  SpeRuntime spes({.spes = 2});
  ContactWorld w({0, 0, 0}, &spes);
  const float way = towards ? 1.0f : -1.0f;
  SoftBody<3>& left = w.add(make_sphere(0.4f, 12), settings_of(0.1f), {0, 0, 0});
  SoftBody<3>& right = w.add(make_penguin(0.9f), settings_of(0.12f), {1.1f, 0.1f, 0.05f});
  left.add_velocity({3 * way, 0.2f, 0});
  right.add_velocity({-way, 0, 0.3f});
  const auto momentum = [&] {
    return Eigen::Vector3d((left.linear_momentum() + right.linear_momentum()).cast<double>());
  };
  const Eigen::Vector3d p = momentum();
  const double size = left.linear_momentum().norm();
  w.run(150);
  return {(momentum() - p).norm() / size, left.linear_momentum().x() / left.model().mass()};
}

/// Truncation costs some momentum, but contacts no more than shape matching does without them.
TEST(SpeContacts, TwoBodiesKeepTheirMomentum) {
  const auto [apart, unchanged] = fly(false);
  const auto [meeting, changed] = fly(true);
  EXPECT_NEAR(unchanged, -3, 0.01f);
  EXPECT_LT(changed, 2) << "they have met";
  EXPECT_LT(meeting, 1e-5 + 2 * apart) << apart;
  EXPECT_LT(meeting, 2e-4);
}

Vector3f momentum_of(const btRigidBody& body) {
  const btVector3 v = body.getLinearVelocity() / body.getInvMass();
  return {v.x(), v.y(), v.z()};
}

/// Two boxes, one ten times as heavy as the other, between two bodies: SPEs move all four.
TEST(SpeContacts, RigidBodiesGetWhatBodiesLose) {
  SpeRuntime spes({.spes = 2});
  ContactWorld w({0, 0, 0}, &spes);
  SoftBody<3>& left = w.add(make_sphere(0.4f, 12), settings_of(0.1f), {-0.8f, 0, 0});
  SoftBody<3>& right = w.add(make_penguin(0.9f), settings_of(0.12f), {0.8f, 0.1f, 0.05f});
  left.add_velocity({3, 0.2f, 0});
  right.add_velocity({-2, 0, 0.3f});
  btRigidBody& light = w.add(std::make_unique<btBoxShape>(btVector3(0.15f, 0.1f, 0.15f)), 2, {0, 0.15f, 0});
  btRigidBody& heavy = w.add(std::make_unique<btBoxShape>(btVector3(0.15f, 0.1f, 0.15f)), 20, {0, -0.15f, 0});
  const auto momentum = [&] {
    return Vector3f(left.linear_momentum() + right.linear_momentum() + momentum_of(light) +
                    momentum_of(heavy));
  };
  const Vector3f before = momentum();
  const float size = left.linear_momentum().norm();
  w.run(120);
  EXPECT_GT(momentum_of(light).norm(), 0.01f * size);
  EXPECT_GT(momentum_of(heavy).norm(), 0.01f * size);
  EXPECT_LT((momentum() - before).norm(), 1e-5f * size);
}

/// SPEs and PPU solve the same contacts with the same iterations.
TEST(SpeContacts, RigidBodiesMoveAsThePpuMovesThem) {
  const auto box_after = [](SpeRuntime* spes) {
    ContactWorld w({0, -9.81f, 0}, spes);
    w.add_floor();
    w.add(make_box({0.8f, 0.3f, 0.8f}, 0.1f), settings_of(0.1f, 0.7f, 0.3f), {0, 0.16f, 0});
    btRigidBody& box =
        w.add(std::make_unique<btBoxShape>(btVector3(0.15f, 0.1f, 0.15f)), 12, {0.05f, 0.5f, 0.02f});
    box.setLinearVelocity({1.2f, 0, 0.3f});
    box.setAngularVelocity({0, 2, 0});
    w.run(45);
    return box.getWorldTransform();
  };
  SpeRuntime spes({.spes = 2});
  const btTransform on_spes = box_after(&spes), on_ppu = box_after(nullptr);
  EXPECT_LT((on_spes.getOrigin() - on_ppu.getOrigin()).length(), 0.01f);
  EXPECT_LT(on_spes.getRotation().angleShortestPath(on_ppu.getRotation()), 0.05f);
  EXPECT_GT(on_ppu.getOrigin().x(), 0.08f) << "it has slid";
}

/// A bed of more boxes than SPEs have room for in a set: the PPU solves them.
TEST(SpeContacts, MoreRigidBodiesThanASetHasRoomForAreThere) {
  SpeRuntime spes({.spes = 2});
  ContactWorld w({0, -9.81f, 0}, &spes);
  w.add_floor();
  const SoftBody<3>& bed =
      w.add(make_box({1.7f, 0.2f, 1.7f}, 0.2f), settings_of(0.2f, 0.7f, 0.5f), {0, 0.11f, 0});
  ASSERT_LE(bed.model().particles(), spu::kSolveMaxParticles);
  std::vector<btRigidBody*> boxes;
  for (int x = 0; x < 9; ++x)
    for (int z = 0; z < 9; ++z)
      boxes.push_back(&w.add(std::make_unique<btBoxShape>(btVector3(0.05f, 0.05f, 0.05f)), 0.5f,
                             {0.18f * static_cast<float>(x - 4), 0.3f, 0.18f * static_cast<float>(z - 4)}));
  ASSERT_GT(boxes.size(), RigidSets::kMost);
  w.run(90);
  for (const btRigidBody* box : boxes) {
    EXPECT_NEAR(box->getWorldTransform().getOrigin().y(), 0.25f, 0.03f);
    EXPECT_LT(box->getLinearVelocity().length(), 0.1f);
  }
}

/// They are solved in parts.
TEST(SpeContacts, MoreContactsThanALocalStoreHasRoomForAreSolved) {
  const auto heights = [](SpeRuntime* spes) {
    ContactWorld w({0, -9.81f, 0}, spes);
    w.add_floor();
    const SoftBodySettings settings = settings_of(0.1f, 0.4f, 0.5f);
    const auto model = make_soft_body_model(make_box({1.6f, 0.2f, 1.6f}, 0.1f), settings);
    for (int i = 0; i < 2; ++i) w.bodies.add(model, {0, 0.105f + 0.205f * static_cast<float>(i), 0});
    EXPECT_LE(model->particles(), spu::kSolveMaxParticles);
    std::size_t most = 0;
    for (int i = 0; i < 60; ++i) {
      w.run(1);
      std::vector<Contact> contacts;
      w.bodies.append_contacts(contacts);
      most = std::max(most, static_cast<std::size_t>(std::ranges::count_if(
                                contacts, [](const Contact& c) { return c.position.y() > 0.1f; })));
    }
    EXPECT_GT(most, spu::kSolveMaxContacts) << "of the two bodies";
    return std::pair(w.bodies[0].centre_of_mass().y(), w.bodies[1].centre_of_mass().y());
  };
  SpeRuntime spes({.spes = 2});
  const auto on_spes = heights(&spes), on_ppu = heights(nullptr);
  EXPECT_NEAR(on_spes.first, on_ppu.first, 0.002f);
  EXPECT_NEAR(on_spes.second, on_ppu.second, 0.002f);
  EXPECT_GT(on_spes.second, 0.25f);
}

/// What the SPEs cannot do, the PPU does in between: contacts of a body of too many particles.
TEST(SpeContacts, RigidBodiesThatMoveAndLargeBodiesAreThere) {
  constexpr float kCell = 0.1f;
  SpeRuntime spes({.spes = 2});
  ContactWorld w({0, -9.81f, 0}, &spes);
  w.add_floor();
  const SoftBody<3>& large =
      w.add(make_box({1.2f, 0.6f, 1.2f}, kCell), settings_of(kCell, 0.7f, 0.3f), {0, 0.31f, 0});
  ASSERT_GT(large.model().particles(), spu::kSolveMaxParticles);
  const SoftBody<3>& small =
      w.add(make_box({0.5f, 0.3f, 0.5f}, kCell), settings_of(kCell, 0.7f, 0.3f), {0, 0.8f, 0});
  btRigidBody& box = w.add(std::make_unique<btBoxShape>(btVector3(0.15f, 0.1f, 0.15f)), 10, {0, 1.1f, 0});
  w.run(240);
  EXPECT_NEAR(ContactWorld::lowest_drawn(large), 0, 0.05f * kCell);
  EXPECT_GT(ContactWorld::lowest_drawn(small), 0.45f);
  EXPECT_GT(box.getWorldTransform().getOrigin().y(), 0.45f + 0.15f);
  EXPECT_LT(box.getLinearVelocity().length(), 0.1f);
}

TEST(SpeContacts, SleepersHoldWhatTouchesThemAndWake) {
  SpeRuntime spes({.spes = 2});
  ContactWorld w({0, 0, 0}, &spes);
  w.bodies.let_sleep(SleepSettings{.speed = 0.1f, .seconds = 0.1f});
  SoftBody<3>& sleeper = w.add(make_box({0.4f, 0.4f, 0.4f}, 0.1f), settings_of(0.1f), {0, 0, 0});
  w.run(30);
  ASSERT_TRUE(sleeper.asleep());
  SoftBody<3>& thrown = w.add(make_box({0.4f, 0.4f, 0.4f}, 0.1f), settings_of(0.1f), {0, 0.5f, 0});
  thrown.add_velocity({0, -2, 0});
  const Vector3f momentum = thrown.linear_momentum();
  w.run(30);
  EXPECT_FALSE(sleeper.asleep());
  EXPECT_LT((thrown.linear_momentum() + sleeper.linear_momentum() - momentum).norm(), 0.2f * momentum.norm());
}

}  // namespace
}  // namespace softcell::ppu
