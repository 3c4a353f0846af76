#include "softcell/ls_sim/spe_contexts.h"

#include <pthread.h>

#include <algorithm>
#include <condition_variable>
#include <csignal>
#include <stdexcept>
#include <string>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

#include "channels/cancellable_wait.h"
#include "door.h"
#include "softcell/base/assert.h"
#include "softcell/ls_sim/trace.h"

namespace softcell::ls_sim {
namespace {

const SpeOptions& checked_for_contexts(const SpeOptions& options) {
  if (options.spes < 1)
    throw std::invalid_argument("SpeOptions::spes is " + std::to_string(options.spes) +
                                "; at least 1 is needed");
  if (options.deadline < std::chrono::milliseconds::zero())
    throw std::invalid_argument("the deadline of a run is " + std::to_string(options.deadline.count()) +
                                " ms; it must be 0 or above");
  if (options.trace != nullptr && options.trace->spes() < options.spes) {
    throw std::invalid_argument("the trace has room for " + std::to_string(options.trace->spes()) +
                                " SPEs; there may be " + std::to_string(options.spes));
  }
  return options;
}

/// While the object lives, threads that are made here receive no signals but those of their own instructions
/// and the one of Engine::interrupt(): the program's handlers are not to run on a kernel's stack.
class SignalsBlocked {
 public:
  SignalsBlocked() {
    sigset_t all;
    sigfillset(&all);
    for (const int own : {SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGTRAP, SIGSYS}) sigdelset(&all, own);
    pthread_sigmask(SIG_BLOCK, &all, &before_);
  }
  ~SignalsBlocked() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
  SignalsBlocked(const SignalsBlocked&) = delete;
  SignalsBlocked& operator=(const SignalsBlocked&) = delete;

 private:
  sigset_t before_;
};

/// A number that a context may have.
struct Slot {
  bool taken = false;
  Spe* spe = nullptr;  ///< null: not there yet, or no longer
};
using Slots = std::vector<Slot>;

}  // namespace

struct SpeContexts::State {
  State(dma::AddressSpace& storage, const SpeOptions& wanted)
      : memory(storage),
        options(checked_for_contexts(wanted)),
        monitor(options, SpeMonitor::PpuSide::kOutside),
        slots(static_cast<std::size_t>(options.spes)) {
    if (options.deadline != std::chrono::milliseconds::zero()) {
      const SignalsBlocked blocked;
      watchdog = std::jthread([this] { watch(); });
    }
  }
  ~State() {
    {
      const SpeMonitor::Lock lock = monitor.lock();
      closed = true;
    }
    watchdog_wake_up.notify_one();
  }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void watch();

  dma::AddressSpace& memory;
  const SpeOptions options;
  SpeMonitor monitor;

  // Guarded by the monitor's lock:
  Slots slots;  ///< by number
  std::uint64_t made = 0;
  bool closed = false;
  std::condition_variable watchdog_wake_up;

  std::jthread watchdog;
};

void SpeContexts::State::watch() {
  const auto period = std::clamp<std::chrono::milliseconds>(
      options.deadline / 8, std::chrono::milliseconds(1), std::chrono::milliseconds(100));
  SpeMonitor::Lock lock = monitor.lock();
  while (!closed) {
    watchdog_wake_up.wait_for(lock, period);
    const auto now = std::chrono::steady_clock::now();
    for (int number = 0; number < options.spes; ++number) {
      Spe* const spe = slots[static_cast<std::size_t>(number)].spe;
      if (spe != nullptr && monitor.runs(number) && monitor.is_late(number, now, options.deadline))
        spe->interrupt(Spe::Interrupt::kLate);
    }
  }
}

namespace {

/// A number that is taken, while the object lives.
class Number {
 public:
  /// Takes the number, with the lock. @pre it is free
  Number(SpeMonitor& monitor, Slots& slots, int number) : value(number), monitor_(monitor), slots_(slots) {
    SC_ASSERT(!slot().taken, "context number {} is taken", number);
    slot().taken = true;
  }
  ~Number() {
    const SpeMonitor::Lock lock = monitor_.lock();
    SC_ASSERT(slot().taken && slot().spe == nullptr, "number {} of a context whose SPE is {} becomes free",
              value, slot().spe);
    slot() = {};
  }
  Number(const Number&) = delete;
  Number& operator=(const Number&) = delete;

  /// The SPE that the watchdog may interrupt; null: none.
  void set_spe(Spe* spe) {
    const SpeMonitor::Lock lock = monitor_.lock();
    slot().spe = spe;
  }

  const int value;

 private:
  Slot& slot() {
    SC_ASSERT(value >= 0 && static_cast<std::size_t>(value) < slots_.size(), "context number {} of {}", value,
              slots_.size());
    return slots_[static_cast<std::size_t>(value)];
  }

