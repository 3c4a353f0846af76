#pragma once
// Which of the queued commands may go: tag groups, fences and barriers. No bytes here, and no choice among
// them.

#include <array>
#include <bit>
#include <cstdint>

#include "softcell/dma/mfc_command.h"

namespace softcell::dma {

/// A set of queue slots: bit i is slot i.
using SlotSet = std::uint16_t;

/// The SPU command queue of one MFC as a scoreboard: each slot holds the set of slots it waits for, which is
/// settled when it is filled, because order reaches backwards only:
///
///   plain    waits for earlier barriers of its tag
///   fence    waits for every earlier command of its tag
///   barrier  as fence, and later commands of its tag wait for it
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

  /// Fills a free slot. @pre not full, tag 0..31. @return its number.
  int push(const MfcCommand& command) {
    const int slot = std::countr_one(occupied_);
    const SlotSet bit = static_cast<SlotSet>(1u << slot);
    SlotSet& group = groups_[command.tag];
    const bool waits_for_group = command.has_fence() || command.has_barrier();
    waits_for_[slot] = waits_for_group ? group : static_cast<SlotSet>(group & barriers_);
    issued_[slot] = next_issue_++;
    tags_[slot] = static_cast<std::uint8_t>(command.tag);
    occupied_ |= bit;
    group |= bit;
    if (command.has_barrier()) barriers_ |= bit;
    busy_tags_ |= 1u << command.tag;
    return slot;
  }

  /// Empties a slot whose command is done. @pre occupied, and waiting for nothing.
  void complete(int slot) {
    const SlotSet others = static_cast<SlotSet>(~(1u << slot));
    occupied_ &= others;
    barriers_ &= others;
    for (SlotSet& slots : waits_for_) slots &= others;
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
      slots |= groups_[std::countr_zero(rest)];
    }
    return slots;
  }

  /// Those of `slots` that wait for nothing. Never empty when `slots` holds all commands of a busy tag.
  SlotSet ready(SlotSet slots = kAllSlots) const {
    SlotSet result = 0;
    for (int slot = 0; slot < kSlots; ++slot) {
      if (waits_for_[slot] == 0) result |= static_cast<SlotSet>(1u << slot);
    }
    return result & slots & occupied_;
  }

  /// The one of `slots` that was filled last. @pre not empty, all occupied.
  int newest(SlotSet slots) const {
    int newest = std::countr_zero(slots);
    for (SlotSet rest = slots; rest != 0; rest &= static_cast<SlotSet>(rest - 1)) {
      const int slot = std::countr_zero(rest);
      if (issued_[slot] > issued_[newest]) newest = slot;
    }
    return newest;
  }

  std::uint32_t tag_of(int slot) const { return tags_[slot]; }

  static constexpr SlotSet kAllSlots = 0xFFFF;

 private:
  SlotSet occupied_ = 0;
  SlotSet barriers_ = 0;
  std::uint32_t busy_tags_ = 0;
  std::uint64_t next_issue_ = 0;
  std::array<SlotSet, kSlots> waits_for_{};
  std::array<std::uint8_t, kSlots> tags_{};
  std::array<std::uint64_t, kSlots> issued_{};
  std::array<SlotSet, kTagCount> groups_{};  // by tag
};

}  // namespace softcell::dma
