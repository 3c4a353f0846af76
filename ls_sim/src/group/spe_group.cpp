#include "softcell/ls_sim/spe_group.h"

#include <array>
#include <chrono>
#include <condition_variable>
#include <stdexcept>
#include <string>
#include <utility>

#include "door.h"
#include "softcell/base/assert.h"
#include "spe_threads.h"

namespace softcell::ls_sim {
namespace {

/// What the PPU side has asked of an SPE, and what came of it. Guarded by the monitor's lock.
struct Orders {
  std::optional<Run> prepared, given;
  std::optional<RunResult> result;
  bool is_end_to_be_told = false;  ///< a run has ended, and the listener does not know yet
  std::condition_variable changed;
};

/// Refuses programs that softcell_add_spu_kernel has not built: where their main is, and how much stack it takes, is not known.
void require_kernel(const KernelImage& image, const char* what) {
  if (image.main != 0) return;
  throw std::invalid_argument(image.name + " was not built by softcell_add_spu_kernel, as " + what +
                              " must be");
}

}  // namespace

struct SpeGroup::State final : RunSource {
  State(dma::AddressSpace& memory, const SpeOptions& options) : threads(memory, options, *this) {
    try {
      for (int spe = 0; spe < options.spes; ++spe) {
        threads.spe(spe).set_job_images(&job_images);
        doors[index(spe)] =
            std::make_unique<Door>(threads.monitor(), threads.spe(spe), memory, options, spe, [this, spe] {
              const SpeMonitor::Lock lock = monitor().lock();
              start_prepared(spe);
            });
      }
    } catch (...) {
      close();
      throw;
    }
  }

  ~State() override { close(); }

  void close() {
    {
      const SpeMonitor::Lock lock = monitor().lock();
      stopping = true;
      threads.stop_runs();
      for (Orders& each : orders) each.changed.notify_one();
    }
    threads.join();
  }

  static std::size_t index(int spe) {
    SC_ASSERT(spe >= 0 && spe < dma::kSpeCount, "SPE {} of {}", spe, dma::kSpeCount);
    return static_cast<std::size_t>(spe);
  }
  SpeMonitor& monitor() { return threads.monitor(); }

  Door& door(int spe) {
    if (spe < 0 || spe >= threads.spes()) {
      throw std::invalid_argument("SPE " + std::to_string(spe) + "; this group has " +
                                  std::to_string(threads.spes()));
    }
    return *doors[index(spe)];
  }

  void prepare(int spe, const KernelImage& image, const EntryArguments& arguments, bool resident) {
    door(spe);
    {
      const SpeMonitor::Lock lock = monitor().lock();
      if (monitor().runs(spe)) {
        throw std::logic_error("SPE " + std::to_string(spe) + " still runs; wait for its end first");
      }
      orders[index(spe)].prepared.reset();
    }
    // No run is prepared while the image is loaded, so that a proxy command with start cannot begin a run of half an image.
    threads.spe(spe).load(image);
    doors[index(spe)]->set_big_endian(image.machine == Machine::kSpu);
    const SpeMonitor::Lock lock = monitor().lock();
    orders[index(spe)].prepared =
        Run{.image = &image, .arguments = arguments, .number = runs_prepared++, .resident = resident};
  }

  void move_proxies() {
    for (const auto& each : doors) {
      if (each) each->move_proxy();
    }
  }

  /// Starts the prepared run, with the lock. @return  false when nothing was prepared, or the SPE runs.
  bool start_prepared(int spe) {
    Orders& mine = orders[index(spe)];
    if (!mine.prepared || monitor().runs(spe)) return false;
    SC_ASSERT(!mine.given, "SPE {} starts a run before it has taken the last, of {}", spe,
              mine.given->image->name);
    mine.given = std::exchange(mine.prepared, std::nullopt);
    mine.given->begin = std::chrono::steady_clock::now();
    mine.result.reset();
    threads.spe(spe).registers().reset_events();
    monitor().start(spe, *mine.given->image, mine.given->begin, !mine.given->resident);
    mine.changed.notify_one();
    return true;
  }

