// Sum lists and plans: read back by a plain interpreter, the sums are those of the regions.

#include "ppu/plans/match_plan.h"

#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <numeric>
#include <string>
#include <vector>

#include "lattices.h"
#include "ppu/plans/sum_list.h"
#include "sum_list_interpreter.h"

namespace softcell::ppu {
namespace {

using test::Slots;

constexpr SumListFormat kFormat{spu::kMatchSlotBytes, 16};

Slots run(const std::uint16_t* list, const Slots& in, std::size_t slots) {
  return test::run_sum_list(list, in, slots, spu::kMatchSlotBytes);
}

TEST(SumList, ChainsFollowARowAndStartAnew) {
  std::vector<Sum> sums;
  for (int i = 0; i < 40; ++i) {
    Sum sum{{i / 20, 0, 0}, i % 20, {}};
    for (int j = std::max(0, i - 2); j <= i + 2; ++j) sum.terms.push_back(static_cast<std::uint32_t>(j + 1));
    sums.push_back(sum);
  }
  const SumList list = write_sum_list(sums, kFormat);
  std::vector<std::array<int, 4>> chains;  // terms, growing, sliding, shrinking
  for (const std::uint16_t* p = list.halfwords.data(); *p != 0; p += 4 + p[0] + p[1] + 2 * p[2] + p[3])
    chains.push_back({p[0], p[1], p[2], p[3]});
  EXPECT_EQ(chains,
            (std::vector<std::array<int, 4>>{{3, 2, 13, 0}, {5, 0, 3, 0}, {5, 0, 15, 0}, {5, 0, 3, 0}}));
  EXPECT_EQ(list.additions, std::size_t{2 + 4 + 4 + 4 + 2 + 2 * 34});
}

TEST(SumList, AWindowComesInAndGoesOutWithoutAddingNothing) {
  std::vector<Sum> sums;
  for (int i = 0; i < 6; ++i) {
    Sum sum{{0, 0, 0}, i, {}};
    for (int j = std::max(0, i - 2); j <= std::min(5, i + 2); ++j)
      sum.terms.push_back(static_cast<std::uint32_t>(j + 1));
    sums.push_back(sum);
  }
  const SumList list = write_sum_list(sums, kFormat);
  const auto o = [](std::uint32_t slot) { return sum_list_offset(slot, spu::kMatchSlotBytes); };
  EXPECT_EQ(list.halfwords, (std::vector<std::uint16_t>{3, 2, 1, 2, o(1), o(2), o(3), o(4), o(5), o(6), o(1),
                                                        o(2), o(3), 0}));
  EXPECT_EQ(list.additions, std::size_t{2 + 2 + 2 + 2});
}

TEST(SumList, AWindowWithAGapSlidesOverNothing) {
  SumListWriter writer;
  const auto o = [](std::uint32_t slot) { return sum_list_offset(slot, spu::kMatchSlotBytes); };
  const std::uint16_t first[] = {o(1)};
  writer.begin(first);
  writer.follow(o(2), 0);
  writer.follow(0, o(1));
  writer.follow(o(3), 0);
  writer.follow(0, o(2));
  const SumList list = writer.finish();
  EXPECT_EQ(list.halfwords, (std::vector<std::uint16_t>{1, 1, 2, 1, o(1), o(2), 0, o(1), o(3), 0, o(2), 0}));
  Slots in = {0, 1, 10, 100};
  EXPECT_EQ(run(list.halfwords.data(), in, 6), (Slots{0, 1, 11, 10, 110, 100}));
}

TEST(SumList, ASumThatDiffersByMoreIsWrittenOut) {
  const SumList list = write_sum_list(
      {{{0, 0, 0}, 0, {1, 2, 3}}, {{0, 0, 0}, 1, {3, 4, 5}}, {{0, 0, 0}, 2, {3, 3, 5}}}, kFormat);
  Slots in = {0, 1, 10, 100, 1000, 10000};
  EXPECT_EQ(run(list.halfwords.data(), in, 4), (Slots{0, 111, 11100, 10200}));
}

TEST(SumList, PlacesBelowZeroAreInBlocksToo) {
  std::vector<Sum> sums;
  for (int place = -3; place < 3; ++place) sums.push_back({{0, 0, 0}, place, {1}});
  const SumList list = write_sum_list(sums, kFormat);
  EXPECT_EQ(list.halfwords[1], 2);  // -3, -2, -1, to which nothing is added; then anew
}

/// Every list of a plan, against sums over the regions' members.
TEST(MatchPlan, ListsAddUpEveryRegion) {
  for (const auto& [name, lattice] : test::all_lattices()) {
    for (int w = 1; w <= 4; ++w) {
      SCOPED_TRACE(name + ", w = " + std::to_string(w));
      const MatchingPlan<float, 3> matching(lattice, w, particle_masses(lattice, 1000));
      const MatchPlan plan(lattice, matching);
      const spu::MatchPlanHeader& header = plan.header();
      const auto list = [&](std::uint32_t offset) {
        return reinterpret_cast<const std::uint16_t*>(plan.bytes().data() + offset);
      };
      const auto regions_from_bars = [&](const Slots& bars) {
        return run(list(header.regions_of_plates), run(list(header.plates), bars, header.slots),
                   header.slots);
      };

      Slots particles(header.slots, 0.0);
      for (std::size_t i = 0; i < lattice.particles.size(); ++i)
        particles[i + 1] = static_cast<double>(i * i + 1);
      const Slots up = regions_from_bars(run(list(header.bars_of_particles), particles, header.slots));
      Slots of_region(header.slots, 0.0);
      for (std::uint32_t r = 0; r < header.regions; ++r) of_region[r + 1] = 3.0 * r + 1;
      const Slots down = regions_from_bars(run(list(header.bars_of_regions), of_region, header.slots));

      const SumPlan& sums = matching.sums();
      for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
        const std::uint32_t region = plan.region_of()[i];
        double expected_up = 0, expected_down = 0;
        for (const std::uint32_t member : sums.members(sums.region_of()[i])) {
          expected_up += particles[member + 1];
          expected_down += of_region[plan.region_of()[member] + 1];
        }
        ASSERT_EQ(up[region + 1], expected_up) << i;
        ASSERT_EQ(down[region + 1], expected_down) << i;
      }
      for (std::uint32_t pad = header.regions; pad < 4 * spu::groups_of(header.regions); ++pad)
        EXPECT_EQ(up[pad + 1], 0);
    }
  }
}

TEST(MatchPlan, CostsTheSameForEveryHalfWidth) {
  const Lattice<3> lattice = test::block(9, 9, 9);
  std::vector<double> additions;
  for (int w = 1; w <= 4; ++w) {
    const MatchingPlan<float, 3> matching(lattice, w, particle_masses(lattice, 1000));
    additions.push_back(static_cast<double>(MatchPlan(lattice, matching).additions()) / 1000);
  }
  EXPECT_LT(additions[0], 6);
  EXPECT_LT(additions[3], 6.7);
}

TEST(MatchPlan, IsLaidOutForTransfers) {
  const Lattice<3> lattice = test::block(3, 3, 2);
  const MatchingPlan<float, 3> matching(lattice, 2, particle_masses(lattice, 1000));
  const MatchPlan plan(lattice, matching);
  const spu::MatchPlanHeader& header = plan.header();
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(plan.bytes().data()) % 128, 0u);
  EXPECT_EQ(plan.bytes().size(), header.bytes);
  EXPECT_EQ(header.bytes % 128, 0u);
  for (const std::uint32_t offset :
       {header.particle_constants, header.region_constants, header.bars_of_particles, header.bars_of_regions,
        header.plates, header.regions_of_plates}) {
    EXPECT_EQ(offset % 16, 0u);
    EXPECT_LT(offset, header.bytes);
  }
  EXPECT_EQ(header.grid, 0.0625f);  // the power of two below 0.1
}

TEST(MatchPlan, IdenticalRegionsAreThereOnce) {
  const Lattice<3> lattice = test::block(8, 7, 1);  // one cell thick: both layers have the same regions
  const MatchingPlan<float, 3> matching(lattice, 2, particle_masses(lattice, 1000));
  EXPECT_EQ(MatchPlan(lattice, matching).header().regions, lattice.particles.size() / 2);
}

}  // namespace
}  // namespace softcell::ppu
