// Only the search for the rotations nearest to matrices: four at a time on an SPE, and one after the other on the PPU.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "benchmarks.h"
#include "kernel_runs/kernel_file.h"
#include "ppu/matching/rotation.h"
#include "rotations_job.h"
#include "softcell/base/assert.h"
#include "softcell/dma/buffer.h"
#include "softcell/jobs/job_system.h"
#include "spe_waker.h"

namespace softcell::tool {
namespace {

constexpr std::size_t kGroupsOfFour = 128, kMatrices = 4 * kGroupsOfFour;
constexpr std::uint32_t kRepeats = 32;  // in one job, so that its dispatch does not count
constexpr float kTurn = 0.01f;          // radians since the last step

/// A matrix, and where the search for its rotation begins.
struct RotationCase {
  Eigen::Matrix3f matrix;
  Eigen::Quaternionf start;
};

/// Random numbers, directions and matrices.
struct Random {
  std::mt19937 bits{11};
  std::uniform_real_distribution<float> uniform{-1, 1};

  Eigen::Matrix3f matrix() {
    return Eigen::Matrix3f::NullaryExpr([&] { return uniform(bits); });
  }
  Eigen::Vector3f direction() {
    return Eigen::Vector3f(uniform(bits), uniform(bits), uniform(bits)).normalized();
  }
};

RotationCase any_matrix(Random& random) { return {random.matrix(), Eigen::Quaternionf::Identity()}; }

/// R S with S near one; the search begins at R turned back by kTurn, as after a step.
RotationCase deformed_a_little(Random& random) {
  const Eigen::Quaternionf r(Eigen::AngleAxisf(3 * random.uniform(random.bits), random.direction()));
  const Eigen::Matrix3f strain = 0.05f * random.matrix();
  return {r.toRotationMatrix() * (Eigen::Matrix3f::Identity() + strain + strain.transpose()),
          r * Eigen::Quaternionf(Eigen::AngleAxisf(-kTurn, random.direction()))};
}

/// The same matrices for the kernel `rotations` and for the PPU.
class RotationRig {
 public:
  RotationRig(RotationCase (*make)(Random&), std::uint32_t least_iterations, std::uint32_t most_iterations)
      : matrices_(memory_, "matrices", kGroupsOfFour),
        starts_(memory_, "starts", kGroupsOfFour),
        found_(memory_, "found", kGroupsOfFour),
        job_(memory_, "rotations job", 1) {
    SC_ASSERT(least_iterations <= most_iterations, "from {} to {} iterations", least_iterations,
              most_iterations);
    Random random;
    for (std::size_t i = 0; i < kMatrices; ++i) {
      cases_.push_back(make(random));
      const std::size_t group = i / 4, lane = i % 4;
      for (int e = 0; e < 9; ++e) matrices_[group].element[e][lane] = cases_[i].matrix(e / 3, e % 3);
      spu::MatchRotations& start = starts_[group];
      start.x[lane] = cases_[i].start.x();
      start.y[lane] = cases_[i].start.y();
      start.z[lane] = cases_[i].start.z();
      start.w[lane] = cases_[i].start.w();
    }
    job_[0] = {matrices_.ea().value,
               starts_.ea().value,
               found_.ea().value,
               kGroupsOfFour,
               kRepeats,
               least_iterations,
               most_iterations,
               {}};
    chain_.add({jobs_.load(kernel_), job_.ea()});
  }

  void run_spe() {
    SC_ASSERT(chain_.size() == 1, "a chain of {} jobs finds the rotations", chain_.size());
    chain_.kick();
    chain_.wait();
    if (!chain_.failures().empty()) throw std::runtime_error(chain_.failures().front().message);
  }

  void wake() { waker_.wake(); }

  void run_ppu() {
    SC_ASSERT(cases_.size() == kMatrices, "{} matrices of {}", cases_.size(), kMatrices);
    for (const RotationCase& c : cases_) {
      Eigen::Quaternionf rotation = c.start;
      const Eigen::Matrix3f found = ppu::update_rotation(c.matrix, rotation);
      asm volatile("" ::"m"(found) : "memory");  // keeps the compiler from leaving out any rotation
    }
  }

 private:
  dma::AddressSpace memory_;
  ls_sim::KernelImage kernel_ = load_kernel("rotations"), job_loop_ = load_kernel("job_loop");
  ppu::JobSystem jobs_{memory_, {.spes = 1}, job_loop_};
  SpeWaker waker_{jobs_};
  ppu::JobChain chain_{jobs_, "rotations", 1};
  dma::Buffer<spu::RotationMatrices> matrices_;
  dma::Buffer<spu::MatchRotations> starts_, found_;
  dma::Buffer<spu::RotationsJob> job_;
  std::vector<RotationCase> cases_;
};

void add_rotation(std::vector<Benchmark>& all, const std::string& name, RotationCase (*make)(Random&),
                  std::uint32_t least_iterations, std::uint32_t most_iterations) {
  const Shared<RotationRig> shared(
      [=] { return std::make_shared<RotationRig>(make, least_iterations, most_iterations); });
  all.push_back({"rotation/" + name + "/spe", [=] {
                   const auto rig = shared.get();
                   return Work{.items = kRepeats * kMatrices,
                               .run = [rig] { rig->run_spe(); },
                               .before = [rig] { rig->wake(); }};
                 }});
  all.push_back({"rotation/" + name + "/ppu", [=] {
                   return Work{kMatrices, [rig = shared.get()] { rig->run_ppu(); }};
                 }});
}

}  // namespace

void add_rotation_benchmarks(std::vector<Benchmark>& all) {
  add_rotation(all, "random", any_matrix, 0, 6);
  add_rotation(all, "converged", deformed_a_little, 2, 2);
}

}  // namespace softcell::tool
