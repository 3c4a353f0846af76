#include "softcell/ls_sim/spe_pool.h"

#include <pthread.h>
#include <sched.h>

#include <algorithm>
#include <condition_variable>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "spe.h"

namespace softcell::ls_sim {

void JobBatch::wait() const {
  for (std::uint32_t left = pending_.load(std::memory_order_acquire); left != 0;
       left = pending_.load(std::memory_order_acquire)) {
    pending_.wait(left, std::memory_order_acquire);
  }
}

namespace {

/// On a console an SPE never takes time from the PPU. Here both share cores: a batch thread at least does not
/// interrupt the thread that wakes it. Where the host refuses, only timings suffer.
void leave_the_ppu_its_core() {
  const sched_param parameters{};
  pthread_setschedparam(pthread_self(), SCHED_BATCH, &parameters);
}

}  // namespace

struct SpePool::State {
  struct QueuedJob {
    Job job;
    std::uint64_t number = 0;
    JobBatch* batch = nullptr;
  };

  /// An SPE and what the watchdog needs to know of it.
  struct Worker {
    Worker(int number, dma::AddressSpace& memory, const SpeOptions& options) : spe(number, memory, options) {}
    Spe spe;
    SpeStatistics statistics;                         // copied after each job
    std::chrono::steady_clock::time_point started{};  // of the job under way
    bool busy = false;
  };

  State(dma::AddressSpace& memory, const SpeOptions& pool_options)
      : options(pool_options), ring(kQueueCapacity) {
    for (int number = 0; number < options.spes; ++number) {
      workers.push_back(std::make_unique<Worker>(number, memory, options));
    }
    for (auto& worker : workers) threads.emplace_back([this, &worker] { work(*worker); });
    watchdog = std::jthread([this] { watch(); });
  }

  ~State() {
    {
      const std::scoped_lock lock(mutex);
      stopping = true;
    }
    job_ready.notify_all();
    slot_free.notify_all();
    stop_watching.notify_all();
    threads.clear();
    if (watchdog.joinable()) watchdog.join();
    while (count != 0) finish(take(), "dropped: the pool of SPEs was closed before the job ran");
  }

  QueuedJob take() {
    const QueuedJob next = ring[head];
    head = (head + 1) % kQueueCapacity;
    --count;
    return next;
  }

  /// @pre the mutex is held, or no other thread is left.
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

  void work(Worker& worker) {
    leave_the_ppu_its_core();
    std::unique_lock lock(mutex);
    for (;;) {
      job_ready.wait(lock, [this] { return stopping || count != 0; });
      if (stopping) return;
      const QueuedJob next = take();
      const bool more = count != 0;
      const bool was_full = count + 1 == kQueueCapacity;
      worker.started = std::chrono::steady_clock::now();
      worker.busy = true;
      lock.unlock();
      if (more) job_ready.notify_one();  // each SPE wakes the next, so that submitting costs one wake-up
      if (was_full) slot_free.notify_one();
      std::string failure = worker.spe.run(next.job, next.number);
      lock.lock();
      worker.busy = false;
      worker.statistics = worker.spe.statistics();
      finish(next, std::move(failure));
    }
  }

  /// Every wait for a job ends because this loop ends the job.
  void watch() {
    const auto period = std::clamp<std::chrono::milliseconds>(
        options.deadline / 8, std::chrono::milliseconds(1), std::chrono::milliseconds(100));
    std::unique_lock lock(mutex);
    while (!stopping || std::any_of(workers.begin(), workers.end(), [](const auto& w) { return w->busy; })) {
      stop_watching.wait_for(lock, period);
      const auto now = std::chrono::steady_clock::now();
      for (auto& worker : workers) {
        if (worker->busy && now - worker->started > options.deadline) worker->spe.interrupt();
      }
    }
  }

  const SpeOptions options;
  std::vector<std::unique_ptr<Worker>> workers;

  std::mutex mutex;  // guards all below and what finish() touches
  std::condition_variable job_ready, slot_free, stop_watching;
  std::vector<QueuedJob> ring;
  std::size_t head = 0, count = 0;
  std::uint64_t submitted = 0;
  bool stopping = false;

  std::vector<std::jthread> threads;
  std::jthread watchdog;
};

SpePool::SpePool(dma::AddressSpace& memory, const SpeOptions& options) {
  if (options.spes < 1 || options.spes > dma::kSpeCount) {
    throw std::invalid_argument("the number of SPEs is " + std::to_string(options.spes) +
                                "; 1 to 6 are allowed");
  }
  if (options.deadline <= std::chrono::milliseconds::zero()) {
    throw std::invalid_argument("the deadline of a job must be positive");
  }
  state_ = std::make_unique<State>(memory, options);
}

SpePool::~SpePool() = default;

void SpePool::submit(JobBatch& batch, std::span<const Job> jobs) {
  if (jobs.empty()) return;
  std::unique_lock lock(state_->mutex);
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
  const std::scoped_lock lock(state_->mutex);
  std::vector<SpeStatistics> result;
  for (const auto& worker : state_->workers) result.push_back(worker->statistics);
  return result;
}

int SpePool::spes() const { return state_->options.spes; }

}  // namespace softcell::ls_sim
