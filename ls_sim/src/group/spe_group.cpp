#include "softcell/ls_sim/spe_group.h"

#include <array>
#include <condition_variable>
#include <stdexcept>
#include <string>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/dma/local_store_bytes.h"
#include "softcell/dma/proxy_queue.h"
#include "spe_threads.h"

namespace softcell::ls_sim {
namespace {

/// Tells apart the random schedules of proxy queues from those of runs.
constexpr std::uint64_t kProxyStreams = 0x7072'6F78'7900;

/// A local store in main storage, while the object lives.
class MappedLocalStore {
 public:
  MappedLocalStore(dma::AddressSpace& memory, int spe, dma::LocalStorePort& port)
      : memory_(memory), spe_(spe) {
    memory_.map_local_store(spe_, port);
  }
  ~MappedLocalStore() { memory_.unmap_local_store(spe_); }
  MappedLocalStore(const MappedLocalStore&) = delete;
  MappedLocalStore& operator=(const MappedLocalStore&) = delete;

 private:
  dma::AddressSpace& memory_;
  int spe_;
};

/// What the PPU side has asked of an SPE, and what came of it. Guarded by the monitor's lock.
struct Orders {
  std::optional<Run> prepared, given;
  std::optional<RunResult> result;
  bool end_untold = false;  ///< to the listener
  std::condition_variable changed;
};

/// One SPE's problem state. Where the SPE may wait for what is done here, it is woken.
class Door final : public ProblemState {
 public:
  Door(SpeThreads& threads, dma::AddressSpace& memory, const SpeOptions& options, int number,
       std::function<void()> start)
      : monitor_(threads.monitor()),
        number_(number),
        spe_(threads.spe(number)),
        registers_(spe_.registers()),
        proxy_(spe_, memory, options.schedule, kProxyStreams + static_cast<std::uint64_t>(number),
               std::move(start)),
        mapped_(memory, number, spe_) {
    spe_.set_proxy(&proxy_);
  }

  std::optional<std::uint32_t> read_out_mbox() override { return look(&SpeRegisters::read_out_mbox); }
  std::optional<std::uint32_t> read_out_intr_mbox() override {
    return look(&SpeRegisters::read_out_intr_mbox);
  }
  std::optional<std::uint32_t> wait_out_mbox() override {
    return wait_for(&SpeRegisters::out_mbox, &SpeRegisters::read_out_mbox);
  }
  std::optional<std::uint32_t> wait_out_intr_mbox() override {
    return wait_for(&SpeRegisters::out_intr_mbox, &SpeRegisters::read_out_intr_mbox);
  }

  void write_in_mbox(std::uint32_t value) override {
    spe_.on_register_write(dma::SpeRegister::kInMbox, value);
  }

  std::uint32_t mbox_status() override {
    SpeMonitor::Lock lock = monitor_.lock();
    monitor_.ppu_pause(lock);
    return registers_.out_mbox.count() | registers_.in_mbox.free_slots() << 8 |
           registers_.out_intr_mbox.count() << 16;
  }

  void write_signal(int which, std::uint32_t value) override {
    check_signal(which);
    spe_.on_register_write(which == 1 ? dma::SpeRegister::kSignal1 : dma::SpeRegister::kSignal2, value);
  }

  void set_signal_mode(int which, SignalMode mode) override {
    check_signal(which);
    const SpeMonitor::Lock lock = monitor_.lock();
    registers_.signal(which).set_mode(mode);
  }

  std::optional<dma::Fault> issue_proxy(const dma::MfcCommand& command) override {
    if (auto fault = proxy_.issue(command)) {
      fault->spe = number_;
      return fault;
    }
    SpeMonitor::Lock lock = monitor_.lock();
    if (monitor_.runs(number_)) {
      registers_.proxy_issued = true;
      monitor_.wake(number_);
    } else {
      lock.unlock();
      move_proxy();
    }
    return std::nullopt;
  }

  std::uint32_t proxy_status(std::uint32_t tag_mask) override {
    pause();
    return proxy_.complete_tags(tag_mask);
  }
  std::uint32_t wait_proxy(std::uint32_t tag_mask) override { return proxy_.wait_all(tag_mask); }
  int free_proxy_slots() override {
    pause();
    return proxy_.free_slots();
  }

