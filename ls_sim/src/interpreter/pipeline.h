#pragma once
// The two pipelines of an SPU: in which cycle each instruction issues.
//
//   word 0 of a pair, for the even pipe ---\  issue together if the second needs nothing that is not there,
//   word 1 of the pair, for the odd pipe --/  else in order, each in a cycle of its own
//
// [IBM SDK tutorial, SPE pipelines; GCC spu.md] documented. The numbers are those of timing_parameters.def.

#include <algorithm>
#include <array>
#include <cstdint>

#include "instruction_set.h"
#include "spu_state.h"
#include "timing/spe_timer.h"

namespace softcell::ls_sim::interpreter {

/// Follows the instructions of a program in the order of execution: an observer of the run loop.
class IssueModel {
 public:
  /// @param timer  of the SPE; outlives this.
  /// @param state  where hints find their targets. Null: the static schedule, in which all branches are predicted and all
  ///               lines of instructions are there, as spu_timing has it. It outlives this.
  IssueModel(SpeTimer& timer, const SpuState* state);

  /// A program begins at `pc`, with all registers ready, at the time of the SPE's clock.
  void begin_run(std::uint32_t pc);
  /// The clock becomes that of the last instruction: at the end of a run, or where somebody looks at it between channel operations.
  void bring_clock();

  /// The next instruction, before it does anything. Of a channel instruction, the clock then is at its issue.
  void on_instruction(const Operation& op, std::uint32_t pc) {
    const Traits& traits = traits_[static_cast<std::size_t>(op.mnemonic)];
    CycleCounts& counts = timer_.program.at(pc);
    ++executed_;
    std::uint64_t earliest = last_issue_ + 1;
    if (__builtin_expect(is_interrupted_ || pc != expected_pc_ || pc / dma::kLineBytes != line_, 0))
      earliest = arrive(pc, counts);

    const std::uint64_t ready = std::max(
        std::max(ready_of(op.ra, traits.reads & reads::kA), ready_of(op.rb, traits.reads & reads::kB)),
        std::max(ready_of(op.rc, traits.reads & reads::kC), ready_of(op.rt, traits.reads & reads::kT)));
    std::uint64_t issue = earliest;
    if (ready > earliest) {
      wait_for_operands(op, traits, ready, earliest, counts);
      issue = ready;
    } else if (leaves_odd_pipe_ && !traits.is_even && ready <= last_issue_ && earliest == last_issue_ + 1) {
      issue = last_issue_;
    }
    if (traits.is_special) issue = occupy(op, traits, pc, issue, counts);

    const std::uint64_t pairs = issue == last_issue_ ? 1 : 0;
    previous_->pairs += pairs;
    ++counts.instructions;
    counts.cycles += issue - last_issue_;
    if (__builtin_expect(is_fetching_, 0)) fetch(issue);
    previous_ = &counts;
    was_pair_ = pairs != 0;
    last_issue_ = issue;
    leaves_odd_pipe_ = traits.is_even && (pc & 4) == 0;
    expected_pc_ = (pc + 4) & kInstructionMask;
    if (traits.writes_target) {
      ready_[op.rt] = issue + traits.latency;
      writer_[op.rt] = traits.latency_class;
    }
    if (__builtin_expect(pc == hinted_branch_, 0)) follow_hint(pc);
    if (__builtin_expect(traits.is_channel, 0)) start_channel(op, traits);
  }
  void on_load(std::uint32_t, std::uint32_t) {}
  void on_store(std::uint32_t, std::uint32_t) {}

  /// Cycles from its issue until its result may be used.
  std::uint32_t latency_of(const Operation& op) const {
    return traits_[static_cast<std::size_t>(op.mnemonic)].latency;
  }
  /// The cycle in which the last instruction issued, and whether it did so together with the one before.
  std::uint64_t last_issue() const { return last_issue_; }
  bool was_pair() const { return was_pair_; }

 private:
  /// What the pipelines make of an instruction.
  struct Traits {
    LatencyClass latency_class = LatencyClass::kNop;
    bool is_even = true;
    std::uint8_t reads = 0;
    bool writes_target = false;
    std::uint32_t latency = 1;
    bool is_special = false;  ///< it takes more than its place in a pipe
    bool is_channel = false;
  };
  static constexpr std::uint8_t kNoRegister = kSpuRegisters;  ///< always ready
  static constexpr std::uint32_t kNowhere = ~std::uint32_t{0};

  Traits traits_of(const InstructionInfo& info) const;
  std::uint64_t ready_of(std::uint8_t reg, int is_read) const {
    return ready_[is_read != 0 ? reg : kNoRegister];
  }

  std::uint64_t arrive(std::uint32_t pc, CycleCounts& counts);
  void start_channel(const Operation& op, const Traits& traits);
  void finish_channel();
  std::uint64_t go_on_at(std::uint32_t pc, std::uint64_t earliest, CycleCounts& counts);
  std::uint64_t enter_next_line(std::uint32_t pc, std::uint64_t earliest, CycleCounts& counts);
  void fetch(std::uint64_t issue);
  void wait_for_operands(const Operation& op, const Traits& traits, std::uint64_t ready,
                         std::uint64_t earliest, CycleCounts& counts);
  std::uint64_t occupy(const Operation& op, const Traits& traits, std::uint32_t pc, std::uint64_t issue,
                       CycleCounts& counts);
  std::uint64_t use_port(std::uint64_t issue, CycleCounts& counts);
  void block(std::uint64_t until, Stall why);
  void hold_hint(const Operation& op, std::uint32_t pc, std::uint64_t issue);
  void follow_hint(std::uint32_t pc);

  static void stall(CycleCounts& counts, Stall why, std::uint64_t cycles) {
    counts.stalls[static_cast<std::size_t>(why)] += cycles;
  }

  SpeTimer& timer_;
  const TimingParameters& parameters_;
  const SpuState* const state_;
  std::array<Traits, kInstructions + 1> traits_;

  CycleCounts nowhere_;  ///< before the first instruction
  CycleCounts* previous_ = &nowhere_;
  std::uint64_t executed_ = 0, last_issue_ = 0;
  std::array<std::uint64_t, kNoRegister + 1> ready_{};
  std::array<LatencyClass, kNoRegister + 1> writer_{};
  bool leaves_odd_pipe_ = false;  ///< the last instruction does, to the next
  bool was_pair_ = false;
  std::uint32_t last_pc_ = 0;      ///< of a hinted branch
  std::uint32_t expected_pc_ = 0;  ///< of the next instruction

  bool is_interrupted_ = false;  ///< the next instruction may have to wait for one of the following three
  std::uint64_t blocked_until_ = 0;
  Stall blocked_by_ = Stall::kSync;
  std::uint8_t channel_target_ = kNoRegister;
  bool is_in_channel_ = false, is_hinted_ = false;

  std::uint64_t float_unit_taken_ = 0;                      ///< cycle
  std::uint64_t memory_cycle_ = 0, last_memory_cycle_ = 0;  ///< of the last loads or stores

  // One branch hint is held.
  std::uint32_t hinted_branch_ = kNowhere, hinted_target_ = 0;
  std::uint64_t hint_ready_ = 0, hint_executed_ = 0;

  // The line in execution, and the next.
  std::uint32_t line_ = kNowhere;
  bool is_fetching_ = false;  ///< the next line waits for the port
  std::uint64_t fetch_request_ = 0, next_line_ready_ = 0;
};

}  // namespace softcell::ls_sim::interpreter
