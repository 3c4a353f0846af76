#pragma once
// SPE contexts, as an operating system gives them to a program: each has a local store, an MFC, mailboxes and
// signals of its own, is made and destroyed one by one, and runs while a thread of the program waits for it.
//
//   SpeContexts contexts(memory, {.spes = 256});
//   auto context = contexts.create();
//   context->load(image);
//   ContextStop stop = context->run({.argp = reinterpret_cast<std::uint64_t>(&data)});
//   while (stop.goes_on) stop = context->resume();   // it has stopped to ask for something
//
// All contexts that run do so at the same time, on threads of their own: the host's scheduler shares its
// processors among them, as the console's shares its SPEs. So a context always gets on, however many there
// are, and none waits for another's end.

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
  bool goes_on = false;  ///< resume() continues behind the stop
  /// Of a stop that calls the PPU side (0x2100 to 0x21FF): as ChannelPort::stop().
  dma::LocalStoreAddress assist = {};
  /// Where it would continue; also an address within a fault's instruction.
  dma::LocalStoreAddress next = {};
};

/// What a context's mailboxes hold, and whether it runs.
struct ContextState {
  std::uint32_t out_mbox = 0, out_intr_mbox = 0;  ///< values to be read
  std::uint32_t in_mbox_free = 0;                 ///< values that can be written
  bool runs = false;
  bool has_begun = false;  ///< the last run has come to an operation of a channel
};

/// Any thread; run() and resume() are called by one at a time.
class SpeContext {
 public:
  /// Ends a run that has stopped and could go on. @pre no thread is in a function of the context
  virtual ~SpeContext() = default;

  /// 0 and up; of a context that was destroyed, another may get the number.
  virtual int number() const = 0;

  /// Loads an image; what had stopped does not go on.
  /// @throws std::logic_error  the context runs.
  virtual void load(std::shared_ptr<const KernelImage> image) = 0;

  /// Runs the loaded image from its entry to its next stop, and waits for that.
  /// @throws std::logic_error  the context runs, or nothing was loaded.
  /// @throws std::runtime_error  the host has no thread left.
  virtual ContextStop run(const EntryArguments& arguments) = 0;

  /// Continues behind the last stop. @throws std::logic_error  the context has not stopped so.
  virtual ContextStop resume() = 0;

  /// Ends a run that has stopped and could go on; its statistics are counted then.
  /// @throws std::logic_error  the context runs.
  virtual void give_up() = 0;

  /// Ends the run in progress with the fault deadline-exceeded.
  virtual void interrupt() = 0;

  virtual ProblemState& problem_state() = 0;

  /// Sets which effective addresses mean something else to this context. @throws std::logic_error  it runs.
  virtual void set_window(dma::AddressWindow window) = 0;

  /// The state at this moment.
  virtual ContextState state() = 0;

  /// The state, for a condition of SpeContexts::wait() only.
  virtual ContextState state_in_wait() = 0;

  /// Moves all bytes of proxy commands.
  virtual void move_proxy() = 0;

  /// Waits until at least one of the tags is complete. @return  those that are.
  virtual std::uint32_t wait_any_proxy(std::uint32_t tag_mask) = 0;

  /// The fault of a proxy command that could not move its bytes; each once.
  virtual std::optional<dma::Fault> poll_proxy_fault() = 0;

  /// Statistics up to the end of the last run.
  virtual SpeStatistics statistics() = 0;
};

/// The contexts of one program. Any thread. Contexts must not outlive it.
class SpeContexts {
 public:
  /// @param options  `spes` is how many contexts there may be at a time. A deadline of zero: none.
  /// @throws std::invalid_argument  options out of range, or more contexts than `memory` has room for.
  SpeContexts(dma::AddressSpace& memory, const SpeOptions& options);
  ~SpeContexts();
  SpeContexts(const SpeContexts&) = delete;
  SpeContexts& operator=(const SpeContexts&) = delete;

  /// @return  null: all are in use.
  /// @throws std::runtime_error  the host lacks AVX2 or FMA, or memory.
  std::unique_ptr<SpeContext> create();

  /// Sleeps until `ready` returns true, which is called when a mailbox or the state of a context may have
  /// changed; it may call SpeContext::state_in_wait() and nothing else of this library.
  /// @param until  nothing: for ever.
  /// @return  the last answer of `ready`.
  bool wait(const std::function<bool()>& ready,
            std::optional<std::chrono::steady_clock::time_point> until = {});

  /// Has all waits look at their condition again, for something that they depend on besides.
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
