#pragma once
// The loop over instructions.

#include <array>
#include <atomic>
#include <cstring>
#include <vector>

#include "core.h"

namespace softcell::ls_sim::interpreter {

/// The words of a local store as decoded operations. Before the loop executes one, it compares its word with the
/// local store and decodes it anew if they differ. So stores and transfers need not be reported.
class DecodedStore {
 public:
  DecodedStore() : operations_(dma::kLocalStoreBytes / 4, decode(0)) {}

  /// The operation at `pc`, as the local store has it now.
  const Operation& at(const std::byte* local_store, std::uint32_t pc) {
    Operation& known = operations_[pc / 4];
    std::uint32_t bytes;
    std::memcpy(&bytes, local_store + pc, sizeof bytes);
    const std::uint32_t word = __builtin_bswap32(bytes);
    if (__builtin_expect(word != known.word, 0)) known = decode(word);
    return known;
  }

 private:
  std::vector<Operation> operations_;
};

/// The way that execution took: its last jumps, from which the last instructions follow.
class Trail {
 public:
  static constexpr std::size_t kInstructions = 32;

  void start(std::uint32_t pc) {
    jumps_ = 0;
    start_ = pc;
  }
  void add(std::uint32_t from, std::uint32_t to) { jump_[jumps_++ % kInstructions] = {from, to}; }

  /// Addresses of the last instructions up to the one at `pc`, which is the last of them.
  std::vector<std::uint32_t> last(std::uint32_t pc) const;

 private:
  struct Jump {
    std::uint32_t from, to;
  };
  std::array<Jump, kInstructions> jump_{};
  std::uint64_t jumps_ = 0;
  std::uint32_t start_ = 0;
};

/// Takes an interrupt if there is an event and interrupts are enabled: SRR0 keeps where execution was, which goes on
/// at 0. [SPU-ISA, interrupts] documented; softcell looks for events at branches only
inline bool take_interrupt(Core& core, std::uint32_t& pc) {
  core.state.pc = pc;
  std::uint32_t events = 0;
  if (!core.surroundings.count_channel(0, events)) {
    core.end(Ending::kChannelFault);
    return false;
  }
  if (events == 0) return true;
  core.state.srr0 = pc;
  core.state.interrupts_enabled = false;
  pc = 0;
  return true;
}

/// Runs until something ends the run: Core::ending. Then state.pc is as execute() leaves it.
/// @param stop_wanted  ends the run at the next branch; another thread may set it.
/// @return  instructions executed, the last one included.
template <class Observer>
[[gnu::noinline]] std::uint64_t run_until_end(Core& core, DecodedStore& decoded, Trail& trail,
                                              const std::atomic<bool>& stop_wanted, Observer& observer) {
  std::uint64_t executed = 0;
  std::uint32_t pc = core.state.pc;
  for (;;) {
    const std::uint32_t at = core.last_pc = pc;
    const Operation& operation = decoded.at(core.local_store, at);
    ++executed;
    const Flow flow = perform(core, operation, pc, observer);
    if (flow == Flow::kNext) {
      pc = at + 4;
      if (__builtin_expect(pc <= kInstructionMask, 1)) continue;
      pc = 0;
    }
    if (flow == Flow::kEnd) break;
    if (stop_wanted.load(std::memory_order_relaxed)) {
      core.end(Ending::kInterrupted);
      break;
    }
    trail.add(at, pc);
    if constexpr (requires { observer.on_jump(at, pc); }) {
      if (__builtin_expect(!observer.on_jump(at, pc), 0)) {
        core.end(Ending::kChannelFault);
        break;
      }
    }
    if (__builtin_expect(core.state.interrupts_enabled, 0)) {
      if constexpr (HasClock<Observer>) observer.bring_clock();  // for the event of the decrementer
      if (!take_interrupt(core, pc)) break;
    }
  }
  core.state.pc = pc;
  return executed;
}

}  // namespace softcell::ls_sim::interpreter
