// For how long candidates last, and that contacts do not depend on when they were looked for.

#include "ppu/spe_bodies/candidate_pairs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "contact_world.h"
#include "ppu/spe_bodies/spe_contacts.h"
#include "softcell/spe_bodies/spe_runtime.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

constexpr float kSpacing = 0.2f;
constexpr CandidatePairs::Pair kPair{0, 1};

/// Candidates of the pair as a step finds them. @return  whether they had to be looked for
bool looks_for_candidates(CandidatePairs& pairs) {
  pairs.begin_step();
  const bool looks = pairs.of(kPair, kSpacing).count == spu::kFindUnknown;
  pairs.end_step();
  pairs.known()[0].count = 5;
  return looks;
}

TEST(CandidatePairs, LastUntilSomethingHasMovedByTheMargin) {
  CandidatePairs pairs;
  pairs.clear(2);
  EXPECT_TRUE(looks_for_candidates(pairs));
  const float margin = pairs.known()[0].margin;
  ASSERT_GT(margin, 0);
  // Four steps: two bodies move apart by a fifth of the margin each, and then by more than the margin altogether.
  const Vector3f step(0.1f * margin, 0, 0);
  for (int i = 0; i < 4; ++i) {
    pairs.add_way(0, -step, -step);
    pairs.add_way(1, step, step);
    EXPECT_FALSE(looks_for_candidates(pairs)) << i;
  }
  pairs.add_way(0, -step, -step);
  pairs.add_way(1, step, step);
  EXPECT_TRUE(looks_for_candidates(pairs));
}

TEST(CandidatePairs, BodiesThatFallSideBySideDoNotMoveAgainstEachOther) {
  CandidatePairs pairs;
  pairs.clear(2);
  EXPECT_TRUE(looks_for_candidates(pairs));
  for (int i = 0; i < 100; ++i) {
    const Vector3f way(0, -0.05f, 0);
    for (const std::uint32_t body : {0u, 1u}) pairs.add_way(body, way, way);
    EXPECT_FALSE(looks_for_candidates(pairs)) << i;
  }
}

/// What particles of one body do against each other counts every time, also there and back.
TEST(CandidatePairs, ABodyThatBendsMovesAgainstAll) {
  CandidatePairs pairs;
  pairs.clear(2);
  EXPECT_TRUE(looks_for_candidates(pairs));
  const Vector3f way(0.2f * pairs.known()[0].margin, 0, 0);
  int steps = 0;
  for (bool looks = false; !looks && steps < 100; ++steps) {
    pairs.add_way(0, -way, way);
    looks = looks_for_candidates(pairs);
  }
  EXPECT_EQ(steps, 5);
}

TEST(CandidatePairs, OfWhatIsFastNoneAreKept) {
  CandidatePairs pairs;
  pairs.clear(2);
  const Vector3f way(kSpacing, 0, 0);
  pairs.add_way(0, way, way);
  EXPECT_TRUE(looks_for_candidates(pairs));
  EXPECT_EQ(pairs.known()[0].margin, 0);
}

TEST(CandidatePairs, ForgetPairsThatAreNotAskedForAndReuseTheirPlace) {
  CandidatePairs pairs;
  pairs.clear(3);
  EXPECT_TRUE(looks_for_candidates(pairs));
  pairs.begin_step();
  pairs.of({1, 2}, kSpacing);
  pairs.end_step();
  EXPECT_TRUE(looks_for_candidates(pairs));
  EXPECT_LE(pairs.slots(), 2u);
}

/// Two bodies slide along each other, one turns: a worker that has known them for a while finds what a fresh one finds, bit for bit.
TEST(CandidatePairs, ContactsDoNotDependOnWhenTheirCandidatesWereFound) {
  const ContactModel penguin(make_soft_body_model(make_penguin(0.9f), settings_of(0.15f)));
  SpeRuntime spes({.spes = 1});
  SpeContacts used(spes.memory(), spes.jobs(),
                   {spes.kernel("contact_find"), spes.kernel("contact_solve"), spes.kernel("attach")});
  const Lattice<3>& lattice = penguin.lattice();
  const std::size_t count = lattice.particles.size();
  std::size_t contacts = 0;
  for (int i = 0; i < 60; ++i) {
    const float t = static_cast<float>(i);
    std::vector<Vector3f> positions[2];
    std::vector<ContactBody> bodies(2);
    for (std::size_t b = 0; b < 2; ++b) {
      const Eigen::AngleAxisf turn(b == 0 ? 0.3f : 0.3f + 0.004f * t, Vector3f::UnitY());
      const Vector3f at = b == 0 ? Vector3f::Zero() : Vector3f(0.4f, 0.003f * t, 0.05f - 0.001f * t);
      for (std::size_t p = 0; p < count; ++p) positions[b].push_back(turn * lattice.rest_position(p) + at);
      ContactBody& body = bodies[b];
      body.model = &penguin;
      body.positions = positions[b];
      body.ends = positions[b];
      body.velocities.assign(count, Vector3f::Zero());
      body.pushes = body.velocities;
      body.inverse_masses = penguin.inverse_masses;
    }
    SpeContacts fresh(spes.memory(), spes.jobs(),
                      {spes.kernel("contact_find"), spes.kernel("contact_solve"), spes.kernel("attach")});
    const ContactWorker::Pair pair{0, 1};
    std::vector<std::vector<unsigned char>> found;
    for (SpeContacts* const worker : {&used, &fresh}) {
      worker->begin(bodies, kStep);
      worker->find({&pair, 1});
      const FoundContacts result = worker->found()[0];
      ASSERT_FALSE(result.by_caller);
      const auto* const bytes = reinterpret_cast<const unsigned char*>(result.contacts.data());
      found.emplace_back(bytes, bytes + result.contacts.size_bytes());
      contacts += result.contacts.size();
    }
    ASSERT_EQ(found[0], found[1]) << "step " << i;
  }
  EXPECT_GT(contacts, 500u);
}

}  // namespace
}  // namespace softcell::ppu