  void write_local_store(dma::LocalStoreAddress lsa, std::span<const std::byte> bytes) override {
    if (bytes.size() > dma::kLocalStoreBytes || lsa.value > dma::kLocalStoreBytes - bytes.size()) {
      throw std::invalid_argument(std::to_string(bytes.size()) + " bytes written to local-store address " +
                                  std::to_string(lsa.value) + " pass its end at " +
                                  std::to_string(dma::kLocalStoreBytes));
    }
    const auto size = static_cast<std::uint32_t>(bytes.size());
    spe_.on_external_write(lsa, size);
    dma::copy_to_local_store(&spe_.local_store()[lsa.value], bytes.data(), size);
  }
  std::span<std::byte> local_store() override { return spe_.local_store(); }
  dma::EffectiveAddress local_store_ea() const override { return dma::local_store_ea(number_); }

  /// The hardware's transfers need nobody's help: before the PPU side waits, or the SPE sleeps.
  void move_proxy() {
    while (proxy_.advance()) {
    }
  }

 private:
  using Read = std::optional<std::uint32_t> (SpeRegisters::*)();

  static void check_signal(int which) {
    if (which != 1 && which != 2) {
      throw std::invalid_argument("signal register " + std::to_string(which) + "; there are 1 and 2");
    }
  }

  void pause() {
    SpeMonitor::Lock lock = monitor_.lock();
    monitor_.ppu_pause(lock);
  }

  /// With the lock.
  std::optional<std::uint32_t> take(Read read) {
    const auto value = (registers_.*read)();
    if (value) monitor_.wake(number_);  // it may wait to write the next
    return value;
  }

  std::optional<std::uint32_t> look(Read read) {
    SpeMonitor::Lock lock = monitor_.lock();
    auto value = take(read);
    if (!value) monitor_.ppu_pause(lock);
    return value;
  }

  std::optional<std::uint32_t> wait_for(Mailbox<1> SpeRegisters::*mailbox, Read read) {
    move_proxy();
    SpeMonitor::Lock lock = monitor_.lock();
    monitor_.ppu_wait(lock, [&] { return !(registers_.*mailbox).empty() || !monitor_.runs(number_); });
    return take(read);
  }

  SpeMonitor& monitor_;
  int number_;
  Spe& spe_;
  SpeRegisters& registers_;  // guarded by the monitor's lock
  dma::ProxyQueue proxy_;
  MappedLocalStore mapped_;
};

}  // namespace

struct SpeGroup::State final : RunSource {
  State(dma::AddressSpace& memory, const SpeOptions& options) : threads(memory, options, *this) {
    try {
      for (int spe = 0; spe < options.spes; ++spe) {
        threads.spe(spe).set_job_images(&job_images);
        doors[index(spe)] = std::make_unique<Door>(threads, memory, options, spe, [this, spe] {
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
    // Nothing is prepared meanwhile: a proxy command with start must not begin a run of half an image.
    threads.spe(spe).load(image);
    const SpeMonitor::Lock lock = monitor().lock();
    orders[index(spe)].prepared =
        Run{.image = &image, .arguments = arguments, .number = runs_prepared++, .resident = resident};
  }

  void move_proxies() {
    for (const auto& each : doors) {
      if (each) each->move_proxy();
    }
  }

  /// With the lock. @return  false when nothing was prepared, or the SPE runs.
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
      if (std::exchange(mine.end_untold, false) && listener) {
        SC_ASSERT(mine.result.has_value(), "a run of SPE {} has ended without a result", spe);
        const RunResult result = *mine.result;
        lock.unlock();
        listener(spe, result);
        lock.lock();
      }
      if (stopping) return std::nullopt;
      if (std::exchange(threads.spe(spe).registers().proxy_issued, false)) {
        lock.unlock();
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
    orders[index(spe)].result = std::move(result);
    orders[index(spe)].end_untold = true;
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
  state_->prepare(spe, image, arguments, true);
  start(spe);
}

void SpeGroup::register_job_image(dma::EffectiveAddress ea, const KernelImage& image) {
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
