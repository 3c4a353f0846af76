#pragma once
// The order of queued commands: which of them may start according to tag groups, fences and barriers. It moves no bytes and does not choose
// among those that may start.

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "softcell/base/assert.h"
#include "softcell/dma/mfc_command.h"

namespace softcell::dma {

/// A set of queue slots: bit i is slot i.
using SlotSet = std::uint16_t;

constexpr SlotSet slot_bit(int slot) {
  SC_ASSERT(slot >= 0 && slot < std::numeric_limits<SlotSet>::digits, "queue slot {}", slot);
  return static_cast<SlotSet>(1u << slot);
}

/// The SPU command queue of one MFC as a scoreboard. Each slot holds the set of slots that it waits for.
/// push() determines that set, because a command waits for earlier ones only:
///
///   plain               waits for earlier barriers of its tag, and for earlier `barrier` commands of any
///   fence               waits for every earlier command of its tag
///   barrier             as fence, and later commands of its tag wait for it
///   `barrier` command   waits for every earlier command, and every later one waits for it
///
/// putqlluc is a fence, mfceieio and mfcsync are barriers.
///
/// [CBEA, MFC command ordering] documented
class MfcQueue {
 public:
  static constexpr int kSlots = 16;  // [CBEA, MFC SPU command queue] documented

  int occupied_slots() const { return std::popcount(occupied_); }
  int free_slots() const { return kSlots - occupied_slots(); }
  bool full() const { return occupied_ == kAllSlots; }
  bool empty() const { return occupied_ == 0; }

  /// The occupied slots.
  SlotSet slots() const { return occupied_; }

  /// Puts a command into a free slot. @pre not full, tag 0..31. @return  the slot.
  int push(const MfcCommand& command) {
    SC_ASSERT(!full(), "all {} slots are occupied", kSlots);
    SC_ASSERT(command.tag < kTagCount, "tag {}; the highest is {}", command.tag, kTagCount - 1);
    const int slot = std::countr_one(occupied_);
    SlotSet& group = groups_[command.tag];
    const SlotSet before = predecessors(command, group);
    waits_for_[slot] = before;
    if (before != 0) waiting_ |= slot_bit(slot);
    issued_[slot] = next_issue_++;
    tags_[slot] = static_cast<std::uint8_t>(command.tag);
    occupied_ |= slot_bit(slot);
    group |= slot_bit(slot);
    if (command.has_barrier()) barriers_ |= slot_bit(slot);
    if (command.is_queue_barrier()) queue_barriers_ |= slot_bit(slot);
    busy_tags_ |= 1u << command.tag;
    return slot;
  }

  /// Empties the slot of a command that is complete. @pre it is occupied and waits for no other
  void complete(int slot) {
    SC_ASSERT((occupied_ & slot_bit(slot)) != 0, "slot {} is empty", slot);
    SC_ASSERT(waits_for_[slot] == 0, "slot {} still waits for slots {}", slot, waits_for_[slot]);
    const auto others = static_cast<SlotSet>(~slot_bit(slot));
    occupied_ &= others;
    barriers_ &= others;
    queue_barriers_ &= others;
    for (SlotSet rest = waiting_; rest != 0; rest &= static_cast<SlotSet>(rest - 1)) {
      const int waiter = std::countr_zero(rest);
      waits_for_[waiter] &= others;
      if (waits_for_[waiter] == 0) waiting_ &= static_cast<SlotSet>(~slot_bit(waiter));
    }
    SlotSet& group = groups_[tags_[slot]];
    group &= others;
    if (group == 0) busy_tags_ &= ~(1u << tags_[slot]);
  }

  void clear() { *this = {}; }

  /// Bit t is set while a command of tag t is queued.
  std::uint32_t busy_tags() const { return busy_tags_; }

  /// The slots of the tags in `tag_mask`.
  SlotSet slots_of(std::uint32_t tag_mask) const {
    SlotSet slots = 0;
    for (std::uint32_t rest = tag_mask & busy_tags_; rest != 0; rest &= rest - 1) {
      slots |= groups_[static_cast<std::size_t>(std::countr_zero(rest))];
    }
    return slots;
  }

  /// The slots in `slots` that wait for no other.
  SlotSet ready(SlotSet slots = kAllSlots) const {
    return static_cast<SlotSet>(slots & occupied_ & ~waiting_);
  }

  /// `slots` and all slots that must complete before them. If it is not empty, at least one slot in it is
  /// ready.
  SlotSet with_predecessors(SlotSet slots) const {
    SlotSet all = slots;
    for (SlotSet added = slots; added != 0;) {
      SlotSet before = 0;
      for (SlotSet rest = added; rest != 0; rest &= static_cast<SlotSet>(rest - 1)) {
        before |= waits_for_[std::countr_zero(rest)];
      }
      added = static_cast<SlotSet>(before & ~all);
      all |= added;
    }
    return all;
  }

  /// The slot in `slots` that was filled last, or first. @pre slots is not empty, all are occupied
  int newest(SlotSet slots) const {
    SC_ASSERT((slots & ~occupied_) == 0, "slots {}, of which {} are occupied", slots, occupied_);
    return best_of(slots, [this](int a, int b) { return issued_[a] > issued_[b]; });
  }
  int oldest(SlotSet slots) const {
    SC_ASSERT((slots & ~occupied_) == 0, "slots {}, of which {} are occupied", slots, occupied_);
    return best_of(slots, [this](int a, int b) { return issued_[a] < issued_[b]; });
  }

  std::uint32_t tag_of(int slot) const {
    SC_ASSERT((occupied_ & slot_bit(slot)) != 0, "slot {} is empty", slot);
    return tags_[slot];
  }

  static constexpr SlotSet kAllSlots = 0xFFFF;

 private:
  /// An array that is indexed by slots, which are ints.
  template <typename Value>
  class BySlot {
   public:
    Value& operator[](int slot) { return values_[static_cast<std::size_t>(slot)]; }
    const Value& operator[](int slot) const { return values_[static_cast<std::size_t>(slot)]; }

   private:
    std::array<Value, kSlots> values_{};
  };

  SlotSet predecessors(const MfcCommand& command, SlotSet group) const {
    if (command.is_queue_barrier()) return occupied_;
    const bool waits_for_group = command.has_fence() || command.has_barrier();
    return static_cast<SlotSet>((waits_for_group ? group : group & barriers_) | queue_barriers_);
  }

  template <class Better>
  static int best_of(SlotSet slots, Better better) {
    SC_ASSERT(slots != 0, "the first or last of no slots");
    int best = std::countr_zero(slots);
    for (SlotSet rest = slots; rest != 0; rest &= static_cast<SlotSet>(rest - 1)) {
      const int slot = std::countr_zero(rest);
      if (better(slot, best)) best = slot;
    }
    return best;
  }

  SlotSet occupied_ = 0;
  SlotSet waiting_ = 0;         // slots that wait for others
  SlotSet barriers_ = 0;        // within their tag
  SlotSet queue_barriers_ = 0;  // of all tags
  std::uint32_t busy_tags_ = 0;
  std::uint64_t next_issue_ = 0;
  BySlot<SlotSet> waits_for_;  // for an empty slot: 0
  BySlot<std::uint8_t> tags_;
  BySlot<std::uint64_t> issued_;
  std::array<SlotSet, kTagCount> groups_{};  // by tag
};

}  // namespace softcell::dma
