#include "softcell/dma/mfc.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>

#include "softcell/base/assert.h"
#include "softcell/dma/mfc_rules.h"
#include "text.h"

// What the SPU sees of its MFC. How queued commands come to an end is in mfc_schedule.cpp.

namespace softcell::dma {
namespace {

// Bits of MFC_RdAtomicStat. [CBEA, MFC_RdAtomicStat] documented
constexpr std::uint32_t kPutllcFailed = 1;
constexpr std::uint32_t kPutllucDone = 2;
constexpr std::uint32_t kGetllarDone = 4;

constexpr std::uint32_t kLineMask = kLineBytes - 1;

/// What sdcrz stores, in lines that a range of up to 16 KB touches.
constexpr std::byte kZeros[kMaxTransferBytes + kLineBytes]{};

constexpr std::uint32_t bytes_of_lines(const MfcCommand& command) {
  const auto begin = static_cast<std::uint32_t>(command.ea.value) & kLineMask;
  return (begin + command.size + kLineMask) & ~kLineMask;
}

/// "1", or "1 or 4": the tags of a mask.
std::string any_of_tags(std::uint32_t mask) {
  std::string text;
  for (; mask != 0; mask &= mask - 1)
    text += (text.empty() ? "" : " or ") + std::to_string(std::countr_zero(mask));
  return text;
}

std::uint64_t bytes_moved(const MfcCommand& command, std::span<const std::byte> local_store,
                          bool is_big_endian) {
  switch (command.kind()) {
    case CommandKind::kTransfer:
      return command.size;
    case CommandKind::kList: {
      std::uint64_t bytes = 0;
      for (std::uint32_t i = 0; i < command.size / kListElementBytes; ++i) {
        bytes += read_element(local_store, command, i, is_big_endian).size();
      }
      return bytes;
    }
    case CommandKind::kLine:
    case CommandKind::kQueuedLine:
      return kLineBytes;
    case CommandKind::kSignal:
      return kSignalBytes;
    case CommandKind::kCacheHint:
      return command.opcode() == MfcOpcode::sdcrz ? bytes_of_lines(command) : 0;
    default:
      return 0;
  }
}

/// Has the host fetch what is mapped of a range ahead of its use, as the hardware would.
void touch(StoragePort& port, const MfcCommand& command) {
  constexpr std::uint32_t kHostLineBytes = 64;
  constexpr int kSecondLevel = 2;
  const auto place = port.resolve(command.ea, command.size, SpeAccess::kNone);
  if (std::holds_alternative<Fault>(place)) return;
  const std::byte* const begin = std::get<StoragePlace>(place).host;
  for (std::uint32_t at = 0; at < command.size; at += kHostLineBytes)
    __builtin_prefetch(begin + at, 0, kSecondLevel);
}

}  // namespace

Mfc::Mfc(std::span<std::byte> local_store, AddressSpace& space, Schedule schedule,
         std::uint64_t stream_number, ReservationListener* listener)
    : local_store_(local_store),
      port_(local_store.data(), space, listener),
      schedule_(schedule),
      random_(schedule.seed, stream_number) {
  if (local_store.size() != kLocalStoreBytes) {
    throw std::invalid_argument("a local store of " + std::to_string(local_store.size()) +
                                " bytes; it must have " + std::to_string(kLocalStoreBytes));
  }
}

void Mfc::begin_job(std::uint64_t job_id) {
  queue_.clear();
  lists_ = stalled_ = 0;
  tag_mask_ = 0;
  request_.reset();
  stall_status_ = 0;
  atomic_status_.reset();
  events_ = 0;
  suspended_by_.reset();
  port_.release_reservation();
  random_ = RandomStream(schedule_.seed, job_id);
}

// Commands.

std::optional<Fault> Mfc::issue(const MfcCommand& command) {
  if (suspended_by_) return suspension();
  if (command.kind() == CommandKind::kSignal) {
    MfcCommand translated = command;
    translated.ea = port_.translate(command.ea);
    if (std::optional<Fault> fault = check_command(translated, port_.local_stores())) return fault;
  } else if (std::optional<Fault> fault = check_command(command, port_.local_stores())) {
    return fault;
  }
  const CommandKind kind = command.kind();
  if (kind == CommandKind::kLine) return execute_line_command(command);

  const bool at_once = schedule_.kind == Schedule::kEager && queue_.empty();
  if (at_once && kind == CommandKind::kTransfer) return transfer_at_once(command);

  auto made = transfer_of(command, kind);
  if (Fault* fault = std::get_if<Fault>(&made)) {
    fault->command = command;
    return std::move(*fault);
  }
  auto& transfer = std::get<Transfer>(made);
  if (at_once && kind != CommandKind::kList) {
    count(command, kind);
    begin_at_once(command);
    transfer.move_rest(port_);
    if (observer_ != nullptr) observer_->on_complete(commands_issued_);
    return std::nullopt;
  }
  return enqueue(command, kind, transfer);
}

std::variant<Transfer, Fault> Mfc::transfer_of(const MfcCommand& command, CommandKind kind) {
  std::byte* local = local_store_.data() + command.lsa.value;
  const auto put = [&](const std::byte* from, std::variant<StoragePlace, Fault> to,
                       std::uint32_t bytes) -> std::variant<Transfer, Fault> {
    if (auto* fault = std::get_if<Fault>(&to)) return std::move(*fault);
    return Transfer::put(from, std::get<StoragePlace>(to), bytes);
  };
  switch (kind) {
    case CommandKind::kTransfer: {
      if (command.is_put()) {
        return put(local, port_.resolve(command.ea, command.size, SpeAccess::kWrite), command.size);
      }
      auto from = port_.resolve(command.ea, command.size, SpeAccess::kRead);
      if (auto* fault = std::get_if<Fault>(&from)) return std::move(*fault);
      return Transfer::get(std::get<StoragePlace>(from), local, command.size);
    }
    case CommandKind::kQueuedLine:
      return put(local, port_.resolve_lines(command.ea, kLineBytes, SpeAccess::kWrite), kLineBytes);
    case CommandKind::kSignal:
      return put(local, port_.resolve(command.ea, kSignalBytes, SpeAccess::kWrite), kSignalBytes);
    case CommandKind::kCacheHint: {
      // Touching (sdcrt, sdcrtst) is free of faults, as the PowerPC's dcbt is.
      if (command.opcode() == MfcOpcode::sdcrt || command.opcode() == MfcOpcode::sdcrtst) {
        touch(port_, command);
        return Transfer();
      }
      const bool zeroes = command.opcode() == MfcOpcode::sdcrz;
      auto lines =
          port_.resolve_lines(command.ea, command.size, zeroes ? SpeAccess::kWrite : SpeAccess::kNone);
      if (zeroes) return put(kZeros, std::move(lines), bytes_of_lines(command));
      if (auto* fault = std::get_if<Fault>(&lines)) return std::move(*fault);
      return Transfer();
    }
    default:
      return Transfer();  // ordering moves no bytes, and a list resolves its elements one by one
  }
}

std::optional<Fault> Mfc::execute_line_command(const MfcCommand& command) {
  SC_ASSERT(command.kind() == CommandKind::kLine, "{} is no line command", name(command.opcode()));
  const MfcOpcode opcode = command.opcode();
  auto line = port_.resolve_lines(command.ea, kLineBytes,
                                  opcode == MfcOpcode::getllar ? SpeAccess::kRead : SpeAccess::kWrite);
  if (auto* fault = std::get_if<Fault>(&line)) {
    fault->command = command;
    return std::move(*fault);
  }
  const auto& place = std::get<StoragePlace>(line);
  std::byte* local = local_store_.data() + command.lsa.value;
  notify_issue(command);
  std::uint32_t status = 0;
  if (opcode == MfcOpcode::getllar) {
    ++statistics_.getllar;
    port_.load_and_reserve(place, local);
    status = kGetllarDone;
  } else if (opcode == MfcOpcode::putlluc) {
    ++statistics_.putlluc;
    port_.store_line(place, local);
    status = kPutllucDone;
  } else {
    ++statistics_.putllc;
    if (!port_.store_conditional(place, local)) {
      ++statistics_.putllc_failed;
      status = kPutllcFailed;
    }
  }
  atomic_status_ = status;
  if (observer_ != nullptr) {
    if (status == kPutllcFailed) {
      observer_->on_reservation_lost(commands_issued_);
    } else {
      observer_->on_complete(commands_issued_);
    }
  }
  pass_a_moment();
  return std::nullopt;
}

/// A get or put that meets an empty queue under the eager schedule, as nearly all do: moved before anything
/// else is made of it.
std::optional<Fault> Mfc::transfer_at_once(const MfcCommand& command) {
  SC_ASSERT(queue_.empty(), "{} overtakes {} queued commands", name(command.opcode()),
            queue_.occupied_slots());
  const bool is_put = command.is_put();
  auto resolved = port_.resolve(command.ea, command.size, is_put ? SpeAccess::kWrite : SpeAccess::kRead);
  if (auto* fault = std::get_if<Fault>(&resolved)) {
    fault->command = command;
    return std::move(*fault);
  }
  const auto& place = std::get<StoragePlace>(resolved);
  std::byte* const local = local_store_.data() + command.lsa.value;
  MfcStatistics::Traffic& traffic = is_put ? statistics_.put : statistics_.get;
  ++traffic.commands;
  traffic.bytes += command.size;
  begin_at_once(command);
  if (is_put) {
    port_.write(place, local, command.size);
  } else {
    port_.read(place, local, command.size);
  }
  if (observer_ != nullptr) observer_->on_complete(commands_issued_);
  return std::nullopt;
}

/// Counts and reports a command that passes through the queue without a wait.
void Mfc::begin_at_once(const MfcCommand& command) {
  ++statistics_.queued_commands;
  ++statistics_.occupancy_sum;
  statistics_.highest_queue_occupancy = std::max(statistics_.highest_queue_occupancy, 1);
  notify_issue(command);
}

std::optional<Fault> Mfc::enqueue(const MfcCommand& command, CommandKind kind, const Transfer& transfer) {
  if (queue_.full()) {
    ++statistics_.queue_full_stalls;
    while (queue_.full()) {
      if (!progress(MfcQueue::kAllSlots)) return stuck(MfcQueue::kAllSlots);
    }
  }
  count(command, kind);
  notify_issue(command);
  const int slot = queue_.push(command);
  SC_ASSERT((lists_ & slot_bit(slot)) == 0, "slot {} of a new command still holds a list", slot);
  QueuedCommand& queued = commands_[slot];
  queued.number = commands_issued_;
  queued.due = visits_ + kMostVisits;
  queued.started = false;
  if (queue_.occupied_slots() == 1) next_due_ = queued.due;
  if (kind == CommandKind::kList) {
    list_transfers_[slot] = ListTransfer(command);
    lists_ |= slot_bit(slot);
  } else {
    queued.transfer = transfer;
  }
  const int occupied = queue_.occupied_slots();
  ++statistics_.queued_commands;
  statistics_.occupancy_sum += static_cast<std::uint64_t>(occupied);
  statistics_.highest_queue_occupancy = std::max(statistics_.highest_queue_occupancy, occupied);

  pass_a_moment();
  if (suspended_by_) return suspension();
  return std::nullopt;
}

void Mfc::count(const MfcCommand& command, CommandKind kind) {
  switch (kind) {
    case CommandKind::kTransfer: {
      MfcStatistics::Traffic& traffic = command.is_get() ? statistics_.get : statistics_.put;
      ++traffic.commands;
      traffic.bytes += command.size;
      return;
    }
    case CommandKind::kList:
      ++(command.is_get() ? statistics_.get_list : statistics_.put_list).commands;
      return;
    case CommandKind::kQueuedLine:
      ++statistics_.putqlluc;
      return;
    case CommandKind::kSignal:
      ++statistics_.signals;
      return;
    case CommandKind::kOrdering:
      ++statistics_.ordering;
      return;
    default:
      ++statistics_.hints;
  }
}

void Mfc::notify_issue(const MfcCommand& command) {
  ++commands_issued_;
  if (observer_ != nullptr) {
    observer_->on_issue(commands_issued_, command, bytes_moved(command, local_store_, port_.is_big_endian()));
  }
}

int Mfc::free_slots() {
  pass_a_moment();
  const int answer = queue_.free_slots();
  if (answer == 0) answer_poll(MfcQueue::kAllSlots);
  return answer;
}

// Tag status.

std::optional<Fault> Mfc::write_tag_update(std::uint32_t condition) {
  if (suspended_by_) return suspension();
  if (condition > static_cast<std::uint32_t>(Condition::kAll)) {
    return Fault{.rule = Rule::kTagUpdateCondition,
                 .detail = "MFC_WrTagUpdate takes 0 (immediate), 1 (any) or 2 (all), not " +
                           std::to_string(condition)};
  }
  const auto wanted = static_cast<Condition>(condition);
  if (request_ && wanted != Condition::kImmediate) {
    return Fault{.rule = Rule::kTagUpdatePending,
                 .detail = "MFC_WrTagUpdate was written before MFC_RdTagStat was read for the last request"};
  }
  request_ = StatusRequest{wanted, tag_mask_};
  request_told_ = false;
  raise_if_met();
  return std::nullopt;
}

std::variant<std::uint32_t, Fault> Mfc::read_tag_status() {
  if (suspended_by_) return suspension();
  if (!request_) {
    return Fault{.rule = Rule::kTagStatusNotRequested,
                 .detail = "MFC_RdTagStat was read with no request open; write MFC_WrTagUpdate first"};
  }
  const StatusRequest request = *request_;
  if (request.condition == Condition::kAny && request.mask == 0) {
    return Fault{.rule = Rule::kTagMaskEmpty,
                 .detail = "MFC_RdTagStat was read for any tag of an empty MFC_WrTagMask"};
  }
  pass_a_moment();
  if (!is_met(request)) {
    ++statistics_.tag_waits;
    while (!is_met(request)) {
      const bool moved = request.condition == Condition::kAny ? progress_any_tag(request.mask)
                                                              : progress(queue_.slots_of(request.mask));
      if (!moved) return stuck(queue_.slots_of(request.mask));
    }
  }
  if (suspended_by_) return suspension();
  request_.reset();
  const std::uint32_t status = complete_tags(request.mask);
  if (request.condition == Condition::kImmediate && status != request.mask)
    answer_poll(queue_.slots_of(request.mask));
  return status;
}

int Mfc::tag_status_count() {
  if (!request_) return 0;
  pass_a_moment();
  if (is_met(*request_)) return 1;
  answer_poll(queue_.slots_of(request_->mask));
  return 0;
}

bool Mfc::is_met(const StatusRequest& request) const {
  switch (request.condition) {
    case Condition::kImmediate:
      return true;
    case Condition::kAny:
      return complete_tags(request.mask) != 0;
    case Condition::kAll:
      return complete_tags(request.mask) == request.mask;
  }
  return false;
}

void Mfc::raise_if_met() {
  if (!request_ || request_told_ || !is_met(*request_)) return;
  events_ |= kTagStatusEvent;
  request_told_ = true;
}

// Lists that stall and notify.

std::variant<std::uint32_t, Fault> Mfc::read_list_stall_status() {
  if (suspended_by_) return suspension();
  pass_a_moment();
  while (stall_status_ == 0) {
    if (progress(lists_)) continue;
    if (suspended_by_) return suspension();
    if (stalled_ == 0)
      return Fault{.rule = Rule::kListStallNotExpected,
                   .detail = "MFC_RdListStallStat was read, and no list that stalls is queued"};
    std::uint32_t tags = 0;
    for (SlotSet rest = stalled_; rest != 0; rest &= static_cast<SlotSet>(rest - 1))
      tags |= 1u << list_transfers_[std::countr_zero(rest)].command().tag;
    return Fault{.rule = Rule::kListStallNotExpected,
                 .detail = "MFC_RdListStallStat was read again, and no further list stalls before tag " +
                           any_of_tags(tags) +
                           " is written to MFC_WrListStallAck; the stall bit of a list's last element has no "
                           "effect"};
  }
  if (suspended_by_) return suspension();
  return std::exchange(stall_status_, 0);
}

int Mfc::list_stall_count() {
  pass_a_moment();
  if (stall_status_ != 0) return 1;
  answer_poll(lists_);
  return 0;
}

std::optional<Fault> Mfc::write_list_stall_ack(std::uint32_t tag) {
  if (suspended_by_) return suspension();
  const SlotSet resumed = tag < kTagCount ? queue_.slots_of(1u << tag) & stalled_ : SlotSet{0};
  if (resumed == 0) {
    return Fault{.rule = Rule::kListStallAckTag,
                 .detail = "MFC_WrListStallAck was written with tag " + std::to_string(tag) +
                           ", of which no list has stalled"};
  }
  stalled_ &= static_cast<SlotSet>(~resumed);
  for (SlotSet rest = resumed; rest != 0; rest &= static_cast<SlotSet>(rest - 1)) {
    const int slot = std::countr_zero(rest);
    list_transfers_[slot].resume();
    commands_[slot].due = visits_ + kMostVisits;
  }
  pass_a_moment();
  if (suspended_by_) return suspension();
  return std::nullopt;
}

// Atomic status.

std::variant<std::uint32_t, Fault> Mfc::read_atomic_status() {
  if (suspended_by_) return suspension();
  pass_a_moment();
  if (!atomic_status_) {
    return Fault{
        .rule = Rule::kAtomicStatusNotExpected,
        .detail =
            "MFC_RdAtomicStat was read, and no getllar, putllc or putlluc was issued since its last read"};
  }
  if (suspended_by_) return suspension();
  return *std::exchange(atomic_status_, std::nullopt);
}

int Mfc::atomic_status_count() {
  pass_a_moment();
  return atomic_status_ ? 1 : 0;
}

// Faults found while commands execute.

void Mfc::suspend(Fault fault) {
  suspended_by_ = std::move(fault);
  suspension_told_ = false;
}

Fault Mfc::suspension() {
  SC_ASSERT(suspended_by_.has_value(), "no fault of a list element, and {} commands queued",
            queue_.occupied_slots());
  suspension_told_ = true;
  return *suspended_by_;
}

std::optional<Fault> Mfc::poll_fault() {
  if (!suspended_by_ || suspension_told_) return std::nullopt;
  return suspension();
}

// Why nothing that `wanted` needs can move: a list's fault, or a list that waits for its acknowledgement.
Fault Mfc::stuck(SlotSet wanted) {
  if (suspended_by_) return suspension();
  const auto holding_up = static_cast<SlotSet>(queue_.with_predecessors(wanted) & stalled_);
  SC_ASSERT(holding_up != 0, "nothing holds up slots {}, with {} queued", wanted, queue_.slots());
  const ListTransfer& list = list_transfers_[queue_.oldest(holding_up)];
  const std::string tag = std::to_string(list.command().tag);
  return Fault{.rule = Rule::kListStalledForEver,
               .command = list.command(),
               .detail = "the list has stalled after element " + std::to_string(list.next() - 1) + " of " +
                         std::to_string(list.count()) + " (from 0); write its tag " + tag +
                         " to MFC_WrListStallAck before waiting for what it holds up"};
}

std::optional<Fault> Mfc::drain() {
  while (advance()) {
  }
  if (queue_.empty() && !suspended_by_) return std::nullopt;
  return stuck(queue_.slots());
}

}  // namespace softcell::dma
