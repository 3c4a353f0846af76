#include "ppu/matching/summation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <set>
#include <span>
#include <stdexcept>
#include <vector>

#include "lattices.h"
#include "ppu/matching/lanes.h"
#include "ppu/matching/regions.h"
#include "support/slow_build.h"

namespace softcell::ppu {
namespace {

using test::all_lattices;
using test::block;
using test::Random;

bool contains(std::span<const std::uint32_t> list, std::uint32_t item) {
  return std::binary_search(list.begin(), list.end(), item);
}

std::vector<std::uint32_t> as_vector(std::span<const std::uint32_t> list) {
  return {list.begin(), list.end()};
}

TEST(FindRegions, AreParticlesWithinHalfWidthLinks) {
  for (const auto& [name, lattice] : all_lattices()) {
    for (int w = 0; w <= 4; ++w) {
      const Csr regions = find_regions(lattice, w);
      ASSERT_EQ(regions.size(), lattice.particles.size());
      for (std::uint32_t r = 0; r < regions.size(); ++r) {
        std::set<std::uint32_t> grown{r};
        for (int round = 0; round < w; ++round) {
          const std::set<std::uint32_t> last = grown;
          for (const std::uint32_t i : last)
            grown.insert(lattice.neighbours[i].begin(), lattice.neighbours[i].end());
        }
        ASSERT_EQ(as_vector(regions[r]), std::vector<std::uint32_t>(grown.begin(), grown.end()))
            << name << " w " << w << " particle " << r;
      }
    }
  }
}

TEST(FindRegions, MembershipIsSymmetric) {
  for (const auto& [name, lattice] : all_lattices())
    for (int w = 0; w <= 4; ++w) {
      const Csr regions = find_regions(lattice, w);
      for (std::uint32_t r = 0; r < regions.size(); ++r)
        for (const std::uint32_t i : regions[r]) ASSERT_TRUE(contains(regions[i], r)) << name << " w " << w;
    }
}

TEST(FindRegions, AreCubesInsideABlock) {
  const Lattice<3> lattice = block(6, 6, 6);
  const Csr regions = find_regions(lattice, 2);
  for (std::uint32_t r = 0; r < regions.size(); ++r) {
    std::size_t expected = 1;
    for (int d = 0; d < 3; ++d) {
      const int at = lattice.particles[r][d];
      expected *= static_cast<std::size_t>(std::min(at + 2, 6) - std::max(at - 2, 0) + 1);
    }
    ASSERT_EQ(regions[r].size(), expected);
  }
}

TEST(FindRegions, DoNotJumpTheGapOfAHorseshoe) {
  const Lattice<3> lattice = lattice_from_cells(test::horseshoe_cells(6), 0.1f, {0, 0, 0});
  const Csr regions = find_regions(lattice, 3);
  const auto number = [&](int x, int y, int z) {
    const auto found =
        std::find(lattice.particles.begin(), lattice.particles.end(), Eigen::Vector3i(x, y, z));
    return static_cast<std::uint32_t>(found - lattice.particles.begin());
  };
  EXPECT_FALSE(contains(regions[number(6, 1, 0)], number(6, 2, 0)));  // the tips, one cell apart
  EXPECT_TRUE(contains(regions[number(1, 1, 0)], number(1, 2, 0)));   // at the bow
}

TEST(FindRegions, RefusesHalfWidthsOutOfRange) {
  const Lattice<3> lattice = block(1, 1, 1);
  EXPECT_THROW(find_regions(lattice, -1), std::runtime_error);
  EXPECT_THROW(find_regions(lattice, kMaxHalfWidth + 1), std::runtime_error);
  EXPECT_EQ(find_regions(lattice, kMaxHalfWidth)[0].size(), 8u);
}

TEST(FindRegions, RefusesMoreEntriesThanTheLimit) {
  if (kSlowBuild) GTEST_SKIP() << "too slow with sanitizers: it makes sixty million entries";
  EXPECT_THROW(find_regions(block(39, 39, 39), 6),
               std::runtime_error);  // 64,000 particles, up to 2,197 in a region: 109 million
}

/// The search for the first of the regions alone would take minutes.
TEST(FindRegions, RefusesFarMoreEntriesThanTheLimitAtOnce) {
  const Lattice<3> lattice = block(60, 60, 60);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_THROW(find_regions(lattice, kMaxHalfWidth), std::runtime_error);
  const std::chrono::duration<double> time = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(time.count(), kSlowBuild ? 5 : 1.5) << "seconds";
}

TEST(FindRegions, AcceptsAsManyEntriesAsTheLimitAllows) {
  const Lattice<3> lattice = block(39, 39, 39);
  const Csr regions = find_regions(lattice, 2);
  // Along an axis 36 particles reach 5 and two each at the ends 3 and 4.
  EXPECT_EQ(regions.items.size(), 194u * 194u * 194u);
}

TEST(SumPlan, HoldsExactlyTheRegions) {
  for (const auto& [name, lattice] : all_lattices())
    for (int w = 0; w <= 4; ++w) {
      const Csr regions = find_regions(lattice, w);
      const SumPlan plan(lattice, regions);
      for (std::uint32_t r = 0; r < regions.size(); ++r)
        ASSERT_EQ(plan.members(plan.region_of()[r]), as_vector(regions[r])) << name << " w " << w;
    }
}

TEST(SumPlan, KeepsEqualSetsOnce) {
  const Lattice<3> sheet = block(8, 8, 1);
  EXPECT_EQ(SumPlan(sheet, find_regions(sheet, 1)).regions(), sheet.particles.size() / 2);
  const Lattice<3> cell = block(1, 1, 1);
  EXPECT_EQ(SumPlan(cell, find_regions(cell, 1)).regions(), 1u);
  for (const auto& [name, lattice] : all_lattices()) {
    const SumPlan plan(lattice, find_regions(lattice, 2));
    for (const Csr* lists : {&plan.particles_of_bar(), &plan.bars_of_plate(), &plan.plates_of_region()}) {
      std::set<std::vector<std::uint32_t>> distinct;
      for (std::size_t i = 0; i < lists->size(); ++i) distinct.insert(as_vector((*lists)[i]));
      EXPECT_EQ(distinct.size(), lists->size()) << name;
    }
  }
}

TEST(SumPlan, RefusesRegionsThatAreNotSymmetricOrNotOnePerParticle) {
  const Lattice<3> lattice = block(2, 1, 1);
  Csr regions = find_regions(lattice, 1);
  Csr lopsided;
  for (std::size_t r = 0; r < regions.size(); ++r)
    lopsided.push(r == 0 ? regions[r].first(regions[r].size() - 1) : regions[r]);
  EXPECT_THROW(SumPlan(lattice, lopsided), std::invalid_argument);
  regions.push(std::vector<std::uint32_t>{0});
  EXPECT_THROW(SumPlan(lattice, regions), std::invalid_argument);
}

/// How often payloads are added for the sums of these lists.
std::size_t additions(const Csr& lists) { return lists.items.size() - lists.size(); }

/// The same for one sum over all regions, by their bars and plates.
std::size_t additions(const SumPlan& plan) {
  return additions(plan.particles_of_bar()) + additions(plan.bars_of_plate()) +
         additions(plan.plates_of_region());
}

TEST(SumPlan, AddsAsOftenAsPublishedForABlockOfAThousand) {
  const Lattice<3> lattice = block(9, 9, 9);
  const double shared[] = {5.4, 10.2, 14.4}, naive[] = {21, 84, 194};  // per particle, w = 1, 2, 3
  for (int w = 1; w <= 3; ++w) {
    const Csr regions = find_regions(lattice, w);
    EXPECT_NEAR(static_cast<double>(additions(SumPlan(lattice, regions))) / 1000, shared[w - 1], 0.05) << w;
    EXPECT_NEAR(static_cast<double>(additions(regions)) / 1000, naive[w - 1], 0.5) << w;
  }
}

TEST(SumPlan, NeverAddsMoreThanSixTimesTheHalfWidth) {
  for (const auto& [name, lattice] : all_lattices())
    for (int w = 1; w <= 4; ++w) {
      const SumPlan plan(lattice, find_regions(lattice, w));
      EXPECT_LE(additions(plan), 6u * static_cast<unsigned>(w) * lattice.particles.size())
          << name << " w " << w;
    }
}

template <typename Real>
class SumBits : public ::testing::Test {};
using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(SumBits, Reals);

template <typename Payload>
std::vector<Payload> random_payloads(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Payload> payloads(count);
  for (Payload& payload : payloads)
    for (auto& lane : payload.lane)
      lane = static_cast<std::remove_reference_t<decltype(lane)>>(random.next());
  return payloads;
}

template <typename Payload>
bool same_bits(const std::vector<Payload>& a, const std::vector<Payload>& b) {
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < std::size(a[i].lane); ++k)
      if (a[i][k] != b[i][k] || std::signbit(a[i][k]) != std::signbit(b[i][k])) return false;
  return a.size() == b.size();
}

TYPED_TEST(SumBits, SharedAndNaiveHaveTheSameBits) {
  using Payload = Lanes<TypeParam, 12>;
  for (const auto& [name, lattice] : all_lattices())
    for (int w = 0; w <= 4; ++w) {
      const SumPlan plan(lattice, find_regions(lattice, w));
      SumScratch<Payload> scratch(plan);
      const auto particles = random_payloads<Payload>(plan.particles(), 1),
                 values = random_payloads<Payload>(plan.regions(), 2);
      std::vector<Payload> shared(plan.regions()), naive(plan.regions());
      sum_up<Payload>(plan, particles, scratch, shared);
      sum_up_naively<Payload>(plan, particles, naive);
      EXPECT_TRUE(same_bits(shared, naive)) << name << " up, w " << w;
      sum_down<Payload>(plan, values, scratch, shared);
      sum_down_naively<Payload>(plan, values, naive);
      EXPECT_TRUE(same_bits(shared, naive)) << name << " down, w " << w;
    }
}

TEST(Sums, AreThePlainSumsOverTheRegions) {
  using Payload = Lanes<double, 2>;
  for (const auto& [name, lattice] : all_lattices())
    for (int w = 0; w <= 4; ++w) {
      const Csr regions = find_regions(lattice, w);
      const SumPlan plan(lattice, regions);
      SumScratch<Payload> scratch(plan);
      const auto particles = random_payloads<Payload>(plan.particles(), 3),
                 values = random_payloads<Payload>(plan.regions(), 4);
      std::vector<Payload> up(plan.regions()), down(plan.regions());
      sum_up<Payload>(plan, particles, scratch, up);
      sum_down<Payload>(plan, values, scratch, down);
      const auto region_of = plan.region_of();
      for (std::uint32_t i = 0; i < regions.size(); ++i) {
        double over_particles = 0, over_regions = 0;
        for (const std::uint32_t j : regions[i]) over_particles += particles[j][1];
        for (std::uint32_t r = 0; r < regions.size(); ++r)
          if (contains(regions[r], i)) over_regions += values[region_of[r]][1];
        ASSERT_NEAR(up[region_of[i]][1], over_particles, 1e-12) << name << " w " << w;
        ASSERT_NEAR(down[region_of[i]][1], over_regions, 1e-12) << name << " w " << w;
      }
    }
}

TEST(Sums, UpAndDownAreTransposes) {
  using Payload = Lanes<double, 2>;
  for (const auto& [name, lattice] : all_lattices())
    for (int w = 1; w <= 4; ++w) {
      const SumPlan plan(lattice, find_regions(lattice, w));
      SumScratch<Payload> scratch(plan);
      const auto particles = random_payloads<Payload>(plan.particles(), 5),
                 values = random_payloads<Payload>(plan.regions(), 6);
      std::vector<Payload> up(plan.regions()), down(plan.regions());
      sum_up<Payload>(plan, particles, scratch, up);
      sum_down<Payload>(plan, values, scratch, down);
      double left = 0, right = 0,
             scale = 0;  // <F v, V> and <v, F^T V>, over particles and one region for each
      for (std::size_t i = 0; i < plan.particles(); ++i) {
        const std::uint32_t r = plan.region_of()[i];
        left += up[r][0] * values[r][0];
        right += particles[i][0] * down[r][0];
        scale += std::abs(up[r][0] * values[r][0]);
      }
      EXPECT_NEAR(left, right, 1e-13 * scale) << name << " w " << w;
    }
}

}  // namespace
}  // namespace softcell::ppu
