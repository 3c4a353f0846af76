// Groups of contacts, and what is found out about them before they are solved.

#include "ppu/contact_solver/contact_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "contact_world.h"
#include "ppu/contact_solver/group_turns.h"
#include "ppu/contact_solver/hits.h"
#include "ppu/contact_solver/presses.h"
#include "ppu/contact_solver/touched_cells.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;
using Numbers = std::vector<std::uint32_t>;

SoftContact contact_of_cells(std::uint32_t a, std::uint32_t b = Anchor::kNoCell) {
  SoftContact contact;
  contact.a.cell = a, contact.b.cell = b;
  return contact;
}

TEST(ContactGroups, HavePairsBeforeRigidBodies) {
  ContactGroups groups;
  for (const int substep : {0, 1}) {
    groups.clear();
    EXPECT_TRUE(groups.empty());
    for (const std::uint32_t a : {3u, 5u, 6u}) {
      ContactGroup& group = groups.append(a, a, true);
      EXPECT_TRUE(group.contacts.empty()) << "in substep " << substep;
      EXPECT_FALSE(group.heavy || group.alternates || group.on_held || group.sharp || group.fast);
      group.heavy = group.alternates = group.on_held = group.sharp = group.fast = true;
      if (a != 5) group.contacts.push_back(contact_of_cells(a));
      groups.drop_last_if_empty();
    }
    for (const std::uint32_t b : {1u, 2u, 3u}) {
      groups.append(0, b, false).contacts.push_back(contact_of_cells(0, b));
      groups.drop_last_if_empty();
    }
    groups.put_pairs_first(2);
    ASSERT_EQ(groups.size(), 5u);
    ASSERT_EQ(groups.of_pairs().size(), 3u);
    ASSERT_EQ(groups.with_rigid().size(), 2u);
    for (std::uint32_t b = 1; b <= 3; ++b) EXPECT_EQ(groups.of_pairs()[b - 1].b, b);
    EXPECT_EQ(groups.with_rigid()[0].a, 3u);
    EXPECT_EQ(groups.with_rigid()[1].a, 6u);
    EXPECT_EQ(groups.with_rigid()[1].size(), 1u);
  }
}

/// Two bodies: one box of 27 cells of 0.1 m, the other at the same place.
class TwoBodies : public testing::Test {
 protected:
  TwoBodies() : positions_(model_.lattice().particles.size(), Vector3f::Zero()) {
    for (ContactBody& body : bodies_) {
      body.model = &model_;
      body.positions = positions_;
      body.velocities.assign(positions_.size(), Vector3f(0, -1, 0));
      body.inverse_masses = model_.inverse_masses;
    }
  }

  ContactGroup& with_rigid(std::uint32_t body, const std::vector<std::uint32_t>& rigids) {
    ContactGroup& group = groups_.append(body, body, true);
    for (const std::uint32_t rigid : rigids) {
      SoftContact& contact = group.contacts.emplace_back();
      contact.a = anchor_in_cell(model_.lattice(), 0, Vector3f::Constant(0.5f));
      contact.rigid = rigid;
    }
    return group;
  }

  ContactModel model_{make_soft_body_model(make_box({0.3f, 0.3f, 0.3f}, 0.1f), settings_of(0.1f))};
  std::vector<Vector3f> positions_;
  std::vector<ContactBody> bodies_{2};
  ContactGroups groups_;
};

TEST_F(TwoBodies, AreTouchedInEachCellOnce) {
  ContactGroup& pair = groups_.append(0, 1, false);
  for (const auto& [a, b] : {std::pair(7u, 2u), std::pair(4u, 2u), std::pair(7u, 9u), std::pair(4u, 9u)})
    pair.contacts.push_back(contact_of_cells(a, b));
  ContactGroup& rigid = groups_.append(1, 1, true);
  rigid.contacts.push_back(contact_of_cells(5));
  TouchedCells touched;
  touched.find(bodies_, groups_.all());
  EXPECT_TRUE(std::ranges::equal(touched.of(0), Numbers{4, 7}));
  EXPECT_TRUE(std::ranges::equal(touched.of(1), Numbers{2, 5, 9}));
  bodies_[1].asleep = true;
  touched.find(bodies_, groups_.all());
  EXPECT_TRUE(std::ranges::equal(touched.of(0), Numbers{4, 7}));
  EXPECT_TRUE(touched.of(1).empty());
}

