#pragma once
// Jobs that SPEs execute without help of the PPU: chains of jobs in main memory, from which resident job loops take one job after the
// other.
//
//   JobSystem jobs(memory, {.spes = 6}, job_loop);
//   const JobImage skin = jobs.load(image);
//   JobChain chain(jobs, "skinning", 100);
//   chain.add({skin, first.ea()});  chain.add({skin, second.ea()});  // these run in any order, at the same time
//   chain.sync();                                                    // the next stage begins after all of them
//   chain.add({skin, third.ea()});
//   chain.kick();                                                    // the PPU is free
//   chain.wait();                                                    // ... until it needs the result
//
// In softcell's sources, spu_kernels/job_chain.h describes the data in memory, spu_kernels/job_loop.cpp what the SPEs do with it.

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "softcell/dma/address_space.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/spe_group.h"

namespace softcell::ppu {

class JobChain;

/// An image in main memory, where job loops fetch it. Valid as long as its JobSystem.
class JobImage {
 public:
  const ls_sim::KernelImage& kernel() const { return *kernel_; }  ///< as passed to load()

 private:
  friend class JobSystem;
  friend class JobChain;
  const ls_sim::KernelImage* kernel_ = nullptr;
  dma::EffectiveAddress ea_;
};

/// One run of an image.
struct Job {
  JobImage image;
  dma::EffectiveAddress argp;       ///< main's second parameter, usually the address of the job's description
  dma::EffectiveAddress envp = {};  ///< main's third
};

/// Why a job failed: the fault's message, or the status that the kernel returned.
struct JobFailure {
  std::size_t job = 0;  ///< its number in the chain; size() of the chain if the job is unknown
  std::string message;
};

/// Up to six SPEs, each with a job loop. They sleep while there is nothing to do; a kick wakes no more of them than
/// there are jobs. Used by one thread, except where stated.
///
/// A job that fails ends only its own chain. If a job loop itself fails, its job is unknown: all loops then finish
/// their present jobs and end, every chain that has not ended by then fails, and the next kick starts the loops again.
///
/// With SpeOptions::interleaving other than kFree, SPEs run only while the PPU side waits: finished() and wait() then
/// return when all SPEs sleep. So a run, and with SpeOptions::timing its cycles, is the same every time.
class JobSystem {
 public:
  /// @param options   the deadline is that of a job; findings: jobs must then be checked images.
  /// @param job_loop  the image of the kernel job_loop; must outlive the system.
  /// @throws std::invalid_argument  `job_loop` is linked to the addresses at which jobs run; as SpeGroup.
  /// @throws std::runtime_error     as SpeGroup.
  JobSystem(dma::AddressSpace& memory, const ls_sim::SpeOptions& options,
            const ls_sim::KernelImage& job_loop);

  /// Waits for the jobs under way. @pre no chain is left.
  ~JobSystem();
  JobSystem(const JobSystem&) = delete;
  JobSystem& operator=(const JobSystem&) = delete;

  /// Copies an image to main memory, where the job loops find it. Loading an image again returns the same copy. The image
  /// must outlive the system.
  /// @throws std::invalid_argument  the image is a program, a resident kernel or built for another machine than the job loop; it leaves
  ///                                no room for the job loop; or it is not checked although the options ask for findings.
  /// @throws std::runtime_error     main memory is full.
  JobImage load(const ls_sim::KernelImage& image);

  /// Waits for all chains and ends the job loops. Afterwards statistics and traces are complete: they include what the loops did between
  /// jobs. A chain that is kicked after this fails, and none of its jobs runs.
  void stop();

  /// The statistics of each SPE, up to the last job that it has ended. Any thread.
  std::vector<ls_sim::SpeStatistics> statistics() const;

  int spes() const;  ///< their number, 1..6

 private:
  friend class JobChain;
  struct State;
  std::unique_ptr<State> state_;
};

/// Jobs in stages. The jobs of one stage run in any order and at the same time, so they must not depend on each other; the next stage
/// begins when all of them have ended. So the result has the same bits for any number of SPEs. Used by one thread. SPEs look at chains in
/// the order in which these were constructed: jobs of an earlier chain go first.
class JobChain {
 public:
  /// @param name       for messages and traces
  /// @param most_jobs  room for so many; reserve() makes more
  /// @throws std::runtime_error  there are 15 chains already, or main memory is full.
  JobChain(JobSystem& system, const std::string& name, std::size_t most_jobs);

  /// Waits for the chain's jobs under way.
  ~JobChain();
  JobChain(const JobChain&) = delete;
  JobChain& operator=(const JobChain&) = delete;

  /// Makes room for this many jobs; jobs that were added stay. Waits for jobs under way.
  /// @throws std::runtime_error  main memory is full; the chain has not changed.
  void reserve(std::size_t most_jobs);

  // The jobs of the next kick(). They stay until clear(), so that a chain can be kicked again. @pre finished()

  void clear();  ///< removes all jobs
  /// Adds a job to the present stage. @throws std::length_error  there are most_jobs already.
  /// @pre job.image comes from JobSystem::load()
  void add(const Job& job);
  /// Ends the present stage, if it has a job.
  void sync();

  std::size_t size() const;  ///< jobs added

  /// Starts the jobs. Does not wait for them. Allocates nothing, except when the loops must start again or the system was stopped.
  /// @pre finished()
  void kick();

  /// Whether all jobs of the last kick have ended.
  bool finished();

  /// Waits until all jobs of the last kick have ended. Always returns: the deadline of the options stops a job that never ends.
  void wait();

  /// The failures of the last kick, in order; empty if there were none. Stages after a failed one have not run.
  /// @pre finished()
  const std::vector<JobFailure>& failures() const;

 private:
  friend class JobSystem;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::ppu
