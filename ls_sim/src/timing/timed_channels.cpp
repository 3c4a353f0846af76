#include "timed_channels.h"

#include <algorithm>

namespace softcell::ls_sim {
namespace {

/// Whether it has a size and a tag to compute with, as far as its kind has them.
bool can_be_timed(const dma::MfcCommand& command) {
  switch (command.kind()) {
    case dma::CommandKind::kLine:
      return true;
    case dma::CommandKind::kQueuedLine:
    case dma::CommandKind::kSignal:
    case dma::CommandKind::kOrdering:
      return command.tag < dma::kTagCount;
    default:
      return command.tag < dma::kTagCount && command.size <= dma::kMaxTransferBytes;
  }
}

constexpr std::uint32_t kImmediate = 0, kAny = 1;  // of MFC_WrTagUpdate [CBEA] documented

}  // namespace

void TimedChannels::arrive() {
  timer_.clock.advance_to(timer_.clock.now() + cycles_per_operation_);
  order_.set_time(timer_.clock.now(), timer_.clock.now());
  if (trace_ != nullptr) trace_->set_time(nanoseconds(timer_.clock.now()));
}

bool TimedChannels::wait_until(std::uint64_t cycle, Stall why, Channel channel) {
  const std::uint64_t begin = timer_.clock.now();
  if (!timer_.clock.wait_until(cycle, why)) return false;
  if (trace_ != nullptr) {
    const TraceTime end = nanoseconds(cycle);
    trace_->on_wait(static_cast<std::uint32_t>(channel), nanoseconds(begin), end);
    trace_->set_time(end);
  }
  return true;
}

/// Somebody may have woken the SPE at a later time than its own.
void TimedChannels::wake(std::uint32_t channel) {
  if (wait_until(order_.woken_at(), Stall::kOtherChannel, static_cast<Channel>(channel)))
    ++timer_.other_waits;
}

ChannelReply TimedChannels::read(std::uint32_t channel) {
  arrive();
  ChannelReply reply = to_.read(channel);
  wake(channel);
  if (reply.fault) return reply;
  const auto which = static_cast<Channel>(channel);
  switch (which) {
    case Channel::kMfcRdTagStat:
      if (wait_until(timer_.mfc.all_complete(reply.value), Stall::kTagWait, which)) ++timer_.tag_waits;
      break;
    case Channel::kMfcRdListStallStat:
      if (wait_until(timer_.mfc.lists_stalled(reply.value), Stall::kOtherChannel, which))
        ++timer_.other_waits;
      break;
    case Channel::kMfcRdAtomicStat:
      if (wait_until(timer_.mfc.atomic_complete(), Stall::kOtherChannel, which)) ++timer_.other_waits;
      break;
    default:
      break;
  }
  return reply;
}

ChannelReply TimedChannels::write(std::uint32_t channel, std::uint32_t value) {
  switch (static_cast<Channel>(channel)) {
    case Channel::kMfcLsa:
      parameters_.lsa.value = value;
      break;
    case Channel::kMfcEah:
      parameters_.ea.value = (std::uint64_t{value} << 32) | (parameters_.ea.value & 0xFFFFFFFFu);
      break;
    case Channel::kMfcEal:
      parameters_.ea.value = (parameters_.ea.value & ~std::uint64_t{0xFFFFFFFFu}) | value;
      break;
    case Channel::kMfcSize:
      parameters_.size = value;
      break;
    case Channel::kMfcTagId:
      parameters_.tag = value;
      break;
    case Channel::kMfcCmd:
      parameters_.word = value;
      return issue(parameters_);
    case Channel::kMfcWrTagMask:
      tag_mask_ = value;
      break;
    case Channel::kMfcWrTagUpdate:
      requested_tags_ = tag_mask_;
      condition_ = value;
      break;
    default:
      break;
  }
  arrive();
  ChannelReply reply = to_.write(channel, value);
  wake(channel);
  if (!reply.fault && static_cast<Channel>(channel) == Channel::kMfcWrListStallAck &&
      value < dma::kTagCount) {
    timer_.mfc.acknowledge(value, timer_.clock.now(), local_store_, is_big_endian_);
    trace_acknowledged(value);
  }
  return reply;
}

ChannelReply TimedChannels::count(std::uint32_t channel) {
  arrive();
  ChannelReply reply = to_.count(channel);
  if (reply.fault || reply.value == 0 || static_cast<Channel>(channel) != Channel::kMfcRdTagStat)
    return reply;
  if (condition_ == kImmediate) return reply;
  const std::uint64_t complete = condition_ == kAny ? timer_.mfc.any_complete(requested_tags_)
                                                    : timer_.mfc.all_complete(requested_tags_);
  if (wait_until(complete, Stall::kTagWait, Channel::kMfcRdTagStat)) ++timer_.tag_waits;
  return reply;
}

/// The command waits for a free slot first. What it does to other SPEs, it does at its end.
ChannelReply TimedChannels::issue(const dma::MfcCommand& command) {
  arrive();
  // The command takes its slots of the bus now, so SPEs whose time is earlier must have taken theirs.
  order_.await_turn();
  if (command.kind() != dma::CommandKind::kLine &&
      wait_until(timer_.mfc.slot_free(timer_.clock.now()), Stall::kDmaQueue, Channel::kMfcCmd))
    ++timer_.queue_waits;
  const std::uint64_t now = timer_.clock.now();
  // A list is timed after the MFC has accepted it, because its elements may break a rule. Other commands are checked here.
  const bool is_list = command.kind() == dma::CommandKind::kList;
  const bool is_plausible = can_be_timed(command);
  std::uint64_t complete = now;
  if (!is_list && is_plausible) complete = timer_.mfc.issue(command, now, local_store_, is_big_endian_);
  order_.set_time(now, complete);
  ChannelReply reply = to_.issue(command);
  if (reply.fault) return reply;
  if (is_list) complete = timer_.mfc.issue(command, now, local_store_, is_big_endian_);
  if (trace_ != nullptr) trace_command(command, complete);
  return reply;
}

void TimedChannels::trace_command(const dma::MfcCommand& command, std::uint64_t complete) {
  if (complete != MfcTimer::kNotYet) {
    trace_->complete_at(trace_->last_command(), nanoseconds(complete));
  } else {
    stalled_commands_[command.tag] = trace_->last_command();
  }
}

/// The list has gone on, and perhaps to its end.
void TimedChannels::trace_acknowledged(std::uint32_t tag) {
  if (trace_ == nullptr || !stalled_commands_[tag]) return;
  const std::uint64_t complete = std::max(timer_.clock.now(), timer_.mfc.all_complete(1u << tag));
  trace_->complete_at(*stalled_commands_[tag], nanoseconds(complete));
}

bool TimedChannels::stop(std::uint32_t code, dma::LocalStoreAddress assist) {
  arrive();
  return to_.stop(code, assist);
}

}  // namespace softcell::ls_sim
