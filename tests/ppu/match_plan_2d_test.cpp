// Plans of the kernel match_2d: read back by a plain interpreter, the sums are those of the regions.

#include "ppu/plans/match_plan_2d.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "lattices_2d.h"
#include "ppu/matching/regions.h"
#include "sum_list_interpreter.h"

namespace softcell::ppu {
namespace {

using test::Slots;

MatchingPlan<float, 2> matching_of(const Lattice<2>& lattice, int half_width) {
  return {lattice, half_width, particle_masses(lattice, 1000)};
}

Slots run(const MatchPlan2d& plan, std::uint32_t list, const Slots& in) {
  return test::run_sum_list(reinterpret_cast<const std::uint16_t*>(plan.bytes().data() + list), in,
                            plan.header().slots, spu::kMatch2dSlotBytes);
}

TEST(MatchPlan2d, ListsAddUpEveryRegion) {
  for (const auto& [name, lattice] : test::all_lattices_2d()) {
    for (int w = 0; w <= 4; ++w) {
      SCOPED_TRACE(name + ", w = " + std::to_string(w));
      const MatchingPlan<float, 2> matching = matching_of(lattice, w);
      const MatchPlan2d plan(lattice, matching);
      const spu::MatchPlanHeader2d& header = plan.header();

      Slots particles(header.slots, 0.0), of_region(header.slots, 0.0);
      for (std::size_t i = 0; i < lattice.particles.size(); ++i)
        particles[i + 1] = static_cast<double>(i * i + 1);
      for (std::uint32_t r = 0; r < header.regions; ++r) of_region[r + 1] = 3.0 * r + 1;
      const Slots up = run(plan, header.regions_of_bars, run(plan, header.bars_of_particles, particles));
      const Slots down = run(plan, header.regions_of_bars, run(plan, header.bars_of_regions, of_region));

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

TEST(MatchPlan2d, CostsTheSameForEveryHalfWidth) {
  const Lattice<2> lattice = test::rectangle(31, 31);
  std::vector<double> additions;
  for (int w = 1; w <= 4; ++w)
    additions.push_back(static_cast<double>(MatchPlan2d(lattice, matching_of(lattice, w)).additions()) /
                        1024);
  EXPECT_LT(additions[0], 4);
  EXPECT_LT(additions[3], 4.6);
}

TEST(MatchPlan2d, IsLaidOutForTransfers) {
  const Lattice<2> lattice = test::man132();
  const MatchPlan2d plan(lattice, matching_of(lattice, 2));
  const spu::MatchPlanHeader2d& header = plan.header();
  EXPECT_EQ(header.particles, 132u);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(plan.bytes().data()) % 128, 0u);
  EXPECT_EQ(plan.bytes().size(), header.bytes);
  EXPECT_EQ(header.bytes % 128, 0u);
  for (const std::uint32_t offset :
       {header.particle_constants, header.region_constants, header.bars_of_particles, header.bars_of_regions,
        header.regions_of_bars}) {
    EXPECT_EQ(offset % 16, 0u);
    EXPECT_LT(offset, header.bytes);
  }
  EXPECT_EQ(header.grid, 0.0625f);  // the power of two below 0.1
  EXPECT_TRUE(spu::match_2d_fits(header));
}

TEST(MatchPlan2d, SquaresOfTheNumberThatIsDocumentedFitWithRegionsOfAnyWidth) {
  const auto side = static_cast<std::size_t>(std::sqrt(static_cast<double>(kParticlesThatFit2d)));
  ASSERT_EQ(side * side, kParticlesThatFit2d);
  const Lattice<2> square = test::rectangle(side - 1, side - 1), larger = test::rectangle(side, side);
  for (int w = 0; w <= kMaxHalfWidth; ++w)
    EXPECT_NO_THROW(MatchPlan2d(square, matching_of(square, w))) << "w " << w;
  EXPECT_THROW(MatchPlan2d(larger, matching_of(larger, kMaxHalfWidth)), BodyTooLarge);
}

TEST(MatchPlan2d, ABodyThatDoesNotFitIsRefusedWithBothSizes) {
  const Lattice<2> lattice = test::rectangle(45, 45);
  try {
    const MatchPlan2d plan(lattice, matching_of(lattice, 2));
    FAIL() << "fits";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("2116 particles"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find(std::to_string(spu::kMatch2dArenaBytes)), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace softcell::ppu