/// A rigid body heavier than the soft one makes a group heavy; one lighter than a fifth of two soft ones lets both take turns.
TEST_F(TwoBodies, TakeTurnsAtALightRigidBody) {
  const float mass = model_.mass();
  std::vector<ContactRigid> rigids(4);
  rigids[1].inverse_mass = 1 / (0.19f * mass);
  rigids[2].inverse_mass = 1 / (0.21f * mass);
  rigids[3].inverse_mass = 1 / (1.01f * mass);
  struct Case {
    Numbers of_first, of_second;
    bool alternate, heavy;
  };
  for (const Case& expected :
       {Case{{0}, {0}, false, false}, Case{{1}, {1}, true, false}, Case{{2}, {2}, false, false},
        Case{{3}, {3}, false, true}, Case{{1}, {2}, false, false}, Case{{0, 1}, {1, 3}, true, true}}) {
    groups_.clear();
    with_rigid(0, expected.of_first), with_rigid(1, expected.of_second);
    groups_.put_pairs_first(2);
    GroupTurns().weigh(groups_.with_rigid(), bodies_, rigids);
    const ContactGroup& second = groups_.with_rigid()[1];
    EXPECT_EQ(second.alternates, expected.alternate) << expected.of_second.back();
    EXPECT_EQ(second.heavy, expected.heavy) << expected.of_second.back();
  }
}

TEST_F(TwoBodies, AlternateOneIterationAtATime) {
  for (const std::uint32_t body : {0u, 0u, 1u}) groups_.append(body, body, true);
  ContactGroup &alone = groups_[0], &first = groups_[1], &second = groups_[2];
  first.alternates = second.alternates = second.heavy = true;
  std::vector<ContactGroup*> all{&first, &alone, &second};
  const ContactSettings settings{.iterations = 2, .heavy_iterations = 3};
  std::vector<std::pair<const ContactGroup*, int>> turns;
  for_each_turn(all, settings,
                [&](const ContactGroup& group, int iterations) { turns.emplace_back(&group, iterations); });
  const decltype(turns) expected{{&alone, 2}, {&first, 1},  {&second, 1},
                                 {&first, 1}, {&second, 1}, {&second, 1}};
  EXPECT_EQ(turns, expected);
}

/// Two points that move the same particles press with half of what one would: together they stop one load.
TEST_F(TwoBodies, PressNearEachOtherWithTheirShares) {
  std::vector<ContactRigid> rigids(2);
  rigids[1].inverse_mass = 1;
  Presses presses;
  presses.add(with_rigid(0, {1}), bodies_[0], rigids);
  ASSERT_EQ(presses.all().size(), 1u);
  const float alone = presses.all()[0].mass;
  EXPECT_NEAR(
      alone,
      1 / anchor_in_cell(model_.lattice(), 0, Vector3f::Constant(0.5f)).mobility(model_.inverse_masses),
      1e-5f * alone);
  presses.clear();
  presses.add(with_rigid(0, {1, 0, 1}), bodies_[0], rigids);
  ASSERT_EQ(presses.all().size(), 2u) << "nothing presses on a static body";
  for (const Press& press : presses.all()) EXPECT_NEAR(press.mass, alone / 2, 1e-5f * alone);
}

/// What pressed on each other in the substep before does not hit each other.
TEST_F(TwoBodies, HitWhatTheyDidNotPressOn) {
  std::vector<ContactRigid> rigids(1);
  bodies_[0].restitution = 0.5f;
  const auto hits_of = [&](const Hits& hits) {
    groups_.clear();
    with_rigid(0, {0}).contacts[0].restitution = 1;
    groups_.put_pairs_first(1);
    Bounces bounces;
    hits.add_to(bounces, groups_.all(), bodies_, rigids, {}, kStep);
    return !bounces.empty();
  };
  Hits hits;
  EXPECT_TRUE(hits_of(hits));
  groups_[0].contacts[0].impulse = 0;
  hits.remember_who_presses(groups_.all(), bodies_, rigids, {});
  EXPECT_TRUE(hits_of(hits)) << "it touched without an impulse";
  groups_[0].contacts[0].impulse = 1;
  hits.remember_who_presses(groups_.all(), bodies_, rigids, {});
  EXPECT_FALSE(hits_of(hits));
  hits.forget_who_presses();
  EXPECT_TRUE(hits_of(hits));
  for (Vector3f& velocity : bodies_[0].velocities) velocity *= 0.1f;
  EXPECT_FALSE(hits_of(hits)) << "slower than BounceSettings::least_speed";
}

}  // namespace
}  // namespace softcell::ppu
