// The kernel skin on an SPE against its oracle, in poses and sizes that scenes do not show.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "ppu/reference/skin_scalar.h"
#include "ppu/spe_bodies/job_records.h"
#include "ppu/spe_bodies/skin_orchestrator.h"
#include "softcell/jobs/job_system.h"
#include "softcell/ls_sim/findings.h"
#include "softcell/ls_sim/timing.h"
#include "softcell/soft_bodies/lattice.h"
#include "softcell/soft_bodies/shapes.h"
#include "spu_kernels/kernel_image.h"
#include "support/float_from_half.h"

namespace softcell {
namespace {

using Eigen::Vector3f;

/// A mesh in a lattice, skinned by the kernel.
class SkinRig {
 public:
  explicit SkinRig(const ppu::TriangleMesh& mesh, float cell_size, const ls_sim::SpeOptions& options = {},
                   ls_sim::Machine machine = test::machine_of_tests())
      : lattice(ppu::voxelize(mesh, cell_size)),
        embedding(std::make_shared<ppu::Embedding>(ppu::embed(mesh, lattice))),
        image_(test::kernel_image("skin", options.findings != nullptr, machine)),
        job_loop_(test::kernel_image("job_loop", false, machine)),
        jobs_(memory_, options, job_loop_),
        orchestrator_(memory_, jobs_, image_) {
    for (std::size_t i = 0; i < lattice.particles.size(); ++i) positions.push_back(lattice.rest_position(i));
    orchestrator_.add(embedding, positions.size());
  }

  ppu::SkinnedBody skin() {
    std::vector<Eigen::Vector4f> corners;
    for (const Vector3f& p : positions) corners.push_back({p.x(), p.y(), p.z(), 0});
    const std::span<const Eigen::Vector4f> all(corners);
    EXPECT_TRUE(orchestrator_.kick({&all, 1}));
    orchestrator_.drain();
    return orchestrator_.shown(0);
  }

  /// Every vertex against the double-precision evaluation.
  void expect_oracle(double position_tolerance, double normal_tolerance) {
    const ppu::SkinnedBody body = skin();
    for (const ppu::SkinPart& part : embedding->parts) {
      for (std::uint32_t g = part.first_group; g < part.first_group + part.group_count; ++g) {
        for (int lane = 0; lane < 4; ++lane) {
          const ppu::ReferenceVertex expected = ppu::evaluate_reference(*embedding, part, g, lane, positions);
          const spu::SkinnedVertex& v = body.vertices[4 * g + static_cast<std::uint32_t>(lane)];
          Eigen::Vector3d position, normal;
          for (int d = 0; d < 3; ++d) {
            position[d] = double{ppu::float_from_half(v.position[d])} + double{body.origin[d]};
            normal[d] = double{ppu::float_from_half(v.normal[d])};
          }
          ASSERT_LE((position - expected.position).lpNorm<Eigen::Infinity>(), position_tolerance)
              << "group " << g << " lane " << lane;
          ASSERT_LE((normal - expected.normal).norm(), normal_tolerance) << "group " << g << " lane " << lane;
        }
      }
    }
  }

  ppu::Lattice<3> lattice;
  std::shared_ptr<ppu::Embedding> embedding;
  std::vector<Vector3f> positions;