  std::optional<Run> next_run(int spe, SpeMonitor::Lock& lock) override {
    Orders& mine = orders[index(spe)];
    for (;;) {
      if (std::exchange(mine.is_end_to_be_told, false) && listener) {
        SC_ASSERT(mine.result.has_value(), "a run of SPE {} has ended without a result", spe);
        const RunResult result = *mine.result;
        lock.unlock();
        listener(spe, result);
        lock.lock();
      }
      if (stopping) return std::nullopt;
      if (std::exchange(threads.spe(spe).registers().proxy_issued, false)) {
        lock.unlock();
        SC_ASSERT(doors[index(spe)] != nullptr, "SPE {} has a proxy command and no door", spe);
        doors[index(spe)]->move_proxy();  // issued just before a run ended
        lock.lock();
      } else if (mine.given) {
        return std::exchange(mine.given, std::nullopt);
      } else {
        mine.changed.wait(lock);
      }
    }
  }

  void on_ended(int spe, const Run&, RunResult&& result) override {
    SC_ASSERT(!orders[index(spe)].is_end_to_be_told,
              "SPE {} ends a run, and the listener does not know of the end of the last", spe);
    orders[index(spe)].result = std::move(result);
    orders[index(spe)].is_end_to_be_told = true;
  }

  // Guarded by the monitor's lock:
  bool stopping = false;
  std::uint64_t runs_prepared = 0;
  std::array<Orders, dma::kSpeCount> orders;
  JobImages job_images;

  std::function<void(int, const RunResult&)> listener;  // as set before the first start

  SpeThreads threads;
  std::array<std::unique_ptr<Door>, dma::kSpeCount> doors;
};

SpeGroup::SpeGroup(dma::AddressSpace& memory, const SpeOptions& options)
    : state_(std::make_unique<State>(memory, options)) {}

SpeGroup::~SpeGroup() = default;

int SpeGroup::spes() const { return state_->threads.spes(); }

void SpeGroup::prepare(int spe, const KernelImage& image, const EntryArguments& arguments) {
  state_->prepare(spe, image, arguments, false);
}

void SpeGroup::start_resident(int spe, const KernelImage& image, const EntryArguments& arguments) {
  require_kernel(image, "a resident kernel");
  state_->prepare(spe, image, arguments, true);
  start(spe);
}

void SpeGroup::register_job_image(dma::EffectiveAddress ea, const KernelImage& image) {
  require_kernel(image, "a job");
  const SpeMonitor::Lock lock = state_->monitor().lock();
  SC_ASSERT(dma::is_effective_address(ea.value) && ea.value % dma::kQuadwordBytes == 0,
            "the job image {} lies at {}, which no DMA can fetch", image.name, ea);
  state_->job_images[ea.value] = &image;
  for (int spe = 0; spe < spes(); ++spe) state_->threads.spe(spe).announce_job_image(image);
}

void SpeGroup::on_end(std::function<void(int, const RunResult&)> listener) {
  SC_ASSERT(state_->runs_prepared == 0, "on_end() after {} runs were prepared", state_->runs_prepared);
  state_->listener = std::move(listener);
}

void SpeGroup::start(int spe) {
  state_->door(spe);
  const SpeMonitor::Lock lock = state_->monitor().lock();
  if (state_->start_prepared(spe)) return;
  throw std::logic_error("SPE " + std::to_string(spe) +
                         (state_->monitor().runs(spe) ? " runs already" : " has nothing prepared to run"));
}

RunResult SpeGroup::wait(int spe) {
  state_->door(spe);
  state_->move_proxies();
  SpeMonitor::Lock lock = state_->monitor().lock();
  state_->monitor().ppu_wait(lock, [&] { return !state_->monitor().runs(spe); });
  const std::optional<RunResult>& result = state_->orders[State::index(spe)].result;
  if (!result) throw std::logic_error("SPE " + std::to_string(spe) + " was never started");
  return *result;
}

void SpeGroup::stop_runs() {
  const SpeMonitor::Lock lock = state_->monitor().lock();
  state_->threads.stop_runs();
}

void SpeGroup::wait_until_idle() {
  state_->move_proxies();
  SpeMonitor::Lock lock = state_->monitor().lock();
  state_->monitor().ppu_wait_until_idle(lock);
}

ProblemState& SpeGroup::problem_state(int spe) { return state_->door(spe); }

SpeStatistics SpeGroup::statistics(int spe) const {
  state_->door(spe);
  const SpeMonitor::Lock lock = state_->monitor().lock();
  return state_->threads.statistics(spe);
}

SpeGroup::Outside::Outside(SpeGroup& group) : group_(group) {
  const SpeMonitor::Lock lock = group_.state_->monitor().lock();
  group_.state_->monitor().change_outside(1);
}

SpeGroup::Outside::~Outside() {
  const SpeMonitor::Lock lock = group_.state_->monitor().lock();
  group_.state_->monitor().change_outside(-1);
}

}  // namespace softcell::ls_sim