  SpeMonitor& monitor_;
  Slots& slots_;
};

class Context final : public SpeContext, private StopListener {
 public:
  Context(SpeMonitor& monitor, std::unique_ptr<Number> number, std::uint64_t serial,
          dma::AddressSpace& memory, const SpeOptions& options)
      : monitor_(monitor),
        serial_(serial),
        timed_(options.deadline != std::chrono::milliseconds::zero()),
        number_(std::move(number)),
        spe_(number_->value, memory, options, monitor),
        door_(monitor, spe_, memory, options, number_->value, [] {}) {
    spe_.set_stop_listener(this);
    spe_.set_clears_bss();
    number_->set_spe(&spe_);
  }

  ~Context() override {
    number_->set_spe(nullptr);
    {
      SpeMonitor::Lock lock = monitor_.lock();
      SC_ASSERT(phase_ != Phase::kRunning, "context {} is destroyed while it runs", number_->value);
      abandon(lock);
      closing_ = true;
      order_.notify_one();
    }
    if (worker_.joinable()) worker_.join();
  }

  int number() const override { return number_->value; }

  void load(std::shared_ptr<const KernelImage> image) override {
    SC_ASSERT(image != nullptr, "context {} is to load no image", number_->value);
    SpeMonitor::Lock lock = monitor_.lock();
    require_stopped();
    abandon(lock);
    lock.unlock();
    spe_.load(*image);
    image_ = std::move(image);
  }

  ContextStop run(const EntryArguments& arguments) override {
    SpeMonitor::Lock lock = monitor_.lock();
    require_stopped();
    if (image_ == nullptr) throw std::logic_error("nothing was loaded into the SPE context");
    abandon(lock);
    if (!worker_.joinable()) {
      const SignalsBlocked blocked;
      try {
        worker_ = std::jthread([this] { work(); });
      } catch (const std::system_error& error) {
        throw std::runtime_error(std::string("the host has no thread left for an SPE context: ") +
                                 error.what());
      }
    }
    const auto now = std::chrono::steady_clock::now();
    SC_ASSERT(phase_ == Phase::kIdle && !given_ && !resumed_ && !abandoned_,
              "context {} begins a run in phase {}", number_->value, phase_);
    EntryArguments given = arguments;
    given.data_as_linked = false;
    given_ = Run{.image = image_.get(),
                 .arguments = given,
                 .number = serial_ << 20 | runs_++,
                 .begin = now,
                 .resident = false};
    spe_.registers().reset_events();
    spe_.registers().has_begun = false;
    start(now);
    return wait_for_stop(lock);
  }

  ContextStop resume() override {
    SpeMonitor::Lock lock = monitor_.lock();
    if (phase_ != Phase::kStopped)
      throw std::logic_error("resume(): the SPE context has not stopped, or its stop ended the program");
    resumed_ = true;
    start(std::chrono::steady_clock::now());
    return wait_for_stop(lock);
  }

  void end_run() override {
    SpeMonitor::Lock lock = monitor_.lock();
    require_stopped();
    abandon(lock);
  }

  void interrupt() override {
    const SpeMonitor::Lock lock = monitor_.lock();
    if (phase_ == Phase::kRunning) spe_.interrupt(Spe::Interrupt::kWanted);
  }

  ProblemState& problem_state() override { return door_; }

  void set_window(dma::AddressWindow window) override {
    const SpeMonitor::Lock lock = monitor_.lock();
    require_stopped();
    spe_.set_window(std::move(window));
  }

  ContextState state() override {
    const SpeMonitor::Lock lock = monitor_.lock();
    return state_in_wait();
  }
  ContextState state_in_wait() override {
    const SpeRegisters& registers = spe_.registers();
    return {registers.out_mbox.count(), registers.out_intr_mbox.count(), registers.in_mbox.free_slots(),
            phase_ == Phase::kRunning, registers.has_begun};
  }

  void move_proxy() override { door_.move_proxy(); }
  std::uint32_t wait_any_proxy(std::uint32_t tag_mask) override { return door_.wait_any_proxy(tag_mask); }
  std::optional<dma::Fault> poll_proxy_fault() override { return door_.poll_proxy_fault(); }

  SpeStatistics statistics() override {
    const SpeMonitor::Lock lock = monitor_.lock();
    return spe_.statistics();
  }

 private:
  /// kStopped: the worker is within the run and waits to be told whether it goes on.
  enum class Phase : std::uint8_t { kIdle, kRunning, kStopped };

  void require_stopped() const {
    if (phase_ == Phase::kRunning) throw std::logic_error("the SPE context runs");
  }

  /// Starts the context, with the lock.
  void start(SpeMonitor::HostTime now) {
    SC_ASSERT(image_ != nullptr && phase_ != Phase::kRunning, "context {} starts in phase {}", number_->value,
              phase_);
    phase_ = Phase::kRunning;
    monitor_.start(number_->value, *image_, now, timed_);
    order_.notify_one();
  }

  ContextStop wait_for_stop(SpeMonitor::Lock& lock) {
    // Ends the run if this thread is cancelled while it waits.
    struct End {
      Context& context;
      SpeMonitor::Lock& lock;
      ~End() {
        if (context.phase_ != Phase::kRunning) return;
        context.spe_.interrupt(Spe::Interrupt::kWanted);
        context.stopped_.wait(lock, [&] { return context.phase_ != Phase::kRunning; });
      }
    };
    const End end{*this, lock};
    while (phase_ == Phase::kRunning) wait_once(stopped_, lock, {});
    return stop_;
  }

