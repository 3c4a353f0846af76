// How the commands in an MFC's queue come to an end: one by one as soon as they can (eager), as late as they
// may (lazy), or piece by piece in any order that is allowed (random).

#include <algorithm>
#include <bit>
#include <variant>

#include "softcell/base/assert.h"
#include "softcell/dma/mfc.h"

namespace softcell::dma {

// Under the random schedule: nothing, a few pieces or a whole transfer, each about as likely, while some
// commands do not move at all.
void Mfc::pass_a_moment() {
  if (queue_.empty()) return;
  if (schedule_.kind == Schedule::kEager) return run_all_that_can();
  if (schedule_.kind == Schedule::kRandom) {
    const auto moving = static_cast<SlotSet>(random_.next());
    const std::uint32_t magnitude = random_.below(8);
    for (std::uint32_t steps = random_.below(1u << magnitude); steps != 0; --steps) random_step(moving);
  }
  if (++visits_ >= next_due_) complete_overdue();
}

// Oldest first, so that what they wait for, which is older, is done by then.
void Mfc::complete_overdue() {
  const auto overdue = [this] {
    SlotSet slots = 0;
    for (SlotSet rest = movable(MfcQueue::kAllSlots); rest != 0; rest &= static_cast<SlotSet>(rest - 1)) {
      const int slot = std::countr_zero(rest);
      if (commands_[slot].due <= visits_) slots |= slot_bit(slot);
    }
    return slots;
  };
  for (SlotSet slots; (slots = overdue()) != 0;) finish(queue_.oldest(slots));

  // Commands that wait for a stalled list may be overdue and cannot complete, so the next visit looks at them again.
  next_due_ = visits_ + kMostVisits;
  for (SlotSet rest = queue_.slots() & static_cast<SlotSet>(~stalled_); rest != 0;
       rest &= static_cast<SlotSet>(rest - 1)) {
    next_due_ = std::min(next_due_, std::max(commands_[std::countr_zero(rest)].due, visits_ + 1));
  }
}

// A loop that polls must come to an end. So under the lazy schedule each poll without success completes one command after its answer. The
// random schedule lets time pass before the answer.
void Mfc::answer_poll(SlotSet wanted) {
  if (schedule_.kind == Schedule::kLazy) progress(wanted);
}

bool Mfc::advance() {
  const SlotSet able = movable(MfcQueue::kAllSlots);
  if (able == 0) return false;
  if (schedule_.kind == Schedule::kRandom) {
    random_step(able);
  } else {
    finish(queue_.newest(able));
  }
  return true;
}

void Mfc::run_all_that_can() {
  for (SlotSet able; (able = movable(MfcQueue::kAllSlots)) != 0;) finish(queue_.oldest(able));
}

// Under the random schedule others may move meanwhile, or not.
bool Mfc::progress(SlotSet wanted) {
  const SlotSet needed = queue_.with_predecessors(wanted & queue_.slots());
  if (movable(needed) == 0) return false;
  if (schedule_.kind != Schedule::kRandom) {
    finish(queue_.newest(movable(needed)));
    return true;
  }
  const auto moving = static_cast<SlotSet>(random_.next() | needed);
  const SlotSet before = movable(needed);
  while ((movable(needed) & before) == before) random_step(moving);
  return true;
}

// One tag is all that this wait needs, so the lazy schedule completes one: the newest that can be completed.
bool Mfc::progress_any_tag(std::uint32_t mask) {
  if (schedule_.kind == Schedule::kRandom) return progress(queue_.slots_of(mask));
  for (std::uint32_t left = mask; queue_.slots_of(left) != 0;) {
    const std::uint32_t tag = 1u << queue_.tag_of(queue_.newest(queue_.slots_of(left)));
    if (progress(queue_.slots_of(tag))) return true;
    left &= ~tag;
  }
  return false;
}

void Mfc::finish(int slot) {
  if ((lists_ & slot_bit(slot)) != 0) return finish_list(slot);
  SC_ASSERT((queue_.ready() & slot_bit(slot)) != 0, "the command in slot {} waits for others", slot);
  commands_[slot].transfer.move_rest(port_);
  complete(slot);
}

void Mfc::finish_list(int slot) {
  SC_ASSERT((stalled_ & slot_bit(slot)) == 0, "the list in slot {} has stalled", slot);
  ListTransfer& list = list_transfers_[slot];
  list.move_open(port_);
  while (list.can_open()) {
    if (!open_next_element(slot)) return;
    list.move_open(port_);
  }
  stall_or_complete(slot);
}

void Mfc::random_step(SlotSet moving) {
  SlotSet able = movable(moving);
  if (able == 0) return;
  for (std::uint32_t skip = random_.below(static_cast<std::uint32_t>(std::popcount(able))); skip != 0;
       --skip) {
    able &= static_cast<SlotSet>(able - 1);
  }
  const int slot = std::countr_zero(able);
  if ((lists_ & slot_bit(slot)) != 0) return random_list_step(slot);
  Transfer& transfer = commands_[slot].transfer;
  if (!std::exchange(commands_[slot].started, true)) return transfer.poison();
  if (transfer.pieces_left() != 0) transfer.move_piece(random_.below(transfer.pieces_left()), port_);
  if (transfer.pieces_left() == 0) complete(slot);
}

// Moves a piece of one of the open elements, or opens another.
void Mfc::random_list_step(int slot) {
  ListTransfer& list = list_transfers_[slot];
  const std::uint32_t open = list.open_elements();
  SC_ASSERT(open != 0 || list.can_open(), "element {} of {} cannot go on", list.next(), list.count());
  const std::uint32_t choice = random_.below(open + (list.can_open() ? 1 : 0));
  if (choice < open) {
    list.move_piece(choice, random_.below(list.pieces_left(choice)), port_);
  } else {
    if (!open_next_element(slot)) return;
    if (list.open_elements() > open) list.newest_open().poison();
  }
  stall_or_complete(slot);
}

bool Mfc::open_next_element(int slot) {
  ListTransfer& list = list_transfers_[slot];
  auto opened = list.open_next(local_store_, port_);
  if (Fault* fault = std::get_if<Fault>(&opened)) {
    suspend(std::move(*fault));
    return false;
  }
  MfcStatistics::ListTraffic& traffic = list.command().is_get() ? statistics_.get_list : statistics_.put_list;
  const auto& element = std::get<ListElement>(opened);
  ++traffic.elements;
  traffic.bytes += element.size();
  traffic.stalls += list.stalls() ? 1 : 0;
  return true;
}

void Mfc::stall_or_complete(int slot) {
  const ListTransfer& list = list_transfers_[slot];
  if (list.is_stalled()) {
    stalled_ |= slot_bit(slot);
    stall_status_ |= 1u << list.command().tag;
    events_ |= kListStallEvent;
  } else if (list.is_done()) {
    complete(slot);
  }
}

void Mfc::complete(int slot) {
  SC_ASSERT((stalled_ & slot_bit(slot)) == 0, "the list in slot {} has stalled", slot);
  if (queue_.full()) events_ |= kQueueSlotEvent;
  queue_.complete(slot);
  lists_ &= static_cast<SlotSet>(~slot_bit(slot));
  if (observer_ != nullptr) observer_->on_complete(commands_[slot].number);
  raise_if_met();
}

}  // namespace softcell::dma