 private:
  dma::AddressSpace memory_;
  ls_sim::KernelImage image_, job_loop_;
  ppu::JobSystem jobs_;
  ppu::SkinOrchestrator orchestrator_;
};

constexpr double kUlpAtTwo = 1.0 / 1024;  // of a half between 1 and 2 metres from the origin

TEST(Skin, ShowsTheRestShapeAtRest) {
  const ppu::TriangleMesh mesh = ppu::make_sphere(0.7f, 12);
  SkinRig rig(mesh, 0.28f);
  const ppu::SkinnedBody body = rig.skin();
  for (std::size_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
    const spu::SkinnedVertex& v = body.vertices[rig.embedding->slot_of_vertex[vertex]];
    for (int d = 0; d < 3; ++d) {
      EXPECT_NEAR(ppu::float_from_half(v.position[d]) + body.origin[d], mesh.positions[vertex][d], kUlpAtTwo);
      EXPECT_NEAR(ppu::float_from_half(v.normal[d]), mesh.normals[vertex][d], 0.002);
    }
    EXPECT_EQ(v.position[3], 0x3C00);
    EXPECT_EQ(v.normal[3], 0);
  }
}

TEST(Skin, AgreesWithTheOracleInRandomPoses) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> jitter(-0.06f, 0.06f);
  SkinRig rig(ppu::make_torus(0.72f, 0.28f, 40, 20), 0.2f);
  for (int pose = 0; pose < 10; ++pose) {
    for (std::size_t i = 0; i < rig.positions.size(); ++i) {
      rig.positions[i] =
          rig.lattice.rest_position(i) + Vector3f(jitter(random), jitter(random), jitter(random));
    }
    rig.expect_oracle(kUlpAtTwo, 0.005);
  }
}

TEST(Skin, ItsCheckedImageFindsNothing) {
  for (const char* schedule : {"eager", "lazy", "random:5"}) {
    ls_sim::Findings findings;
    SkinRig rig(ppu::make_torus(0.72f, 0.28f, 40, 20), 0.2f,
                {.spes = 2, .schedule = dma::parse_schedule(schedule), .findings = &findings});
    rig.expect_oracle(kUlpAtTwo, 0.005);
    for (const ls_sim::Finding& finding : findings.list()) ADD_FAILURE() << finding.fault.message();
  }
}

TEST(Skin, FollowsInvertedAndFlattenedCells) {
  SkinRig rig(ppu::make_sphere(0.7f, 12), 0.28f);
  for (Vector3f& p : rig.positions) p.x() = -p.x();
  rig.expect_oracle(kUlpAtTwo, 0.005);
  // No volume: along x, or the rest normal where that has no part along x; and no NaN.
  for (Vector3f& p : rig.positions) p.x() = 0.25f;
  rig.expect_oracle(kUlpAtTwo, 0.005);
}

TEST(Skin, WorksFarFromTheWorldsOrigin) {
  SkinRig rig(ppu::make_sphere(0.7f, 12), 0.28f);
  for (Vector3f& p : rig.positions) p += Vector3f(1000, -200, 500);
  rig.expect_oracle(2 * kUlpAtTwo, 0.02);  // the particles themselves are only good to 6e-5 m there
}

TEST(Skin, CutsLargeLatticesIntoJobsOfTwoWindows) {
  SkinRig rig(ppu::make_sphere(1.0f, 40), 0.05f);
  EXPECT_GT(rig.embedding->parts.size(), 6u);
  EXPECT_TRUE(std::ranges::any_of(rig.embedding->parts,
                                  [](const ppu::SkinPart& part) { return part.window[1].count > 0; }));
  EXPECT_GT(rig.positions.size(), std::size_t{spu::kSkinMaxCorners});
  rig.expect_oracle(2 * kUlpAtTwo, 0.02);
}

TEST(Skin, GivesTheSameBytesUnderEveryScheduleOnAFreshLocalStoreAndOnAUsedOne) {
  std::vector<spu::SkinnedVertex> expected;
  for (const char* schedule : {"eager", "lazy", "random:1", "random:2", "random:3"}) {
    SkinRig rig(ppu::make_sphere(0.7f, 24), 0.2f, {.spes = 1, .schedule = dma::parse_schedule(schedule)});
    for (const char* local_store : {"fresh", "used"}) {
      const auto body = rig.skin();
      if (expected.empty()) expected.assign(body.vertices.begin(), body.vertices.end());
      ASSERT_EQ(expected.size(), body.vertices.size());
      EXPECT_EQ(std::memcmp(expected.data(), body.vertices.data(), body.vertices.size_bytes()), 0)
          << schedule << ", on a " << local_store << " local store";
    }
  }
}

TEST(Skin, AgreesWithItsScalarTwinToOneUnit) {
  SkinRig rig(ppu::make_torus(0.72f, 0.28f, 64, 32), 0.2f);
  for (Vector3f& p : rig.positions) p.z() += 0.2f * p.x() * p.y();
  const ppu::SkinnedBody body = rig.skin();
  std::vector<spu::SkinnedVertex> twin(body.vertices.size());
  for (const ppu::SkinPart& part : rig.embedding->parts) {
    ppu::skin_scalar(
        *rig.embedding, part, rig.positions, body.origin,
        std::span(twin).subspan(4 * std::size_t{part.first_group}, 4 * std::size_t{part.group_count}));
  }
  for (std::size_t i = 0; i < twin.size(); ++i) {
    for (int d = 0; d < 3; ++d)
      ASSERT_LE(std::abs(int{twin[i].position[d]} - int{body.vertices[i].position[d]}), 1) << "slot " << i;
  }
}

/// Cycles of a PS3 for a vertex, waits for transfers included.
double cycles_a_vertex(const ppu::TriangleMesh& mesh, float cell_size) {
  ls_sim::Timing timing(1);
  ls_sim::SpeOptions options{.spes = 1, .interleaving = ls_sim::Interleaving::kTurns};
  ls_sim::time_by(&timing, options);
  SkinRig rig(mesh, cell_size, options, ls_sim::Machine::kSpu);
  rig.skin();
  const auto kernels = timing.by_kernel();
  EXPECT_EQ(kernels.size(), 1u);
  return static_cast<double>(kernels[0].cycles) / static_cast<double>(mesh.positions.size());
}

TEST(Skin, TakesFewCyclesOfAPs3) {
  EXPECT_LE(cycles_a_vertex(ppu::make_sphere(1, 120), 0.25f), 30);  // many vertices in a cell
  EXPECT_LE(cycles_a_vertex(ppu::make_sphere(1, 20), 0.25f), 60);   // few
}

TEST(Skin, RefusesAJobWithTooManyCorners) {
  dma::AddressSpace memory;
  const ls_sim::KernelImage job_loop = test::kernel_image("job_loop");
  ppu::JobSystem system(memory, {.spes = 1}, job_loop);
  const ls_sim::KernelImage image = test::kernel_image("skin");
  dma::Buffer<spu::SkinJob> jobs(memory, "jobs", 3, {.record = ppu::kSkinJobRecord});
  jobs[0].window[0].count = spu::kSkinMaxCorners + 1;
  jobs[1].window[0].count = spu::kSkinMaxCorners;
  jobs[1].window[1].count = 1;
  jobs[2].window[0].count = 0xFFFFFFFF;
  jobs[2].window[1].count = 2;
  ppu::JobChain batch(system, "refused", 3);
  for (std::size_t i = 0; i < 3; ++i) batch.add({system.load(image), jobs.ea(i)});
  batch.kick();
  batch.wait();
  ASSERT_EQ(batch.failures().size(), 1u);
  const std::string& message = batch.failures()[0].message;
  EXPECT_NE(message.find("status 1, and 2 more jobs failed"), std::string::npos) << message;
}

TEST(Skin, AnEmptyJobIsDone) {
  dma::AddressSpace memory;
  const ls_sim::KernelImage job_loop = test::kernel_image("job_loop");
  ppu::JobSystem system(memory, {.spes = 1}, job_loop);
  const ls_sim::KernelImage image = test::kernel_image("skin");
  dma::Buffer<spu::SkinJob> jobs(memory, "jobs", 1, {.record = ppu::kSkinJobRecord});
  ppu::JobChain batch(system, "empty", 1);
  batch.add({system.load(image), jobs.ea()});
  batch.kick();
  batch.wait();
  EXPECT_TRUE(batch.failures().empty());
}

/// Two bodies, of which one lies still: its vertices are made twice, once for each half, and shown in every frame.
TEST(Orchestrator, BodiesThatDoNotMoveAreNotSkinnedAgain) {
  dma::AddressSpace memory;
  const ls_sim::KernelImage job_loop = test::kernel_image("job_loop"), image = test::kernel_image("skin");
  ppu::JobSystem system(memory, {.spes = 1}, job_loop);
  const ppu::TriangleMesh mesh = ppu::make_sphere(0.7f, 8);
  const ppu::Lattice<3> lattice = ppu::voxelize(mesh, 0.35f);
  const auto embedding = std::make_shared<ppu::Embedding>(ppu::embed(mesh, lattice));
  ASSERT_EQ(embedding->parts.size(), 1u);
  std::vector<Eigen::Vector4f> still, moving;
  for (std::size_t i = 0; i < lattice.particles.size(); ++i)
    still.push_back(
        {lattice.rest_position(i).x(), lattice.rest_position(i).y(), lattice.rest_position(i).z(), 0});
  moving = still;
  ppu::SkinOrchestrator orchestrator(memory, system, image);
  orchestrator.add(embedding, still.size());
  orchestrator.add(embedding, moving.size());
  const auto frame = [&] {
    const std::array<std::span<const Eigen::Vector4f>, 2> all{still, moving};
    ASSERT_TRUE(orchestrator.kick(all));
    ASSERT_TRUE(orchestrator.drain());
  };
  const auto vertex = [&](std::size_t body) {
    const ppu::SkinnedBody shown = orchestrator.shown(body);
    return ppu::float_from_half(shown.vertices[0].position[1]) + shown.origin.y();
  };
  frame();
  const float height = vertex(0);
  for (int i = 1; i < 6; ++i) {
    for (Eigen::Vector4f& p : moving) p.y() += 1;
    frame();
    EXPECT_EQ(vertex(0), height);
    EXPECT_NEAR(vertex(1), height + static_cast<float>(i), 2 * kUlpAtTwo);
  }
  frame();  // nothing has moved since the last frame, but since the one before
  frame();
  frame();
  EXPECT_EQ(vertex(0), height);
  EXPECT_NEAR(vertex(1), height + 5, 2 * kUlpAtTwo);
  orchestrator.drain();
  system.stop();
  std::uint64_t jobs = 0;
  for (const ls_sim::SpeStatistics& spe : system.statistics()) jobs += spe.jobs;
  EXPECT_EQ(jobs, 2u + 6u + 1u);
}

TEST(Orchestrator, AFaultFailsItsFrameWithItsMessageAndLeavesTheProcessAlive) {
  dma::AddressSpace memory;
  const ls_sim::KernelImage job_loop = test::kernel_image("job_loop");
  ppu::JobSystem system(memory, {.spes = 1}, job_loop);
  ls_sim::KernelImage broken = test::kernel_image("skin");
  const bool is_spu = broken.machine == ls_sim::Machine::kSpu;
  const std::array<std::uint8_t, 4> invalid =
      is_spu ? std::array<std::uint8_t, 4>{0x00, 0xE0, 0, 0} : std::array<std::uint8_t, 4>{0x0F, 0x0B, 0, 0};
  std::memcpy(broken.bytes.data() + (broken.main - broken.begin), invalid.data(), invalid.size());
  const ppu::TriangleMesh mesh = ppu::make_sphere(0.7f, 8);
  const ppu::Lattice<3> lattice = ppu::voxelize(mesh, 0.35f);
  const auto embedding = std::make_shared<ppu::Embedding>(ppu::embed(mesh, lattice));
  ppu::SkinOrchestrator orchestrator(memory, system, broken);
  const std::vector<Eigen::Vector4f> corners(lattice.particles.size(), Eigen::Vector4f::Zero());
  orchestrator.add(embedding, corners.size());
  const std::span<const Eigen::Vector4f> all(corners);
  orchestrator.kick({&all, 1});
  try {
    orchestrator.drain();
    FAIL() << "the fault was lost";
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("illegal-instruction"), std::string::npos) << message;
    EXPECT_NE(message.find("kernel skin"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace softcell
