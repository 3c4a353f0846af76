#pragma once
// Everything that programs with SPEs need, in one object: main memory, the SPEs with their job loops, and softcell's kernels.
//
//     SpeRuntime spes;                                // six SPEs
//     BulletSoftBodies bodies(world, spes);           // in place of BulletSoftBodies bodies(world);
//     Box2dSoftBodies bodies_2d(world_2d, spes);
//     SpeSkinner skinner(spes);                       // vertex buffers: spe_skinner.h
//
// Your own kernels run beside softcell's: jobs().load(image), then a JobChain (jobs/job_system.h).

#include <chrono>
#include <memory>
#include <string_view>
#include <vector>

#include "softcell/dma/address_space.h"
#include "softcell/dma/schedule.h"
#include "softcell/jobs/job_system.h"
#include "softcell/ls_sim/findings.h"
#include "softcell/soft_bodies/solver_factory.h"

namespace softcell::ppu {

/// Options of an SpeRuntime. Every field has a default.
struct SpeRuntimeOptions {
  int spes = dma::kSpeCount;  ///< 1..6; results do not depend on it
  dma::Schedule schedule{};   ///< when transfers happen; dma::parse_schedule() reads "lazy" or "random:7"
  /// kSpu: kernels and job loop as a compiler for the SPU has built them, interpreted instruction by instruction. The results have the same
  /// bits.
  ls_sim::Machine machine = ls_sim::Machine::kHost;
  /// Runs the checked kernels, which report each wrong access to SpeRuntime::findings() and take some ten times as long.
  bool checked = false;
  /// If set, the SPEs run by the timing model and count their cycles here; they take turns, and work only while the PPU side waits for
  /// them. With machine = kSpu the cycles are those of a PS3. Null: nothing is timed. It must outlive the runtime.
  ls_sim::Timing* timing = nullptr;
  /// For one job, above 0; a job that takes longer is stopped and fails.
  std::chrono::milliseconds deadline{10'000};
  /// Size of main memory: whole megabytes (2^20 bytes), from 1 to 2816. The host provides memory only for the part in use.
  std::uint64_t main_memory_bytes = dma::kMainMemoryBytes;
};

/// Must outlive all objects that use it: solvers, skinners, chains, the soft bodies of worlds. So construct it first. The SPEs are host
/// threads that sleep while there is nothing to do. Used by one thread at a time, except where stated.
class SpeRuntime final : public SolverFactory {
 public:
  /// @throws std::invalid_argument  the number of SPEs, the deadline or the size of main memory is not one that
  ///                                SpeRuntimeOptions allows.
  /// @throws std::runtime_error     the host has no address range or no threads left, or its processor lacks
  ///                                AVX2 or FMA.
  explicit SpeRuntime(const SpeRuntimeOptions& options = {});
  /// Waits for the jobs under way. @pre no chain is left
  ~SpeRuntime() override;
  SpeRuntime(const SpeRuntime&) = delete;
  SpeRuntime& operator=(const SpeRuntime&) = delete;

  /// A solver for the soft bodies of one Bullet world: BulletSoftBodies calls it. A job system has room for
  /// 15 chains; a solver takes one of them, a skinner two.
  /// @throws std::runtime_error  main memory is full, or there are 15 chains already.
  std::unique_ptr<SoftBodySolver<3>> make_solver() override;
  /// A worker that finds and solves contacts of drawn surfaces in one world: BulletSoftBodies and Box2dSoftBodies call it. It takes two
  /// chains. @throws std::runtime_error  main memory is full, or there are 15 chains already.
  std::shared_ptr<ContactWorker> make_contact_worker() override;
  /// A solver for the soft bodies of one Box2D world: Box2dSoftBodies calls it. @throws as make_solver()
  std::unique_ptr<SoftBodySolver<2>> make_solver_2d() override;

  dma::AddressSpace& memory();  ///< main memory, from which buffers are made
  JobSystem& jobs();            ///< for your own kernels
  int spes() const;             ///< their number, 1..6

  /// One of softcell's own kernels, for the machine of the options, checked or not; loaded at the first call.
  /// @throws std::runtime_error  there is no kernel with that name.
  const ls_sim::KernelImage& kernel(std::string_view name);

  /// The findings of checked kernels so far; empty for other kernels. Any thread.
  const ls_sim::Findings& findings() const;

  /// Statistics of each SPE so far: jobs, transfers, time. Any thread.
  std::vector<ls_sim::SpeStatistics> statistics() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::ppu
