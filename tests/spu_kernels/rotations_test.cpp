// The kernel `rotations` on an SPE against the PPU's own search.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>
#include <string>
#include <vector>

#include "ppu/matching/rotation.h"
#include "rotations_job.h"
#include "softcell/dma/buffer.h"
#include "softcell/jobs/job_system.h"
#include "spu_kernels/kernel_image.h"

namespace softcell {
namespace {

// The widths of the contract's numbers.
constexpr dma::BufferOptions kOfFloats{.element_bytes = sizeof(float)};
constexpr dma::ElementRun kJobRecord[] = {{24, 8}, {104, 4}};

/// One SPE and one job.
struct RotationsRig {
  explicit RotationsRig(std::size_t groups)
      : matrices(memory, "matrices", groups, kOfFloats),
        starts(memory, "starts", groups, kOfFloats),
        found(memory, "found", groups, kOfFloats) {
    job[0] = {matrices.ea().value,
              starts.ea().value,
              found.ea().value,
              static_cast<std::uint32_t>(groups),
              1,
              0,
              6,
              {}};
  }

  std::vector<ppu::JobFailure> run() {
    ppu::JobChain chain(jobs, "rotations", 1);
    chain.add({jobs.load(kernel), job.ea()});
    chain.kick();
    chain.wait();
    return chain.failures();
  }

  dma::AddressSpace memory;
  ls_sim::KernelImage kernel = test::kernel_image("rotations"), job_loop = test::kernel_image("job_loop");
  ppu::JobSystem jobs{memory, {.spes = 1}, job_loop};
  dma::Buffer<spu::RotationMatrices> matrices;
  dma::Buffer<spu::MatchRotations> starts, found;
  dma::Buffer<spu::RotationsJob> job{memory, "job", 1, {.record = kJobRecord}};
};

TEST(Rotations, AreThoseThatThePpuFindsWhateverTheMatrix) {
  constexpr std::size_t kGroups = 35;  // blocks of eight, and three
  RotationsRig rig(kGroups);
  std::mt19937 random(5);
  std::uniform_real_distribution<float> uniform(-1, 1);
  std::vector<Eigen::Matrix3f> matrices;
  for (std::size_t i = 0; i < 4 * kGroups; ++i) {
    matrices.push_back(Eigen::Matrix3f::NullaryExpr([&] { return uniform(random); }));
    for (int e = 0; e < 9; ++e) rig.matrices[i / 4].element[e][i % 4] = matrices[i](e / 3, e % 3);
    rig.starts[i / 4].w[i % 4] = 1;
  }
  ASSERT_TRUE(rig.run().empty());
  for (std::size_t i = 0; i < matrices.size(); ++i) {
    const spu::MatchRotations& q = rig.found[i / 4];
    const Eigen::Quaternionf found(q.w[i % 4], q.x[i % 4], q.y[i % 4], q.z[i % 4]);
    Eigen::Quaterniond expected = Eigen::Quaterniond::Identity();
    const Eigen::Matrix3d rotation = ppu::find_rotation<double>(matrices[i].cast<double>(), expected);
    EXPECT_NEAR(found.norm(), 1, 1e-5) << i;
    // What is maximised, <R, A>, is flat at the optimum: it agrees even where two rotations are nearly as
    // good.
    const double best = rotation.cwiseProduct(matrices[i].cast<double>()).sum();
    const double reached =
        found.normalized().toRotationMatrix().cwiseProduct(matrices[i]).cast<double>().sum();
    EXPECT_NEAR(reached, best, 1e-4 * matrices[i].cast<double>().norm()) << i;
  }
}

TEST(Rotations, RefusesMoreThanFit) {
  RotationsRig rig(1);
  rig.job[0].group_count = spu::kRotationsMaxGroups + 1;
  const auto failures = rig.run();
  ASSERT_EQ(failures.size(), 1u);
  EXPECT_NE(failures[0].message.find("status 1"), std::string::npos) << failures[0].message;
}

}  // namespace
}  // namespace softcell
