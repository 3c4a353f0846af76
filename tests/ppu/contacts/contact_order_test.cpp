// Pairs of bodies in stages: who is solved at the same time shares no body.

#include "ppu/contact_solver/contact_order.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <vector>

namespace softcell::ppu {
namespace {

std::vector<ContactBody> scattered(std::size_t count) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(0, 8);
  std::vector<ContactBody> bodies(count);
  for (ContactBody& body : bodies) {
    body.box.low = {place(random), place(random), place(random)};
    body.box.high = body.box.low + Eigen::Vector3f::Constant(1.5f);
  }
  return bodies;
}

std::vector<ContactOrder::Pair> overlapping(const std::vector<ContactBody>& bodies) {
  std::vector<ContactOrder::Pair> pairs;
  for (std::uint32_t a = 0; a < bodies.size(); ++a)
    for (std::uint32_t b = a; b < bodies.size(); ++b)
      if ((bodies[a].box.low.array() <= bodies[b].box.high.array()).all() &&
          (bodies[b].box.low.array() <= bodies[a].box.high.array()).all())
        pairs.emplace_back(a, b);
  return pairs;
}

TEST(ContactOrder, UnitsOfAStageShareNoBodyAndEveryPairIsThere) {
  for (const std::size_t count : {1u, 5u, 40u, 150u}) {
    const auto bodies = scattered(count);
    const auto pairs = overlapping(bodies);
    ContactOrder order;
    order.arrange(bodies, pairs);
    EXPECT_EQ(std::set<std::uint32_t>(order.order().begin(), order.order().end()).size(), pairs.size());
    ASSERT_EQ(order.order().size(), pairs.size());
    EXPECT_EQ(order.units()[order.stages().back()], pairs.size());
    for (std::size_t stage = 0; stage + 1 < order.stages().size(); ++stage) {
      std::vector<std::uint32_t> unit_of(count, ~0u);
      for (std::uint32_t unit = order.stages()[stage]; unit < order.stages()[stage + 1]; ++unit) {
        for (std::uint32_t i = order.units()[unit]; i < order.units()[unit + 1]; ++i) {
          const auto& [a, b] = pairs[order.order()[i]];
          for (const std::uint32_t body : {a, b}) {
            EXPECT_TRUE(unit_of[body] == ~0u || unit_of[body] == unit) << "body " << body << " of " << count;
            unit_of[body] = unit;
          }
        }
      }
    }
  }
}

/// Many jobs at a time, few times: else six SPEs wait for each other.
TEST(ContactOrder, AHeapTakesFewStages) {
  const auto bodies = scattered(150);
  const auto pairs = overlapping(bodies);
  ContactOrder order;
  order.arrange(bodies, pairs);
  EXPECT_LE(order.stages().size() - 1, 16u);
  EXPECT_GE(order.stages()[1], 12u) << "units in the first stage";
}

TEST(ContactOrder, NothingHasNoStage) {
  ContactOrder order;
  order.arrange({}, {});
  EXPECT_EQ(order.stages().size(), 1u);
  EXPECT_TRUE(order.order().empty());
}

}  // namespace
}  // namespace softcell::ppu