  /// Ends what has stopped and could go on.
  void abandon(SpeMonitor::Lock& lock) {
    if (phase_ != Phase::kStopped) return;
    abandoned_ = true;
    order_.notify_one();
    stopped_.wait(lock, [&] { return phase_ == Phase::kIdle; });
  }

  void work() {
    SpeMonitor::Lock lock = monitor_.lock();
    for (;;) {
      order_.wait(lock, [&] { return given_ || closing_; });
      if (closing_) return;
      const Run run = *std::exchange(given_, std::nullopt);
      RunResult result;
      if (monitor_.await_first_turn(lock, number_->value)) {
        lock.unlock();
        result = spe_.run(run);
        lock.lock();
      } else {
        result.fault = dma::Fault{.rule = dma::Rule::kDeadlineExceeded,
                                  .spe = number_->value,
                                  .kernel = run.image->name,
                                  .detail = "the kernel was stopped before its first instruction"};
      }
      spe_.publish_statistics();
      stop_ = {.result = std::move(result), .goes_on = false, .assist = {}, .next = spe_.position()};
      SC_ASSERT(phase_ == (abandoned_ ? Phase::kStopped : Phase::kRunning),
                "context {} ends run {} in phase {}", number_->value, run.number, phase_);
      phase_ = Phase::kIdle;
      if (!std::exchange(abandoned_, false)) monitor_.end(number_->value);
      stopped_.notify_all();
    }
  }

  bool on_stop(std::uint32_t code, dma::LocalStoreAddress assist, dma::LocalStoreAddress next) override {
    SpeMonitor::Lock lock = monitor_.lock();
    stop_ = {.result = {code, std::nullopt, {}}, .goes_on = true, .assist = assist, .next = next};
    SC_ASSERT(phase_ == Phase::kRunning && !abandoned_, "context {} stops with code {} in phase {}",
              number_->value, code, phase_);
    phase_ = Phase::kStopped;
    monitor_.end(number_->value);
    stopped_.notify_all();
    order_.wait(lock, [&] { return resumed_ || abandoned_; });
    if (abandoned_) return false;
    resumed_ = false;
    // A program that is to end learns of it at its next channel operation.
    monitor_.await_first_turn(lock, number_->value);
    return true;
  }

  SpeMonitor& monitor_;
  const std::uint64_t serial_;  ///< gives each context random schedules of its own
  const bool timed_;
  const std::unique_ptr<Number> number_;
  Spe spe_;
  Door door_;
  std::shared_ptr<const KernelImage> image_;

  // Guarded by the monitor's lock:
  Phase phase_ = Phase::kIdle;
  std::optional<Run> given_;
  std::uint64_t runs_ = 0;
  bool resumed_ = false, abandoned_ = false, closing_ = false;
  ContextStop stop_;
  std::condition_variable order_;    ///< for the worker
  std::condition_variable stopped_;  ///< for who waits for it

  std::jthread worker_;
};

}  // namespace

SpeContexts::SpeContexts(dma::AddressSpace& memory, const SpeOptions& options)
    : state_(std::make_unique<State>(memory, options)) {}

SpeContexts::~SpeContexts() = default;

std::unique_ptr<SpeContext> SpeContexts::create() {
  std::unique_ptr<Number> number;
  std::uint64_t serial = 0;
  {
    const SpeMonitor::Lock lock = state_->monitor.lock();
    const auto free = std::ranges::find_if(state_->slots, [](const Slot& slot) { return !slot.taken; });
    if (free == state_->slots.end()) return nullptr;
    number = std::make_unique<Number>(state_->monitor, state_->slots,
                                      static_cast<int>(free - state_->slots.begin()));
    serial = state_->made++;
  }
  return std::make_unique<Context>(state_->monitor, std::move(number), serial, state_->memory,
                                   state_->options);
}

bool SpeContexts::wait(const std::function<bool()>& ready,
                       std::optional<std::chrono::steady_clock::time_point> until) {
  SC_ASSERT(static_cast<bool>(ready), "wait() has no condition; there is room for {} contexts",
            state_->options.spes);
  SpeMonitor::Lock lock = state_->monitor.lock();
  return state_->monitor.ppu_wait(lock, ready, until);
}

void SpeContexts::wake() {
  const SpeMonitor::Lock lock = state_->monitor.lock();
  state_->monitor.wake_ppu();
}

bool SpeContexts::none_runs_in_wait() const {
  for (int number = 0; number < state_->options.spes; ++number) {
    if (state_->monitor.runs(number)) return false;
  }
  return true;
}

void SpeContexts::interrupt_all() {
  const SpeMonitor::Lock lock = state_->monitor.lock();
  for (int number = 0; number < state_->options.spes; ++number) {
    Spe* const spe = state_->slots[static_cast<std::size_t>(number)].spe;
    if (spe != nullptr && state_->monitor.runs(number)) spe->interrupt(Spe::Interrupt::kWanted);
  }
}

}  // namespace softcell::ls_sim
