#pragma once
// Six SPEs, each a thread with its own local store and MFC, that take jobs from one queue.
//
//   caller   submit(batch, jobs) ............ batch.wait() -> failures
//   SPE 0    [ job 0 ][ job 2 ] ...            each SPE takes the oldest job when it is free; an image stays
//   resident SPE 1    [ job 1      ][ job 3 ] ...       until another is asked for
//
// Jobs of one submission may run in any order and at the same time, so they must not depend on each other.
// Then the result is the same bits for any number of SPEs.

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "softcell/dma/buffer.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/spe_options.h"
#include "softcell/ls_sim/statistics.h"

namespace softcell::ls_sim {

/// One run of an image.
struct Job {
  const KernelImage* image = nullptr;  ///< must outlive the job
  dma::EffectiveAddress argp;
  dma::EffectiveAddress envp;
};

/// Why a job failed: the fault's message, or the status that the kernel returned.
struct JobFailure {
  std::uint64_t job = 0;  ///< its number in order of submission to the pool
  std::string message;
};

/// Follows a set of jobs. Reusable once finished. One thread submits and waits; SPEs count down.
class JobBatch {
 public:
  bool finished() const { return pending_.load(std::memory_order_acquire) == 0; }

  /// Blocks until every job has ended, well or badly. Always returns: a job that never ends is stopped by the
  /// pool's deadline.
  void wait() const;

  /// Empty when all went well; in order of submission. @pre finished().
  const std::vector<JobFailure>& failures() const { return failures_; }

 private:
  friend class SpePool;
  std::atomic<std::uint32_t> pending_{0};
  std::vector<JobFailure> failures_;  // guarded by the pool's mutex until finished
};

class SpePool {
 public:
  /// @throws std::invalid_argument  spes outside 1..6, or a deadline that is not positive.
  /// @throws std::runtime_error     when the host cannot run native kernels.
  SpePool(dma::AddressSpace& memory, const SpeOptions& options);

  /// Waits for the jobs under way, drops those that no SPE has taken.
  ~SpePool();
  SpePool(const SpePool&) = delete;
  SpePool& operator=(const SpePool&) = delete;

  /// Queues the jobs; returns at once unless more than kQueueCapacity jobs are waiting. Allocates nothing.
  /// Any thread.
  void submit(JobBatch& batch, std::span<const Job> jobs);

  /// Of each SPE. Exact for jobs whose batch has finished.
  std::vector<SpeStatistics> statistics() const;

  int spes() const;

  static constexpr std::size_t kQueueCapacity = 4096;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::ls_sim
