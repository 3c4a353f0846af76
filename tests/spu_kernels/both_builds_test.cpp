// Each of softcell's kernels built for the host and built for the SPU: the same bytes, statuses and DMA commands.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "ppu/spe_bodies/skin_orchestrator.h"
#include "rotations_job.h"
#include "softcell/ls_sim/trace.h"
#include "softcell/soft_bodies/lattice.h"
#include "softcell/soft_bodies/shapes.h"
#include "softcell/spu_kernels/load_kernel.h"
#include "spu_kernels/stepped_bodies.h"
#include "spu_kernels/strained_body.h"
#include "transfers_job.h"

namespace softcell {
namespace {

using ls_sim::Machine;

/// What a piece of work has left behind.
struct Outcome {
  std::vector<std::byte> bytes;       ///< of its output, in the host's byte order
  std::vector<std::string> failures;  ///< of jobs
  /// Opcode, effective address, size and tag of each DMA command, in order.
  std::vector<std::string> commands;
  std::uint32_t local_store = 0;  ///< bytes that image and stack took at most
  std::uint32_t stack = 0;        ///< of these, the stack of job and job loop

  template <class T>
  void add(std::span<const T> output) {
    const auto raw = std::as_bytes(output);
    bytes.insert(bytes.end(), raw.begin(), raw.end());
  }
};

/// One SPE, whose work is traced.
class Rig {
 public:
  explicit Rig(Machine machine)
      : machine_(machine),
        job_loop_(spu_kernels::load_kernel("job_loop", false, machine)),
        jobs_(memory_, {.spes = 1, .measure_stack = true, .trace = &trace_}, job_loop_) {}

  dma::AddressSpace& memory() { return memory_; }
  ppu::JobSystem& jobs() { return jobs_; }
  const ls_sim::KernelImage& kernel(const std::string& name) {
    kernel_ = spu_kernels::load_kernel(name, false, machine_);
    // As many bytes of both builds, so that all that lies behind them in main memory has the same addresses.
    constexpr std::size_t kBytes = 48 * 1024;
    EXPECT_LE(kernel_.bytes.size(), kBytes);
    EXPECT_LE(kernel_.begin + kBytes, kernel_.sizes.end);
    kernel_.bytes.resize(kBytes);
    return kernel_;
  }

  void run(const std::string& name, dma::EffectiveAddress argp, Outcome& outcome) {
    ppu::JobChain chain(jobs_, name, 1);
    chain.add({jobs_.load(kernel(name)), argp});
    chain.kick();
    chain.wait();
    for (const ppu::JobFailure& failure : chain.failures()) outcome.failures.push_back(failure.message);
  }

  /// @pre  no chain is left
  void finish(Outcome& outcome) {
    jobs_.stop();
    const ls_sim::SpeStatistics statistics = jobs_.statistics().front();
    outcome.stack = statistics.stack_high_water;
    outcome.local_store = kernel_.sizes.end + outcome.stack + (job_loop_.sizes.end - job_loop_.sizes.from);
    const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                       ("softcell_both_builds_" + std::to_string(getpid()) + ".json");
    trace_.write(file);
    std::ifstream stream(file);
    const nlohmann::json trace = nlohmann::json::parse(stream);
    std::filesystem::remove(file);
    for (const nlohmann::json& event : trace["traceEvents"]) {  // commands in the order of issue
      if (event.value("cat", "") != "dma") continue;
      // Local-store addresses are the compilers' affair. How often the job loop looks at its lines is one of time.
      const std::string name = event["name"];
      if (name.find("llar") != name.npos || name.find("putll") != name.npos) continue;
      nlohmann::json what = event["args"];
      what.erase("lsa");
      outcome.commands.push_back(name + " " + what.dump());
    }
  }

 private:
  Machine machine_;
  dma::AddressSpace memory_;
  ls_sim::Trace trace_{1};
  ls_sim::KernelImage job_loop_, kernel_;
  ppu::JobSystem jobs_;
};

constexpr ppu::MatchSettings kSettings{.pull = 30, .damping = 0.1f};
constexpr int kStepsOfBoth = 4;

Outcome match(Machine machine) {
  Outcome outcome;
  Rig rig(machine);
  const ppu::Lattice<3> lattice = ppu::voxelize(ppu::make_sphere(1, 20), 0.3f);
  const ppu::MatchPlan plan(lattice, {lattice, 2, ppu::particle_masses(lattice, 1000)});
  {
    test::SteppedBodies<3> bodies(rig.memory(), rig.jobs(), rig.kernel("match"), plan, 2);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-0.2f, 0.2f);
    for (int step = 0; step < kStepsOfBoth; ++step) {
      for (std::size_t b = 0; b < 2; ++b) {
        for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
          const Eigen::Vector3f x = lattice.rest_position(i);
          bodies.positions(b)[i] = {x.x() + uniform(random), x.y() + uniform(random), x.z() + uniform(random),
                                    0};
        }
      }
      bodies.step(kSettings);
      for (std::size_t b = 0; b < 2; ++b) {
        outcome.add<ppu::MatchBodies<3>::Vector>(bodies.velocities(b));
        outcome.add(std::as_const(bodies).rotations(b));
      }
    }
  }
  rig.finish(outcome);
  return outcome;
}

