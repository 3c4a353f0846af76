#include "softcell/ls_sim/spe_pool.h"

#include <algorithm>
#include <array>
#include <condition_variable>
#include <stdexcept>

#include "spe_threads.h"

namespace softcell::ls_sim {

void JobBatch::wait() const {
  for (std::uint32_t left = pending_.load(std::memory_order_acquire); left != 0;
       left = pending_.load(std::memory_order_acquire)) {
    pending_.wait(left, std::memory_order_acquire);
  }
}

namespace {

/// Why a job failed; empty when it did not.
std::string failure_of(int spe, const KernelImage& image, const RunResult& result) {
  if (result.fault) return result.fault->message();
  if (result.ended_normally() && result.status() == 0) return {};
  return "SPE " + std::to_string(spe) + ", kernel " + image.name +
         (result.ended_normally() ? ": refused its job with status " + std::to_string(result.status())
                                  : ": stopped with code " + std::to_string(result.stop_code));
}

}  // namespace

struct SpePool::State final : RunSource {
  struct QueuedJob {
    Job job;
    std::uint64_t number = 0;
    JobBatch* batch = nullptr;
  };

  /// What an SPE's thread remembers of the job that it has taken.
  struct Taken {
    QueuedJob job;
    bool more = false, was_full = false;
  };

  State(dma::AddressSpace& memory, const SpeOptions& options)
      : ring(kQueueCapacity), threads(memory, options, SpeMonitor::PpuSide::kStaysAway, *this) {}

  ~State() override {
    {
      const SpeMonitor::Lock lock = threads.monitor().lock();
      stopping = true;
    }
    job_ready.notify_all();
    slot_free.notify_all();
    threads.join();
    while (count != 0) finish(pop(), "dropped: the pool of SPEs was closed before the job ran");
  }

  QueuedJob pop() {
    const QueuedJob next = ring[head];
    head = (head + 1) % kQueueCapacity;
    --count;
    return next;
  }

  /// With the lock, or when no other thread is left.
  static void finish(const QueuedJob& done, std::string failure) {
    if (!failure.empty()) {
      auto& failures = done.batch->failures_;
      const auto place =
          std::upper_bound(failures.begin(), failures.end(), done.number,
                           [](std::uint64_t number, const JobFailure& f) { return number < f.job; });
      failures.insert(place, JobFailure{done.number, std::move(failure)});
    }
    // The batch may be gone as soon as its last job is counted down.
    auto& pending = done.batch->pending_;
    if (pending.fetch_sub(1, std::memory_order_acq_rel) == 1) pending.notify_all();
  }

  std::optional<Run> next_run(int spe, SpeMonitor::Lock& lock) override {
    job_ready.wait(lock, [this] { return stopping || count != 0; });
    if (stopping) return std::nullopt;
    const QueuedJob next = pop();
    taken[static_cast<std::size_t>(spe)] = {next, count != 0, count + 1 == kQueueCapacity};
    threads.spe(spe).registers() = {};  // a job finds nothing that another has left
    const auto now = std::chrono::steady_clock::now();
    threads.monitor().start(spe, *next.job.image, now);
    return Run{.image = next.job.image,
               .arguments = {static_cast<std::uint64_t>(spe), next.job.argp.value, next.job.envp.value},
               .number = next.number,
               .begin = now};
  }

  void on_taken(int spe) override {
    const Taken& mine = taken[static_cast<std::size_t>(spe)];
    if (mine.more) job_ready.notify_one();  // each SPE wakes the next, so that submitting costs one wake-up
    if (mine.was_full) slot_free.notify_one();
  }

  void on_ended(int spe, const Run& run, RunResult&& result) override {
    finish(taken[static_cast<std::size_t>(spe)].job, failure_of(spe, *run.image, result));
  }

  // All guarded by the monitor's lock, but what each SPE's thread has taken.
  std::condition_variable job_ready, slot_free;
  std::vector<QueuedJob> ring;
  std::size_t head = 0, count = 0;
  std::uint64_t submitted = 0;
  bool stopping = false;
  std::array<Taken, dma::kSpeCount> taken;

  SpeThreads threads;
};

SpePool::SpePool(dma::AddressSpace& memory, const SpeOptions& options) {
  if (options.interleaving == Interleaving::kTurns) {
    throw std::invalid_argument(
        "the jobs of a pool do not depend on each other, and take no turns; an SpeGroup's SPEs do");
  }
  state_ = std::make_unique<State>(memory, options);
}

SpePool::~SpePool() = default;

void SpePool::submit(JobBatch& batch, std::span<const Job> jobs) {
  if (jobs.empty()) return;
  SpeMonitor::Lock lock = state_->threads.monitor().lock();
  if (batch.finished()) batch.failures_.clear();
  batch.pending_.fetch_add(static_cast<std::uint32_t>(jobs.size()), std::memory_order_acq_rel);
  for (const Job& job : jobs) {
    state_->slot_free.wait(lock, [this] { return state_->count < kQueueCapacity; });
    state_->ring[(state_->head + state_->count) % kQueueCapacity] = {job, state_->submitted++, &batch};
    ++state_->count;
    if (state_->count == kQueueCapacity) state_->job_ready.notify_one();
  }
  lock.unlock();
  state_->job_ready.notify_one();
}

std::vector<SpeStatistics> SpePool::statistics() const {
  const SpeMonitor::Lock lock = state_->threads.monitor().lock();
  std::vector<SpeStatistics> result;
  for (int spe = 0; spe < spes(); ++spe) result.push_back(state_->threads.statistics(spe));
  return result;
}

int SpePool::spes() const { return state_->threads.spes(); }

}  // namespace softcell::ls_sim
