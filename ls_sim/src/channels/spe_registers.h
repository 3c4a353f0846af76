#pragma once
// What an SPE shares with the PPU side and other SPEs.

#include <cstdint>
#include <optional>

#include "event_facility.h"
#include "mailbox.h"
#include "signal_register.h"
#include "softcell/base/assert.h"

namespace softcell::ls_sim {

/// Guarded by the SPEs' monitor. A thread that changes it wakes the threads that may wait for the change.
/// [CBEA, mailboxes, signal notification, SPU events] documented
struct SpeRegisters {
  Mailbox<4> in_mbox;
  Mailbox<1> out_mbox, out_intr_mbox;
  SignalRegister signal1, signal2;
  EventFacility events;
  bool has_begun = false;     ///< the run has come to an operation of a channel
  bool proxy_issued = false;  ///< a proxy command came: an SPE that sleeps has to let it move

  void write_in_mbox(std::uint32_t value) {
    if (in_mbox.empty()) events.raise(event::kInMbox);
    in_mbox.write(value);
  }

  /// @param which  1 or 2.
  void write_signal(int which, std::uint32_t value) {
    SignalRegister& to = signal(which);
    if (to.count() == 0) events.raise(which == 1 ? event::kSignal1 : event::kSignal2);
    to.write(value);
  }

  std::optional<std::uint32_t> read_out_mbox() { return read(out_mbox, event::kOutMboxFree); }
  std::optional<std::uint32_t> read_out_intr_mbox() { return read(out_intr_mbox, event::kOutIntrMboxFree); }

  /// @param which  1 or 2.
  SignalRegister& signal(int which) {
    SC_ASSERT(which == 1 || which == 2, "signal register {}", which);
    return which == 1 ? signal1 : signal2;
  }

  /// At the start of a program: pending are the events of what is there to read, and none is in the mask.
  void reset_events() {
    events.reset((in_mbox.empty() ? 0 : event::kInMbox) | (signal1.count() == 0 ? 0 : event::kSignal1) |
                 (signal2.count() == 0 ? 0 : event::kSignal2));
  }

 private:
  std::optional<std::uint32_t> read(Mailbox<1>& from, std::uint32_t freed) {
    const auto value = from.read();
    if (value) events.raise(freed);
    return value;
  }
};

}  // namespace softcell::ls_sim