Outcome match_2d(Machine machine) {
  Outcome outcome;
  Rig rig(machine);
  const std::vector<std::string> rows(9, "#########");
  const ppu::Lattice<2> lattice = ppu::lattice_from_cells(ppu::cells_from_rows(rows), 0.5f);
  const ppu::MatchPlan2d plan(lattice, {lattice, 2, ppu::particle_masses(lattice, 1000)});
  {
    test::SteppedBodies<2> bodies(rig.memory(), rig.jobs(), rig.kernel("match_2d"), plan, 3);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-0.2f, 0.2f);
    for (int step = 0; step < kStepsOfBoth; ++step) {
      for (std::size_t b = 0; b < 3; ++b) {
        for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
          const Eigen::Vector2f x = lattice.rest_position(i);
          bodies.positions(b)[i] = {x.x() + uniform(random), x.y() + uniform(random)};
        }
      }
      bodies.step(kSettings);
      for (std::size_t b = 0; b < 3; ++b) {
        outcome.add<ppu::MatchBodies<2>::Vector>(bodies.velocities(b));
        outcome.add(std::as_const(bodies).rotations(b));
      }
    }
  }
  rig.finish(outcome);
  return outcome;
}

Outcome match_tiles(Machine machine) {
  Outcome outcome;
  Rig rig(machine);
  const ppu::Lattice<3> lattice = ppu::voxelize(ppu::make_sphere(1, 20), 0.3f);
  const ppu::TilePlan plan(lattice, {lattice, 2, ppu::particle_masses(lattice, 1000)},
                           {.planes = 3, .rows = 3});
  {
    test::SteppedTiles body(rig.memory(), rig.jobs(), rig.kernel("match_tiles"), plan);
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-0.2f, 0.2f);
    for (int step = 0; step < kStepsOfBoth; ++step) {
      for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
        const Eigen::Vector3f x = lattice.rest_position(i);
        body.positions()[plan.place_of()[i]] = {x.x() + uniform(random), x.y() + uniform(random),
                                                x.z() + uniform(random), 0};
      }
      body.step(kSettings);
      outcome.add<ppu::TiledMemory::Vector>(body.velocities());
    }
  }
  rig.finish(outcome);
  return outcome;
}

Outcome skin(Machine machine) {
  Outcome outcome;
  Rig rig(machine);
  const ppu::TriangleMesh mesh = ppu::make_sphere(1, 20);
  const ppu::Lattice<3> lattice = ppu::voxelize(mesh, 0.25f);
  const auto embedding = std::make_shared<ppu::Embedding>(ppu::embed(mesh, lattice));
  {
    ppu::SkinOrchestrator orchestrator(rig.memory(), rig.jobs(), rig.kernel("skin"));
    orchestrator.add(embedding, lattice.particles.size());
    std::mt19937 random(7);
    std::uniform_real_distribution<float> uniform(-0.05f, 0.05f);
    for (int frame = 0; frame < kStepsOfBoth; ++frame) {
      std::vector<Eigen::Vector4f> corners;
      for (std::size_t i = 0; i < lattice.particles.size(); ++i) {
        const Eigen::Vector3f x = lattice.rest_position(i);
        corners.emplace_back(x.x() + uniform(random), x.y() + uniform(random), x.z() + uniform(random), 0);
      }
      const std::span<const Eigen::Vector4f> all(corners);
      orchestrator.kick({&all, 1});
      orchestrator.drain();
      outcome.add(orchestrator.shown(0).vertices);
    }
  }
  rig.finish(outcome);
  return outcome;
}

constexpr dma::BufferOptions kFloats{.element_bytes = sizeof(float)};
constexpr dma::ElementRun kRotationsJobRecord[] = {{24, 8}, {104, 4}};
constexpr dma::ElementRun kTransfersJobRecord[] = {{8, 8}, {120, 4}};

