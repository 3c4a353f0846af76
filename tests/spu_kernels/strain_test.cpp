// The kernel strain on an SPE: bit for bit its scalar twin.

#include "strain_job.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "softcell/jobs/job_system.h"
#include "spu_kernels/checked_runs.h"
#include "spu_kernels/intrinsics_support.h"
#include "spu_kernels/kernel_image.h"
#include "spu_kernels/strained_body.h"

namespace softcell {
namespace {

using test::StrainedBody;
using Counts = StrainedBody::Counts;

/// x y z, computed as the kernel computes.
struct Xyz {
  float x, y, z;
};
Xyz operator+(const Xyz& a, const Xyz& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Xyz operator-(const Xyz& a, const Xyz& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Xyz squares(const Xyz& v) { return {v.x * v.x, v.y * v.y, v.z * v.z}; }
Xyz squares_and(const Xyz& v, const Xyz& more) {
  return {std::fma(v.x, v.x, more.x), std::fma(v.y, v.y, more.y), std::fma(v.z, v.z, more.z)};
}
float sum(const Xyz& v) { return (v.x + v.z) + (v.y + 0.0f); }

/// One number after the other.
class StrainTwin {
 public:
  explicit StrainTwin(const StrainedBody& body) : body_(body), job_(body.job[0]) {}

  spu::StrainResult result() const {
    spu::StrainResult result{};
    for (std::uint32_t g = 0; g < job_.edge_groups + job_.diagonal_groups; ++g)
      for (std::size_t k = 0; k < 4; ++k) {
        float& largest = g < job_.edge_groups ? result.edges : result.diagonals;
        largest = std::max(largest, change(body_.lengths[g], k));
      }
    for (std::uint32_t g = 0; g < job_.face_groups; ++g)
      for (std::size_t face = 0; face < 4; ++face) result.faces += may_break(body_.faces[g], face) ? 1 : 0;
    return result;
  }

 private:
  Xyz at(std::uint16_t particle) const {
    const std::size_t width = job_.flat != 0 ? 2 : 4, first = particle * width;
    return {body_.positions[first], body_.positions[first + 1], width == 2 ? 0 : body_.positions[first + 2]};
  }
  float change(const spu::StrainLengths& group, std::size_t k) const {
    const float square = sum(squares(at(group.to[k]) - at(group.from[k])));
    return std::abs(std::fma(square, group.inverse_square[k], -1.0f));
  }
  bool may_break(const spu::StrainFaces& group, std::size_t face) const {
    constexpr float kShare = 1 - spu::kStrainShare;
    const float strength = group.strength[face];
    std::array<Xyz, 4> across{}, bend{};
    for (std::size_t k = 0; k < 4; ++k) {
      const Xyz low = at(group.low[face][k]), between = at(group.between[face][k]),
                high = at(group.high[face][k]);
      across[k] = high - low;
      bend[k] = (high - between) - (between - low);
    }
    const float apart = 8 * job_.spacing * kShare;
    const float most = std::fma(strength, apart * job_.stretch, apart);
    const Xyz near = across[0] + across[1], far = across[2] + across[3];
    if (sum(squares(near + far)) > most * most) return true;
    if (!(job_.turn < spu::kStrainNever) || strength * job_.turn >= 0x1.921fb8p+1f) return false;
    const float of_turn = 4 * job_.spacing * kShare * 0x1.ccf642p-2f * job_.turn;
    const float bears = std::fma(strength, of_turn, -(spu::kStrainSpacings * job_.spacing));
    const float edges = bears < 0 ? 0 : bears;
    const Xyz i = (across[1] - across[0]) + (across[3] - across[2]), j = far - near;
    const Xyz along = (bend[0] + bend[1]) + (bend[2] + bend[3]);
    return sum(squares_and(i, squares_and(j, squares(along)))) > edges * edges;
  }

  const StrainedBody& body_;
  const spu::StrainJob& job_;
};

/// @return  what failed; empty: nothing
std::string run_strain(StrainedBody& body, dma::AddressSpace& memory, const ls_sim::SpeOptions& options) {
  const ls_sim::KernelImage image = test::kernel_image("strain", options.findings != nullptr);
  const ls_sim::KernelImage job_loop = test::kernel_image("job_loop");
  ppu::JobSystem jobs(memory, options, job_loop);
  ppu::JobChain chain(jobs, "strain", 1);
  chain.add({jobs.load(image), body.job.ea()});
  chain.kick();
  chain.wait();
  return chain.failures().empty() ? "" : chain.failures()[0].message;
}

struct StrainCase {
  Counts counts = {};
  bool flat = false;
  float stretch = 0.5f, turn = 2, spacing = 0.6f;
};

/// @return  what both found
spu::StrainResult expect_strain_of_twin(const StrainCase& wanted) {
  dma::AddressSpace memory;
  StrainedBody body(memory, wanted.counts, wanted.flat);
  body.job[0].stretch = wanted.stretch;
  body.job[0].turn = wanted.turn;
  body.job[0].spacing = wanted.spacing;
  spu::StrainResult expected{};
  {
    const unsigned int host = _mm_getcsr();
    _mm_setcsr(test::kSpuArithmetic);
    expected = StrainTwin(body).result();
    _mm_setcsr(host);
  }
  EXPECT_EQ(run_strain(body, memory, {.spes = 1}), "");
  const spu::StrainResult& found = body.result[0];
  EXPECT_EQ(std::bit_cast<std::uint32_t>(expected.edges), std::bit_cast<std::uint32_t>(found.edges))
      << expected.edges << ", " << found.edges;
  EXPECT_EQ(std::bit_cast<std::uint32_t>(expected.diagonals), std::bit_cast<std::uint32_t>(found.diagonals))
      << expected.diagonals << ", " << found.diagonals;
  EXPECT_EQ(expected.faces, found.faces);
  EXPECT_EQ(found.pad, 0u);
  return found;
}

TEST(Strain, IsBitForBitTheTwin) {
  const spu::StrainResult by_both = expect_strain_of_twin({});
  EXPECT_GT(by_both.edges, 0.1f);
  EXPECT_GT(by_both.diagonals, 0.1f);
  const spu::StrainResult by_stretch = expect_strain_of_twin({.turn = spu::kStrainNever});
  const spu::StrainResult by_turn = expect_strain_of_twin({.stretch = spu::kStrainNever});
  EXPECT_GT(by_stretch.faces, 2u);
  EXPECT_GT(by_turn.faces, 2u);
  EXPECT_LT(by_turn.faces, 36u);
  EXPECT_LT(by_stretch.faces, by_both.faces);
  EXPECT_LE(by_both.faces, by_stretch.faces + by_turn.faces);
}

TEST(Strain, IsBitForBitTheTwinInTwoDimensions) {
  for (const std::uint32_t particles : {1u, 2u, 3u, 4u, 5u, 90u})
    expect_strain_of_twin({.counts = {.particles = particles}, .flat = true});
}

TEST(Strain, AnyNumberOfGroupsIsBitForBitTheTwin) {
  // 512 groups of lengths, and 146 of faces, come with one command.
  for (const Counts& counts :
       {Counts{1, 0, 0, 0}, Counts{1, 1, 0, 0}, Counts{7, 0, 1, 0}, Counts{8, 0, 0, 1},
        Counts{64, 512, 511, 146}, Counts{65, 513, 1025, 147}, Counts{spu::kStrainMaxParticles, 3, 3, 293}})
    expect_strain_of_twin({.counts = counts});
}

TEST(Strain, LimitsOfEveryCellSizeAreBitForBitTheTwin) {
  for (const float spacing : {1e-3f, 0.1f, 1.5f, 1e3f}) expect_strain_of_twin({.spacing = spacing});
}

TEST(Strain, ABodyThatIsTooLargeIsRefused) {
  dma::AddressSpace memory;
  StrainedBody body(memory, {});
  body.job[0].particles = spu::kStrainMaxParticles + 1;
  EXPECT_NE(run_strain(body, memory, {.spes = 1}).find("status 1"), std::string::npos);
  EXPECT_EQ(body.result[0].faces, ~0u) << "nothing is written";
}

TEST(Strain, ItsCheckedImageFindsNothing) {
  test::expect_no_findings([](const ls_sim::SpeOptions& options) {
    for (const bool flat : {false, true}) {
      dma::AddressSpace memory;
      StrainedBody body(
          memory, {.particles = 600, .edge_groups = 600, .diagonal_groups = 1030, .face_groups = 300}, flat);
      EXPECT_EQ(run_strain(body, memory, options), "");
    }
  });
}

}  // namespace
}  // namespace softcell
