#include "softcell/dma/mfc.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <string>

#include "softcell/dma/mfc_rules.h"

namespace softcell::dma {

Mfc::Mfc(std::span<std::byte> local_store, AddressSpace& space, Schedule schedule,
         std::uint64_t stream_number, ReservationListener*)
    : local_store_(local_store),
      translation_(space),
      schedule_(schedule),
      random_(schedule.seed, stream_number) {
  if (local_store.size() != kLocalStoreBytes) {
    throw std::invalid_argument("a local store of " + std::to_string(local_store.size()) + " bytes; it has " +
                                std::to_string(kLocalStoreBytes));
  }
}

void Mfc::begin_job(std::uint64_t job_id) {
  queue_.clear();
  tag_mask_ = 0;
  request_.reset();
  random_ = RandomStream(schedule_.seed, job_id);
}

std::optional<Fault> Mfc::issue(const MfcCommand& command) {
  if (std::optional<Fault> fault = check_command(command)) return fault;
  auto resolved =
      translation_.resolve(command.ea, command.size, command.is_get() ? SpeAccess::kRead : SpeAccess::kWrite);
  if (Fault* fault = std::get_if<Fault>(&resolved)) {
    fault->command = command;
    return std::move(*fault);
  }
  Transfer transfer(command, local_store_.data(), std::get<std::byte*>(resolved));
  count(command);

  if (schedule_.kind == Schedule::kEager) {
    statistics_.highest_queue_occupancy = std::max(statistics_.highest_queue_occupancy, 1);
    transfer.move_rest();
    return std::nullopt;
  }
  if (queue_.full()) {
    ++statistics_.queue_full_stalls;
    complete_one_of(MfcQueue::kAllSlots);
  }
  transfers_[queue_.push(command)] = transfer;
  statistics_.highest_queue_occupancy =
      std::max(statistics_.highest_queue_occupancy, queue_.occupied_slots());
  pass_a_moment();
  return std::nullopt;
}

int Mfc::free_slots() {
  pass_a_moment();
  const int answer = queue_.free_slots();
  if (answer == 0) answer_poll(MfcQueue::kAllSlots);
  return answer;
}

std::optional<Fault> Mfc::write_tag_update(std::uint32_t condition) {
  if (condition > static_cast<std::uint32_t>(Condition::kAll)) {
    return Fault{
        .rule = Rule::kTagUpdateCondition,
        .detail = "condition " + std::to_string(condition) + "; 0 immediate, 1 any and 2 all are allowed"};
  }
  const auto wanted = static_cast<Condition>(condition);
  if (request_ && wanted != Condition::kImmediate) {
    return Fault{.rule = Rule::kTagUpdatePending,
                 .detail = "the answer to the request before has not been read from MFC_RdTagStat"};
  }
  request_ = StatusRequest{wanted, tag_mask_};
  return std::nullopt;
}

std::variant<std::uint32_t, Fault> Mfc::read_tag_status() {
  if (!request_) {
    return Fault{.rule = Rule::kTagStatusNotRequested,
                 .detail = "MFC_RdTagStat was read with no request open; write MFC_WrTagUpdate first"};
  }
  const StatusRequest request = *request_;
  if (request.condition == Condition::kAny && request.mask == 0) {
    return Fault{.rule = Rule::kTagMaskEmpty, .detail = "any tag of none was waited for"};
  }
  pass_a_moment();
  if (!is_met(request)) {
    ++statistics_.tag_waits;
    SlotSet wanted = queue_.slots_of(request.mask);
    if (request.condition == Condition::kAny && schedule_.kind == Schedule::kLazy) {
      // One tag is all that this wait needs.
      wanted = queue_.slots_of(1u << queue_.tag_of(queue_.newest(wanted)));
    }
    while (!is_met(request)) complete_one_of(wanted);
  }
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

std::variant<std::uint32_t, Fault> Mfc::read_list_stall_status() {
  return Fault{.rule = Rule::kListStallNotExpected, .detail = "no list that stalls is queued"};
}

int Mfc::list_stall_count() {
  pass_a_moment();
  return 0;
}

std::optional<Fault> Mfc::write_list_stall_ack(std::uint32_t tag) {
  return Fault{.rule = Rule::kListStallAckTag,
               .detail = "no list of tag " + std::to_string(tag) + " has stalled"};
}

std::variant<std::uint32_t, Fault> Mfc::read_atomic_status() {
  return Fault{.rule = Rule::kAtomicStatusNotExpected, .detail = "no atomic command came before"};
}

int Mfc::atomic_status_count() {
  pass_a_moment();
  return 0;
}

bool Mfc::advance() {
  if (queue_.empty()) return false;
  complete_one_of(MfcQueue::kAllSlots);
  return true;
}

std::optional<Fault> Mfc::drain() {
  while (advance()) {
  }
  return take_fault();
}

void Mfc::count(const MfcCommand& command) {
  MfcStatistics::Traffic& traffic = command.is_get() ? statistics_.get : statistics_.put;
  ++traffic.commands;
  traffic.bytes += command.size;
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

// Nothing, a few pieces or a whole transfer, each about as likely, while some commands do not move at all.
void Mfc::pass_a_moment() {
  if (schedule_.kind != Schedule::kRandom || queue_.empty()) return;
  const auto moving = static_cast<SlotSet>(random_.next());
  const std::uint32_t magnitude = random_.below(8);
  for (std::uint32_t steps = random_.below(1u << magnitude); steps != 0; --steps) random_step(moving);
}

// Until one of `wanted`, which are those that somebody waits for, is done. Others may move meanwhile, or not.
void Mfc::complete_one_of(SlotSet wanted) {
  if (schedule_.kind == Schedule::kLazy) {
    const int slot = queue_.newest(queue_.ready(wanted));
    transfers_[slot].move_rest();
    queue_.complete(slot);
    return;
  }
  const auto moving = static_cast<SlotSet>(random_.next() | wanted);
  const SlotSet before = queue_.slots() & wanted;
  while ((queue_.slots() & wanted) == before) random_step(moving);
}

// A loop that polls must come to an end, so under the lazy schedule every fruitless question completes one
// command, after the answer. The random schedule lets time pass before the answer.
void Mfc::answer_poll(SlotSet wanted) {
  if (schedule_.kind == Schedule::kLazy && (wanted & queue_.slots()) != 0) complete_one_of(wanted);
}

void Mfc::random_step(SlotSet moving) {
  SlotSet ready = queue_.ready(moving);
  if (ready == 0) return;
  for (std::uint32_t skip = random_.below(static_cast<std::uint32_t>(std::popcount(ready))); skip != 0;
       --skip) {
    ready &= static_cast<SlotSet>(ready - 1);
  }
  const int slot = std::countr_zero(ready);
  Transfer& transfer = transfers_[slot];
  transfer.move_piece(random_.below(transfer.pieces_left()));
  if (transfer.pieces_left() == 0) queue_.complete(slot);
}

}  // namespace softcell::dma