/// Groups of random matrices; one more than fit are refused by both.
Outcome rotations(Machine machine) {
  Outcome outcome;
  Rig rig(machine);
  constexpr std::size_t kGroups = spu::kRotationsMaxGroups;
  dma::Buffer<spu::RotationMatrices> matrices(rig.memory(), "matrices", kGroups, kFloats);
  dma::Buffer<spu::MatchRotations> starts(rig.memory(), "starts", kGroups, kFloats);
  dma::Buffer<spu::MatchRotations> found(rig.memory(), "found", kGroups, kFloats);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (std::size_t g = 0; g < kGroups; ++g) {
    for (auto& lanes : matrices[g].element)
      for (float& element : lanes) element = uniform(random);
    for (float& w : starts[g].w) w = 1;
  }
  dma::Buffer<spu::RotationsJob> job(rig.memory(), "job", 1, {.record = kRotationsJobRecord});
  job[0] = {matrices.ea().value, starts.ea().value, found.ea().value, kGroups, 1, 0, 6, {}};
  rig.run("rotations", job.ea(), outcome);
  outcome.add<spu::MatchRotations>(found.span());
  rig.finish(outcome);
  return outcome;
}

Outcome refused_rotations(Machine machine) {
  Outcome outcome;
  Rig rig(machine);
  dma::Buffer<spu::RotationsJob> job(rig.memory(), "job", 1, {.record = kRotationsJobRecord});
  job[0].group_count = spu::kRotationsMaxGroups + 1;
  rig.run("rotations", job.ea(), outcome);
  EXPECT_EQ(outcome.failures.size(), 1u);
  rig.finish(outcome);
  return outcome;
}

Outcome strain(Machine machine) {
  Outcome outcome;
  Rig rig(machine);
  test::StrainedBody body(rig.memory(),
                          {.particles = 500, .edge_groups = 700, .diagonal_groups = 9, .face_groups = 400});
  rig.run("strain", body.job.ea(), outcome);
  outcome.add<spu::StrainResult>(body.result.span());
  rig.finish(outcome);
  return outcome;
}

Outcome transfers(Machine machine) {
  Outcome outcome;
  Rig rig(machine);
  dma::Buffer<std::uint32_t> data(rig.memory(), "data", 4096);
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<std::uint32_t>(0x01020304u * i);
  dma::Buffer<spu::TransfersJob> job(rig.memory(), "job", 1, {.record = kTransfersJobRecord});
  job[0] = {data.ea().value, 1024, 64, 16, spu::kTransferGet, {}};
  rig.run("transfers", job.ea(), outcome);
  outcome.add<std::uint32_t>(data.span());
  rig.finish(outcome);
  return outcome;
}

void expect_same(const char* kernel, Outcome (*work)(Machine)) {
  const Outcome host = work(Machine::kHost), spu = work(Machine::kSpu);
  std::cout << kernel << ": " << host.bytes.size() << " bytes of output, " << host.commands.size()
            << " DMA commands; local store " << host.local_store << " bytes on the host, " << spu.local_store
            << " on the SPU; stack with the job loop's " << host.stack << " and " << spu.stack << "\n";
  EXPECT_EQ(host.failures, spu.failures);
  EXPECT_GT(host.commands.size(), 3u);
  ASSERT_EQ(host.bytes.size(), spu.bytes.size());
  const auto [here, there] = std::ranges::mismatch(host.bytes, spu.bytes);
  EXPECT_TRUE(here == host.bytes.end()) << "byte " << here - host.bytes.begin() << " of the output differs";
  ASSERT_EQ(host.commands.size(), spu.commands.size());
  const auto [first, other] = std::ranges::mismatch(host.commands, spu.commands);
  EXPECT_TRUE(first == host.commands.end()) << "DMA command " << first - host.commands.begin() << ": "
                                            << *first << " on the host, " << *other << " on the SPU";
}

TEST(BothBuilds, OfMatchAreTheSameKernel) { expect_same("match", match); }
TEST(BothBuilds, OfMatch2dAreTheSameKernel) { expect_same("match_2d", match_2d); }
TEST(BothBuilds, OfMatchTilesAreTheSameKernel) { expect_same("match_tiles", match_tiles); }
TEST(BothBuilds, OfSkinAreTheSameKernel) { expect_same("skin", skin); }
TEST(BothBuilds, OfRotationsAreTheSameKernel) { expect_same("rotations", rotations); }
TEST(BothBuilds, OfRotationsRefuseTheSameJob) { expect_same("rotations", refused_rotations); }
TEST(BothBuilds, OfStrainAreTheSameKernel) { expect_same("strain", strain); }
TEST(BothBuilds, OfTransfersAreTheSameKernel) { expect_same("transfers", transfers); }

}  // namespace
}  // namespace softcell
