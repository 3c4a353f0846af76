#pragma once
// Who has reserved which line of main storage, and every copy that must keep whole lines whole.
//
//   SPE 0   getllar  ------ reserve ------ change ------ putllc: stored, the reservation of SPE 1 is lost
//   SPE 1        getllar -- reserve ------------------------------------ putllc: failed
//
// Each SPE and each thread of the PPU side holds at most one reservation, of one line of 128 bytes. Any write
// to that line by anybody else loses it. [CBEA, atomic commands] documented

#include <cstddef>
#include <cstdint>
#include <memory>

#include "softcell/dma/addresses.h"

namespace softcell::dma {

class LocalStores;
class Reservations;

/// Told when a reservation is lost to somebody else's write: event LR. Called by the writer's thread, with
/// locks held: it must be short, and not come back to the Reservations.
class ReservationListener {
 public:
  virtual ~ReservationListener() = default;
  virtual void on_reservation_lost() = 0;
};

/// One holder's place: an MFC's, or that of a thread of the PPU side (lwarx and stwcx., with the same
/// granule). Used by one thread at a time; must not outlive its Reservations.
class ReservationHolder {
 public:
  /// @throws std::runtime_error  all kMaxHolders places are taken.
  explicit ReservationHolder(Reservations& reservations, ReservationListener* listener = nullptr);
  ~ReservationHolder();
  ReservationHolder(const ReservationHolder&) = delete;
  ReservationHolder& operator=(const ReservationHolder&) = delete;

 private:
  friend class Reservations;
  Reservations& reservations_;
  int place_ = -1;
};

/// One for each AddressSpace. Thread safe; different holders may call at the same time.
///
/// Copies of up to one line, and the line commands, are indivisible and ordered among each other, so that
/// memory may be polled by small gets. A longer copy is indivisible line by line where somebody has reserved
/// the line, and otherwise only as far as the host's memcpy is; two longer copies that overlap without any
/// order are the kernel's own race.
class Reservations {
 public:
  static constexpr int kMaxHolders = 32;

  /// @param local_stores  told of writes to local stores and registers of SPEs; null: there are none.
  explicit Reservations(LocalStores* local_stores = nullptr);
  ~Reservations();
  Reservations(const Reservations&) = delete;
  Reservations& operator=(const Reservations&) = delete;

  /// getllar: copies the line and reserves it, giving up what the holder had reserved before, of whose loss
  /// nothing is heard any more. With `bytes` of 4 or 8 it is lwarx or ldarx, which reserve the line as well.
  /// @param ea  multiple of `bytes`. @param host  its bytes. @param to  where they go.
  void load_and_reserve(ReservationHolder& holder, EffectiveAddress ea, const std::byte* host, std::byte* to,
                        std::uint32_t bytes = kLineBytes);

  /// putllc: stores 128 bytes if the holder's reservation of this very line stands, and gives the reservation
  /// up in either case. With `bytes` of 4 or 8 it is stwcx. or stdcx. @return whether it stored.
  bool store_conditional(ReservationHolder& holder, EffectiveAddress ea, std::byte* host,
                         const std::byte* from, std::uint32_t bytes = kLineBytes);

  /// putlluc: stores 128 bytes; everybody's reservation of the line is lost, the holder's own given up.
  void store_line(ReservationHolder& holder, EffectiveAddress line, std::byte* host, const std::byte* from);

  /// A get's bytes: [ea, ea + bytes) from `host` to `to`. @param bytes  1..16384.
  /// @param may_be_code  whether they may be executed at `to`: local_store_bytes.h.
  void read(ReservationHolder& holder, EffectiveAddress ea, const std::byte* host, std::byte* to,
            std::uint32_t bytes, bool may_be_code = true);

  /// A put's bytes; loses reservations of the lines it touches. The holder's own is lost too, without an
  /// event (as emulators have it; what the hardware does with a plain put of the same SPE is unconfirmed).
  void write(ReservationHolder& holder, EffectiveAddress ea, std::byte* host, const std::byte* from,
             std::uint32_t bytes);

  /// Gives up what the holder has reserved, if anything, without an event.
  void give_up(ReservationHolder& holder);

  /// Whether the holder's reservation stands.
  bool holds(const ReservationHolder& holder) const;

 private:
  friend class ReservationHolder;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::dma
