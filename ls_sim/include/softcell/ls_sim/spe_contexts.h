#pragma once
// SPE contexts, as an operating system provides them to a program: each has its own local store, MFC, mailboxes and signals, is created and
// destroyed separately, and runs while a thread of the program waits for it.
//
//   SpeContexts contexts(memory, {.spes = 256});
//   auto context = contexts.create();
//   context->load(image);
//   ContextStop stop = context->run({.argp = reinterpret_cast<std::uint64_t>(&data)});
//   while (stop.goes_on) stop = context->resume();   // it has stopped to ask for something
//
// All running contexts run at the same time, on threads of their own: the host's scheduler shares its processors among them, as the
// console's shares its SPEs. So every context makes progress, however many there are, and none waits until another one ends.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>

#include "softcell/dma/address_space.h"
#include "softcell/dma/address_window.h"
#include "softcell/ls_sim/engine.h"
#include "softcell/ls_sim/image.h"
#include "softcell/ls_sim/spe_group.h"
#include "softcell/ls_sim/spe_options.h"
#include "softcell/ls_sim/statistics.h"

namespace softcell::ls_sim {

/// Why a context has stopped.
struct ContextStop {
  RunResult result;
  bool goes_on = false;  ///< resume() continues after the stop
  /// For a stop that calls the PPU side (0x2100 to 0x21FF): as ChannelPort::stop().
  dma::LocalStoreAddress assist = {};
  /// The address at which it would continue; or an address within a faulting instruction.
  dma::LocalStoreAddress next = {};
};

/// The contents of a context's mailboxes, and whether it runs.
struct ContextState {
  std::uint32_t out_mbox = 0, out_intr_mbox = 0;  ///< values to be read
  std::uint32_t in_mbox_free = 0;                 ///< values that can be written
  bool runs = false;
  bool has_begun = false;  ///< the last run has reached a channel operation
};

/// Any thread; only one at a time may call run() and resume().
class SpeContext {
 public:
  /// Ends a run that has stopped and could continue. @pre no thread is in a function of the context
  virtual ~SpeContext() = default;

  /// 0 and up; after a context is destroyed, another one may get its number.
  virtual int number() const = 0;

  /// Loads an image; a stopped run cannot continue afterwards.
  /// @throws std::logic_error  the context runs.
  virtual void load(std::shared_ptr<const KernelImage> image) = 0;

  /// Runs the loaded image from its entry to its next stop, and waits for the stop. A second run finds the local store as the first one
  /// left it, static data included.
  /// @throws std::logic_error  the context runs, or nothing was loaded.
  /// @throws std::runtime_error  the host has no thread left.
  virtual ContextStop run(const EntryArguments& arguments) = 0;

  /// Continues after the last stop. @throws std::logic_error  the context has no stop after which it could continue.
  virtual ContextStop resume() = 0;

  /// Ends a run that has stopped and could continue; its statistics are counted then.
  /// @throws std::logic_error  the context runs.
  virtual void end_run() = 0;

  /// Ends the run in progress with the fault deadline-exceeded.
  virtual void interrupt() = 0;

  virtual ProblemState& problem_state() = 0;

  /// Sets the window through which this context reaches the threads of its own group (AddressWindow); without this call it has none.
  /// @throws std::logic_error  it runs.
  virtual void set_window(dma::AddressWindow window) = 0;

  /// The state at this moment.
  virtual ContextState state() = 0;

  /// The state, for a condition of SpeContexts::wait() only.
  virtual ContextState state_in_wait() = 0;

  /// Moves all bytes of proxy commands.
  virtual void move_proxy() = 0;

  /// Waits until at least one of the tags is complete. @return  the complete tags.
  virtual std::uint32_t wait_any_proxy(std::uint32_t tag_mask) = 0;

  /// The fault of a proxy command that could not move its bytes; each once.
  virtual std::optional<dma::Fault> poll_proxy_fault() = 0;

  /// Statistics up to the end of the last run.
  virtual SpeStatistics statistics() = 0;
};

/// The contexts of one program. Any thread. Contexts must not outlive it.
class SpeContexts {
 public:
  /// @param options  `spes` is the most contexts that may exist at a time. A deadline of zero: none.
  /// @throws std::invalid_argument  options out of range, or more contexts than `memory` has room for.
  SpeContexts(dma::AddressSpace& memory, const SpeOptions& options);
  ~SpeContexts();
  SpeContexts(const SpeContexts&) = delete;
  SpeContexts& operator=(const SpeContexts&) = delete;

  /// @return  null: all are in use.
  /// @throws std::runtime_error  the host lacks AVX2 or FMA, or memory.
  std::unique_ptr<SpeContext> create();

  /// Sleeps until `ready` returns true. `ready` is called when a mailbox or the state of a context may have changed; it may call
  /// SpeContext::state_in_wait() and nothing else of this library.
  /// @param until  nothing: no time limit.
  /// @return  the last answer of `ready`.
  bool wait(const std::function<bool()>& ready,
            std::optional<std::chrono::steady_clock::time_point> until = {});

  /// Makes all waits check their condition again, for example because something else has changed.
  void wake();

  /// Whether no context runs; for a condition of wait() only.
  bool none_runs_in_wait() const;

  /// Ends all runs in progress.
  void interrupt_all();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::ls_sim
