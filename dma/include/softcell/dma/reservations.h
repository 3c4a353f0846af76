#pragma once
// Reservations of lines of main storage, and the copies that must respect them.
//
//   SPE 0   getllar  ------ reserve ------ change ------ putllc: stored, the reservation of SPE 1 is lost
//   SPE 1        getllar -- reserve ------------------------------------ putllc: failed
//
// Each SPE and each thread of the PPU side holds at most one reservation, of one line of 128 bytes. A write
// to that line by anybody else cancels the reservation. [CBEA, atomic commands] documented

#include <cstddef>
#include <cstdint>
#include <memory>

#include "softcell/dma/addresses.h"

namespace softcell::dma {

class LocalStores;
class Reservations;

/// Called when somebody else's write cancels a reservation: event LR. The writer's thread calls it with locks
/// held: it must be short and must not call the Reservations.
class ReservationListener {
 public:
  virtual ~ReservationListener() = default;
  virtual void on_reservation_lost() = 0;
};

/// A holder of a reservation: an MFC, or a thread of the PPU side (lwarx and stwcx., with the same granule).
/// One thread at a time uses it. It must not outlive its Reservations.
class ReservationHolder {
 public:
  /// @throws std::runtime_error  there are kMaxHolders holders already.
  explicit ReservationHolder(Reservations& reservations, ReservationListener* listener = nullptr);
  ~ReservationHolder();
  ReservationHolder(const ReservationHolder&) = delete;
  ReservationHolder& operator=(const ReservationHolder&) = delete;

 private:
  friend class Reservations;
  Reservations& reservations_;
  int place_ = -1;
};

/// The reservations of one AddressSpace. Thread safe: different holders may call at the same time. If the storage is a host program's
/// memory, all copies throw StorageLost when the program unmaps the bytes meanwhile.
///
/// Copies within one line and the line commands are atomic with respect to each other and ordered, so that
/// small gets may poll memory. A longer copy is atomic line by line if somebody has reserved the line, and
/// otherwise only as far as the host's memcpy is. If two longer copies overlap and nothing orders them, that
/// is a race of the kernel.
class Reservations {
 public:
  static constexpr int kMaxHolders = 1024;

  /// The memory that the lines belong to. Threads of a host program store to its memory without telling anybody. So there a putllc also
  /// fails if the line no longer has the bytes that getllar has read, and it stores only the quadwords that it changes. If it changes one
  /// quadword, it is atomic even against plain stores of host threads; if it changes several, only against stores before it. It never
  /// notices a store of the same bytes.
  enum class Storage : std::uint8_t { kBuffers, kHostProgram };

  /// @param local_stores  called for writes to local stores and registers of SPEs; null: there are none.
  explicit Reservations(LocalStores* local_stores = nullptr, Storage storage = Storage::kBuffers);
  ~Reservations();
  Reservations(const Reservations&) = delete;
  Reservations& operator=(const Reservations&) = delete;

  /// getllar: copies the line and reserves it. The holder's earlier reservation ends, without an event. With
  /// `bytes` 4 or 8 it is lwarx or ldarx, which reserve the whole line, too.
  /// @param ea  multiple of `bytes`. @param host  the host's address of these bytes. @param to  destination.
  void load_and_reserve(ReservationHolder& holder, EffectiveAddress ea, const std::byte* host, std::byte* to,
                        std::uint32_t bytes = kLineBytes);

  /// putllc: stores a line if the holder still has it reserved, and ends the reservation in either case. With
  /// `bytes` 4 or 8 it is stwcx. or stdcx.
  /// @return  true if it stored.
  bool store_conditional(ReservationHolder& holder, EffectiveAddress ea, std::byte* host,
                         const std::byte* from, std::uint32_t bytes = kLineBytes);

  /// putlluc: stores a line and cancels all reservations of it; the holder's own ends without an event.
  void store_line(ReservationHolder& holder, EffectiveAddress line, std::byte* host, const std::byte* from);

  /// Copies the bytes of a get, [ea, ea + bytes), from `host` to `to`. @param bytes 1..16384.
  /// @param may_be_code  true if the bytes may be instructions: see local_store_bytes.h.
  void read(ReservationHolder& holder, EffectiveAddress ea, const std::byte* host, std::byte* to,
            std::uint32_t bytes, bool may_be_code = true);

  /// Copies the bytes of a put and cancels the reservations of the lines that it touches. The holder's own
  /// ends, too, without an event (as in other emulators; what the hardware does for a plain put of the same
  /// SPE is unconfirmed).
  /// @param bytes  1..16384, or more for whole lines of sdcrz.
  void write(ReservationHolder& holder, EffectiveAddress ea, std::byte* host, const std::byte* from,
             std::uint32_t bytes);

  /// Ends the holder's reservation, if it has one, without an event.
  void release(ReservationHolder& holder);

  /// In the memory of a host program: if the line has changed since it was reserved, ends the holder's reservation and calls its listener.
  /// @throws StorageLost
  void look_for_host_stores(ReservationHolder& holder);

  /// True if the holder has a reservation whose loss only look_for_host_stores() may find.
  bool may_miss_host_stores(const ReservationHolder& holder) const;

  /// True if the holder has a reservation.
  bool holds(const ReservationHolder& holder) const;

 private:
  friend class ReservationHolder;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::dma
