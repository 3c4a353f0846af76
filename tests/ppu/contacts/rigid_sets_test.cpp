// Rigid bodies in sets for the SPEs.

#include "ppu/contact_solver/rigid_sets.h"

#include <gtest/gtest.h>

#include <vector>

#include "ppu/spe_bodies/spe_contacts.h"
#include "softcell/spe_bodies/spe_runtime.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

struct Rig {
  explicit Rig(std::size_t count) : rigids(count) {
    for (std::size_t i = 0; i < count; ++i) {
      const auto number = static_cast<float>(i);
      rigids[i].inverse_mass = 1 / (1 + number);
      rigids[i].inverse_inertia = Eigen::Matrix3f::Identity() * (2 + number);
      rigids[i].inverse_inertia(2, 0) = 0.25f;
      rigids[i].velocity = {number, 1, 2};
      rigids[i].spin = {3, number, 4};
    }
    sets.begin(rigids);
  }
  SpeRuntime spes{{.spes = 1}};
  SpeContacts worker{spes.memory(),
                     spes.jobs(),
                     {spes.kernel("contact_find"), spes.kernel("contact_solve"), spes.kernel("attach")}};
  std::vector<ContactRigid> rigids;
  RigidSets sets;
};

TEST(RigidSets, HoldWhatIsJoined) {
  Rig rig(8);
  rig.rigids[3].inverse_mass = 0;
  rig.sets.join(6, 6);
  rig.sets.join(7, 2);
  rig.sets.join(4, 5);
  rig.sets.join(5, 2);
  rig.sets.arrange(rig.worker);
  ASSERT_EQ(rig.sets.sets(), 2u);
  for (const std::uint32_t i : {0u, 1u, 3u}) EXPECT_EQ(rig.sets.set_of(i), RigidSets::kNone) << i;
  for (const std::uint32_t i : {2u, 4u, 5u, 7u}) EXPECT_EQ(rig.sets.set_of(i), 0u) << i;
  EXPECT_EQ(rig.sets.set_of(6), 1u);
  ASSERT_EQ(rig.sets.of(0).size(), 5u) << "and one that nothing moves";
  ASSERT_EQ(rig.sets.of(1).size(), 2u);
  EXPECT_EQ(rig.sets.number_in(0, 7), 3u);
  EXPECT_EQ(rig.sets.number_in(0, 3), 4u);
  EXPECT_EQ(rig.sets.number_in(1, 3), 1u);
  const spu::SolveRigid& seven = rig.sets.of(0)[3];
  EXPECT_EQ(seven.inverse_mass, rig.rigids[7].inverse_mass);
  EXPECT_EQ(seven.inverse_inertia[0][2], 0.25f) << "columns";
  EXPECT_EQ(seven.inverse_inertia[2][0], 0.0f);
  EXPECT_EQ(rig.sets.of(0)[4].inverse_mass, 0.0f);
  EXPECT_EQ(rig.sets.of(0)[4].inverse_inertia[0][0], 0.0f);
}

TEST(RigidSets, ExchangeChangesOfVelocities) {
  Rig rig(3);
  rig.sets.join(1, 1);
  rig.sets.arrange(rig.worker);
  rig.rigids[1].velocity.x() += 2;
  rig.sets.put();
  spu::SolveRigid& one = rig.sets.of(0)[0];
  EXPECT_EQ(one.velocity[0], 2.0f);
  EXPECT_EQ(one.velocity[1], 0.0f);
  one.velocity[0] = 0.5f;
  one.spin[2] = -1;
  rig.sets.take();
  EXPECT_EQ(rig.rigids[1].velocity, Vector3f(1.5f, 1, 2));
  EXPECT_EQ(rig.rigids[1].spin, Vector3f(3, 1, 3));
  EXPECT_EQ(rig.rigids[0].velocity, Vector3f(0, 1, 2));
}

TEST(RigidSets, LeaveOutThoseThatHaveNoRoom) {
  Rig rig(100);
  for (std::uint32_t i = 1; i < 90; ++i) rig.sets.join(i, i - 1);
  rig.sets.join(95, 96);
  rig.sets.arrange(rig.worker);
  ASSERT_EQ(rig.sets.sets(), 1u);
  EXPECT_EQ(rig.sets.set_of(0), RigidSets::kNone);
  EXPECT_EQ(rig.sets.set_of(89), RigidSets::kNone);
  EXPECT_EQ(rig.sets.set_of(96), 0u);
  EXPECT_EQ(rig.sets.of(0).size(), 3u);
}

TEST(RigidSets, AreNoneWhereNothingIsJoined) {
  Rig rig(4);
  rig.sets.arrange(rig.worker);
  EXPECT_EQ(rig.sets.sets(), 0u);
  rig.sets.put();
  rig.sets.take();
  EXPECT_EQ(rig.rigids[2].velocity.x(), 2.0f);
}

}  // namespace
}  // namespace softcell::ppu
