#pragma once
// The SPU's events: what has happened, which of it the program wants to know, and whether there is news.

#include <cstdint>
#include <optional>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/dma/mfc.h"

namespace softcell::ls_sim {

/// Bits of SPU_RdEventStat, SPU_WrEventMask and SPU_WrEventAck. [CBEA, SPU events] documented
namespace event {
inline constexpr std::uint32_t kTagStatus = dma::Mfc::kTagStatusEvent;  ///< TG
inline constexpr std::uint32_t kListStall = dma::Mfc::kListStallEvent;  ///< SN
inline constexpr std::uint32_t kQueueSlot = dma::Mfc::kQueueSlotEvent;  ///< QV
inline constexpr std::uint32_t kInMbox = 0x10;                ///< MB: the mailbox is no longer empty
inline constexpr std::uint32_t kDecrementer = 0x20;           ///< TM: it has passed 0
inline constexpr std::uint32_t kOutIntrMboxFree = 0x40;       ///< ME
inline constexpr std::uint32_t kOutMboxFree = 0x80;           ///< LE
inline constexpr std::uint32_t kSignal2 = 0x100;              ///< S2
inline constexpr std::uint32_t kSignal1 = 0x200;              ///< S1
inline constexpr std::uint32_t kLostReservation = 0x400;      ///< LR
inline constexpr std::uint32_t kPrivilegedAttention = 0x800;  ///< A: an operating system's, which is not here
inline constexpr std::uint32_t kMultisourceSync = 0x1000;     ///< MS
inline constexpr std::uint32_t kAll = 0x1FFB;
}  // namespace event

/// An event is pending from its edge until it is acknowledged, whether the mask has it or not. The count of
/// SPU_RdEventStat tells news: it becomes 1 when a pending event meets the mask, and reading takes it back
/// while the event stays pending. Not thread safe: guarded by the SPEs' monitor.
class EventFacility {
 public:
  std::uint32_t mask() const { return mask_; }
  std::uint32_t count() const { return news_ ? 1 : 0; }

  /// Edges of these events.
  void raise(std::uint32_t events) {
    SC_ASSERT((events & ~event::kAll) == 0, "events {}; all there are is {}", events, event::kAll);
    pending_ |= events;
    if ((events & mask_) != 0) news_ = true;
  }

  void write_mask(std::uint32_t mask) {
    mask_ = mask;
    look_again();
  }

  void acknowledge(std::uint32_t events) {
    pending_ &= ~events;
    look_again();
  }

  /// The pending events in the mask; nothing when there is no news. All of them may have been acknowledged
  /// since: then the answer is 0, the manual's phantom event.
  std::optional<std::uint32_t> read() {
    if (!std::exchange(news_, false)) return std::nullopt;
    return pending_ & mask_;
  }

  /// Sets the state at the start of a program, when these events are pending.
  void reset(std::uint32_t pending) {
    SC_ASSERT((pending & ~event::kAll) == 0, "events {}; all there are is {}", pending, event::kAll);
    pending_ = pending;
    mask_ = 0;
    news_ = false;
  }

 private:
  void look_again() {
    if ((pending_ & mask_) != 0) news_ = true;
  }

  std::uint32_t pending_ = 0;
  std::uint32_t mask_ = 0;
  bool news_ = false;
};

}  // namespace softcell::ls_sim
