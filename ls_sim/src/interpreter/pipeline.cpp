#include "pipeline.h"

namespace softcell::ls_sim::interpreter {
namespace {

std::uint32_t class_latency(LatencyClass latency, const TimingParameters& p) {
  switch (latency) {
    case LatencyClass::kFx2:
      return p.latency_fx2;
    case LatencyClass::kFx3:
      return p.latency_fx3;
    case LatencyClass::kFxb:
      return p.latency_fxb;
    case LatencyClass::kFp6:
      return p.latency_fp6;
    case LatencyClass::kFp7:
      return p.latency_fp7;
    case LatencyClass::kFpd:
      return p.latency_fpd;
    case LatencyClass::kShuf:
      return p.latency_shuf;
    case LatencyClass::kLs:
      return p.latency_ls;
    case LatencyClass::kBr:
      return p.latency_br;
    case LatencyClass::kSpr:
      return p.latency_spr;
    case LatencyClass::kHb:
      return p.hint_latency;
    default:
      return 1;
  }
}

bool is_special(LatencyClass latency) {
  switch (latency) {
    case LatencyClass::kFx2:
    case LatencyClass::kFx3:
    case LatencyClass::kFxb:
    case LatencyClass::kShuf:
    case LatencyClass::kSpr:
      return false;
    default:
      return true;
  }
}

}  // namespace

IssueModel::IssueModel(SpeTimer& timer, const SpuState* state)
    : timer_(timer), parameters_(timer.parameters), state_(state) {
  for (std::size_t i = 0; i < kInstructions; ++i) traits_[i] = traits_of(kInstructionTable[i]);
}

IssueModel::Traits IssueModel::traits_of(const InstructionInfo& info) const {
  return {.latency_class = info.latency,
          .is_even = is_even_pipe(info.latency),
          .reads = info.reads,
          .writes_target = info.writes_target,
          .latency = class_latency(info.latency, parameters_),
          .is_special = is_special(info.latency),
          // bisled looks at a channel, too.
          .is_channel = info.kind == Kind::kReadChannel || info.kind == Kind::kCountChannel ||
                        info.kind == Kind::kWriteChannel || info.kind == Kind::kEventJump};
}

void IssueModel::begin_run(std::uint32_t pc) {
  last_issue_ = timer_.clock.now();
  ready_ = {};
  previous_ = &nowhere_;
  expected_pc_ = pc;
  leaves_odd_pipe_ = is_interrupted_ = is_in_channel_ = is_hinted_ = is_fetching_ = false;
  blocked_until_ = 0;
  hinted_branch_ = kNowhere;
  line_ = pc / dma::kLineBytes;
  next_line_ready_ = last_issue_;
}

void IssueModel::bring_clock() {
  if (is_in_channel_) finish_channel();
  timer_.clock.advance_to(last_issue_);
}

/// What the instruction at `pc` has to wait for, besides its operands.
std::uint64_t IssueModel::arrive(std::uint32_t pc, CycleCounts& counts) {
  if (is_in_channel_) finish_channel();
  std::uint64_t earliest = last_issue_ + 1;
  if (blocked_until_ > earliest) {
    stall(counts, blocked_by_, blocked_until_ - earliest);
    earliest = blocked_until_;
  }
  const bool goes_elsewhere = pc != expected_pc_ || is_hinted_;
  if (state_ != nullptr && goes_elsewhere) {
    earliest = go_on_at(pc, earliest, counts);
  } else if (state_ != nullptr && pc / dma::kLineBytes != line_) {
    earliest = enter_next_line(pc, earliest, counts);
  }
  if (goes_elsewhere) leaves_odd_pipe_ = false;
  is_interrupted_ = is_hinted_ = false;
  line_ = pc / dma::kLineBytes;
  return earliest;
}

// ---- channels

/// The channel operation itself, which is executed next, advances the clock by its waits.
void IssueModel::start_channel(const Operation& op, const Traits& traits) {
  timer_.clock.advance_to(last_issue_);
  is_interrupted_ = is_in_channel_ = true;
  channel_target_ = traits.writes_target ? op.rt : kNoRegister;
}

/// The waits belong to the channel instruction, whose result comes later.
void IssueModel::finish_channel() {
  is_in_channel_ = false;
  const auto waits = timer_.clock.take_waits();
  const std::uint64_t now = timer_.clock.now();
  if (now <= last_issue_) return;
  previous_->cycles += now - last_issue_;
  for (std::size_t i = 0; i < kStalls; ++i) previous_->stalls[i] += waits[i];
  last_issue_ = now;
  leaves_odd_pipe_ = false;
  if (channel_target_ != kNoRegister) ready_[channel_target_] = now + parameters_.latency_spr;
}

// ---- branches, hints, and lines of instructions

/// Behind a branch, and wherever else the program does not go on with the next word. The line behind that of the target
/// comes right behind it: assumed.
std::uint64_t IssueModel::go_on_at(std::uint32_t pc, std::uint64_t earliest, CycleCounts& counts) {
  const std::uint64_t before = earliest;
  if (pc != ((last_pc_ + 4) & kInstructionMask) || !is_hinted_) ++timer_.pipeline.branches_taken;
  if (pc == expected_pc_) {
    ++timer_.pipeline.hints_used;
    earliest = std::max(earliest, hint_ready_);
    stall(counts, Stall::kHintTarget, earliest - before);
  } else {
    ++timer_.pipeline.branch_misses;
    earliest += parameters_.branch_miss + ((pc & 4) != 0 ? parameters_.branch_miss_odd : 0);
    stall(counts, Stall::kBranchMiss, earliest - before);
  }
  is_fetching_ = false;
  next_line_ready_ = earliest + 1;
  return earliest;
}

/// The next line was asked for when this one was entered.
std::uint64_t IssueModel::enter_next_line(std::uint32_t, std::uint64_t earliest, CycleCounts& counts) {
  if (is_fetching_) {  // loads and stores have left the port no cycle so far
    const std::uint64_t served = std::max(fetch_request_, last_issue_ + 1);
    next_line_ready_ = timer_.port.free_from(served) + parameters_.fetch_latency;
  }
  if (next_line_ready_ > earliest) {
    stall(counts, Stall::kFetch, next_line_ready_ - earliest);
    earliest = next_line_ready_;
  }
  is_fetching_ = true;
  fetch_request_ = earliest;
  return earliest;
}

/// The port is free for a line of instructions in a cycle without load, store and line of a transfer.
void IssueModel::fetch(std::uint64_t issue) {
  std::uint64_t cycle = std::max(fetch_request_, last_issue_);
  while (cycle < issue && (cycle == memory_cycle_ || cycle == last_memory_cycle_)) ++cycle;
  if (cycle >= issue) return;
  cycle = timer_.port.free_from(cycle);
  if (cycle >= issue) return;
  is_fetching_ = false;
  next_line_ready_ = cycle + parameters_.fetch_latency;
}

void IssueModel::hold_hint(const Operation& op, std::uint32_t pc, std::uint64_t issue) {
  if (op.mnemonic == Mnemonic::hbr && (op.rb & kFeatureBit) != 0)
    return;  // hbrp leaves the port to the fetch
  ++timer_.pipeline.hints;
  if (state_ == nullptr) return;
  const auto words_on = [](std::uint32_t from, std::int32_t words) {
    return (from + (static_cast<std::uint32_t>(words) << 2)) & kInstructionMask;
  };
  hinted_branch_ = words_on(pc, hint_distance(op));
  if (op.mnemonic == Mnemonic::hbrr) {
    hinted_target_ = words_on(pc, op.imm);
  } else if (op.mnemonic == Mnemonic::hbra) {
    hinted_target_ = words_on(0, op.imm);
  } else {
    hinted_target_ = preferred_word(state_->registers[op.ra]) & kInstructionMask;
  }
  hint_ready_ = issue + parameters_.hint_latency + 1;
  hint_executed_ = executed_;
}

/// The instruction at `pc` is the one that the hint is for.
void IssueModel::follow_hint(std::uint32_t pc) {
  if (executed_ - hint_executed_ < parameters_.hint_distance) return;
  last_pc_ = pc;
  expected_pc_ = hinted_target_;
  is_interrupted_ = is_hinted_ = true;
}

// ---- operands and units

void IssueModel::wait_for_operands(const Operation& op, const Traits& traits, std::uint64_t ready,
                                   std::uint64_t earliest, CycleCounts& counts) {
  stall(counts, Stall::kDependency, ready - earliest);
  const std::array<std::pair<int, std::uint8_t>, 4> sources{
      {{reads::kA, op.ra}, {reads::kB, op.rb}, {reads::kC, op.rc}, {reads::kT, op.rt}}};
  for (const auto& [field, reg] : sources) {
    if ((traits.reads & field) == 0 || ready_[reg] != ready) continue;
    timer_.pipeline.dependency[static_cast<std::size_t>(writer_[reg])] += ready - earliest;
    return;
  }
}

std::uint64_t IssueModel::occupy(const Operation& op, const Traits& traits, std::uint32_t pc,
                                 std::uint64_t issue, CycleCounts& counts) {
  switch (traits.latency_class) {
    case LatencyClass::kLs:
      return use_port(issue, counts);
    case LatencyClass::kFp6:
      if (issue == float_unit_taken_) {
        stall(counts, Stall::kFloatUnit, 1);
        ++issue;
      }
      return issue;
    case LatencyClass::kFp7:
      float_unit_taken_ = issue + parameters_.fp7_shares_after;
      return issue;
    case LatencyClass::kFpd:
      block(issue + parameters_.double_block + 1, Stall::kDoublePrecision);
      return issue;
    case LatencyClass::kHb:
      hold_hint(op, pc, issue);
      return issue;
    case LatencyClass::kBr:
      if (state_ == nullptr) return issue;
      if (op.mnemonic == Mnemonic::sync) {
        block(issue + parameters_.sync_refetch + 1, Stall::kSync);
      } else if (op.mnemonic == Mnemonic::dsync) {
        block(std::max(issue, memory_cycle_ + parameters_.dsync_wait) + 1, Stall::kSync);
      } else {
        ++timer_.pipeline.branches;
      }
      return issue;
    default:
      ++timer_.pipeline.nops;
      return issue;
  }
}

std::uint64_t IssueModel::use_port(std::uint64_t issue, CycleCounts& counts) {
  const std::uint64_t free = timer_.port.free_from(issue);
  stall(counts, Stall::kLocalStorePort, free - issue);
  last_memory_cycle_ = memory_cycle_;
  memory_cycle_ = free;
  return free;
}

void IssueModel::block(std::uint64_t until, Stall why) {
  is_interrupted_ = true;
  blocked_until_ = until;
  blocked_by_ = why;
}

}  // namespace softcell::ls_sim::interpreter
