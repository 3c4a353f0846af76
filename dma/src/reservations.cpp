#include "softcell/dma/reservations.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>

#include "indivisible_copy.h"
#include "local_stores.h"
#include "softcell/base/assert.h"
#include "softcell/dma/local_store_bytes.h"
#include "softcell/dma/mfc_command.h"

namespace softcell::dma {
namespace {

constexpr std::size_t kHostLineBytes = 64;  // apart, so that one thread's word does not slow down another's

constexpr std::uint64_t kNoLine = ~std::uint64_t{0};

constexpr std::uint64_t line_of(EffectiveAddress ea) { return ea.value & ~std::uint64_t{kLineBytes - 1}; }

constexpr bool fits_one_line(EffectiveAddress ea, std::uint32_t bytes) {
  return ea.value % kLineBytes + bytes <= kLineBytes;
}

/// What getllar and putllc, lwarx and ldarx, stwcx. and stdcx. may access.
constexpr bool is_reserving_access(EffectiveAddress ea, std::uint32_t bytes) {
  return (bytes == 4 || bytes == 8 || bytes == kLineBytes) && ea.value % bytes == 0;
}

/// Lines that a copy touches, in one word, so that a single atomic store publishes them.
class LineRange {
 public:
  LineRange() = default;
  LineRange(EffectiveAddress ea, std::uint32_t bytes)
      : LineRange(ea.value / kLineBytes << kCountBits |
                  (ea.value % kLineBytes + bytes + kLineBytes - 1) / kLineBytes) {
    SC_ASSERT(bytes <= kMaxTransferBytes + kLineBytes, "a copy of {} bytes at {}", bytes, ea);
  }
  explicit LineRange(std::uint64_t word) : word_(word) {}

  std::uint64_t word() const { return word_; }
  bool contains(std::uint64_t line) const {
    return line / kLineBytes - (word_ >> kCountBits) < (word_ & kCountMask);
  }

 private:
  static constexpr int kCountBits = 8;  // 16384 bytes touch at most 129 lines
  static constexpr std::uint64_t kCountMask = (1u << kCountBits) - 1;

  std::uint64_t word_ = 0;  // empty
};

/// Main storage is data, unless it is the local store of an SPE.
void copy_to_storage(EffectiveAddress ea, std::byte* host, const std::byte* from, std::uint32_t bytes) {
  if (LocalStores::contains(ea)) return copy_to_local_store(host, from, bytes);
  std::memmove(host, from, bytes);
}

/// Calls piece(offset, bytes) for each line that [ea, ea + bytes) touches.
template <class Piece>
void for_each_line(EffectiveAddress ea, std::uint32_t bytes, Piece&& piece) {
  for (std::uint32_t offset = 0, size; offset < bytes; offset += size) {
    const auto room = static_cast<std::uint32_t>(kLineBytes - (ea.value + offset) % kLineBytes);
    size = std::min(room, bytes - offset);
    piece(offset, size);
  }
}

}  // namespace

// Two kinds of copy meet here. Short ones take the lock of their line. Long ones take none: like Dekker's two
// processes, a long copy announces its lines and then looks for reservations, and getllar announces its
// reservation and then looks for long copies, all sequentially consistent, so that at least one sees the
// other:
//
//   long copy   announce lines --> any reservation among them?  no: one copy;  yes: line by line, locked
//   getllar     announce line  --> any long copy over it?       wait for its end, then copy the line
//
// A long copy waits for nobody while it is announced. A write copies first and loses reservations after, and
// putllc gives its own up last, so that a line is seen as reserved until all of it has arrived.
struct Reservations::State {
  struct alignas(kHostLineBytes) Lock {
    std::mutex mutex;
  };
  struct alignas(kHostLineBytes) Reservation {
    // Made by its holder, with the line's lock; lost or given up by whoever has the line's lock.
    std::atomic<std::uint64_t> line{kNoLine};
    // The holder's own: the line whose lock it must take before it can be sure that no loss is still being
    // told.
    std::uint64_t last_line = kNoLine;
    ReservationListener* listener = nullptr;
  };
  struct alignas(kHostLineBytes) LongCopy {
    std::atomic<std::uint64_t> lines{LineRange().word()};
  };

  static constexpr int kLockBits = 6;

  explicit State(LocalStores* stores) : local_stores(stores) {}
  ~State() { SC_ASSERT(places_taken == 0, "holders {} outlive their Reservations", places_taken); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// @return  whether the write went to a register, so that there is nothing to copy.
  bool announce(EffectiveAddress ea, const std::byte* from, std::uint32_t bytes) {
    return LocalStores::contains(ea) && local_stores != nullptr && local_stores->on_write(ea, from, bytes);
  }

  std::mutex& lock_of(std::uint64_t line) {
    constexpr std::uint64_t kSpread = 0x9E37'79B9'7F4A'7C15;  // 2^64 over the golden ratio: neighbours differ
    return locks[line / kLineBytes * kSpread >> (64 - kLockBits)].mutex;
  }

  int take_place(ReservationListener* listener);
  void leave_place(int place);

  void give_up(int place);
  void lose_reservations_of_others(std::uint64_t line, int writer);
  void lose_reservations(std::uint64_t line, int writer);

  bool any_reserved(LineRange lines) const;
  void wait_for_long_copies(std::uint64_t line) const;

  /// Runs whole() when nobody has reserved a line of the range and nobody can until it is done.
  /// @return  whether it ran.
  template <class Whole>
  bool copy_at_once(int place, LineRange lines, Whole&& whole) {
    std::atomic<std::uint64_t>& announced = long_copies[place].lines;
    announced.store(lines.word(), std::memory_order_seq_cst);
    const bool free = !any_reserved(lines);
    if (free) whole();
    announced.store(LineRange().word(), std::memory_order_release);
    return free;
  }

  LocalStores* const local_stores;  // null: none

  std::array<Lock, 1 << kLockBits> locks;
  std::array<Reservation, kMaxHolders> reservations;
  std::array<LongCopy, kMaxHolders> long_copies;
  std::atomic<int> places_used{0};  // below this; never falls

  std::mutex places_mutex;
  std::uint32_t places_taken = 0;  // bit p: place p; places_mutex held
};

int Reservations::State::take_place(ReservationListener* listener) {
  static_assert(kMaxHolders == 32, "one bit of places_taken each");
  const std::lock_guard lock(places_mutex);
  const int place = std::countr_one(places_taken);
  if (place == kMaxHolders) {
    throw std::runtime_error("one address space supports " + std::to_string(kMaxHolders) +
                             " holders of reservations (MFCs and Atomics), and all are in use");
  }
  places_taken |= 1u << place;
  reservations[place].listener = listener;
  places_used.store(std::max(places_used.load(std::memory_order_relaxed), place + 1));
  return place;
}

void Reservations::State::leave_place(int place) {
  give_up(place);
  const std::lock_guard lock(places_mutex);
  SC_ASSERT((places_taken >> place & 1u) != 0, "holder {} is gone already", place);
  places_taken &= ~(1u << place);
}

// With the lock of the line that was reserved last: whoever loses it to a write tells so with that lock held,
// so that the listener hears nothing of it afterwards.
void Reservations::State::give_up(int place) {
  Reservation& own = reservations[place];
  if (own.last_line == kNoLine) return;
  const std::lock_guard lock(lock_of(own.last_line));
  own.line.store(kNoLine, std::memory_order_release);
  own.last_line = kNoLine;
}

// The line's lock is held.
void Reservations::State::lose_reservations_of_others(std::uint64_t line, int writer) {
  const int end = places_used.load(std::memory_order_acquire);
  for (int place = 0; place < end; ++place) {
    Reservation& other = reservations[place];
    if (place == writer || other.line.load(std::memory_order_relaxed) != line) continue;
    other.line.store(kNoLine, std::memory_order_release);
    if (other.listener != nullptr) other.listener->on_reservation_lost();
  }
}

// The line's lock is held.
void Reservations::State::lose_reservations(std::uint64_t line, int writer) {
  lose_reservations_of_others(line, writer);
  Reservation& own = reservations[writer];
  if (own.last_line != line) return;
  own.line.store(kNoLine, std::memory_order_release);
  own.last_line = kNoLine;
}

bool Reservations::State::any_reserved(LineRange lines) const {
  const int end = places_used.load(std::memory_order_seq_cst);
  for (int place = 0; place < end; ++place) {
    if (lines.contains(reservations[place].line.load(std::memory_order_seq_cst))) return true;
  }
  return false;
}

void Reservations::State::wait_for_long_copies(std::uint64_t line) const {
  const int end = places_used.load(std::memory_order_seq_cst);
  for (int place = 0; place < end; ++place) {
    const std::atomic<std::uint64_t>& lines = long_copies[place].lines;
    while (LineRange(lines.load(std::memory_order_seq_cst)).contains(line)) std::this_thread::yield();
  }
}

ReservationHolder::ReservationHolder(Reservations& reservations, ReservationListener* listener)
    : reservations_(reservations), place_(reservations.state_->take_place(listener)) {}

ReservationHolder::~ReservationHolder() { reservations_.state_->leave_place(place_); }

Reservations::Reservations(LocalStores* local_stores) : state_(std::make_unique<State>(local_stores)) {}
Reservations::~Reservations() = default;

void Reservations::load_and_reserve(ReservationHolder& holder, EffectiveAddress ea, const std::byte* host,
                                    std::byte* to, std::uint32_t bytes) {
  SC_ASSERT(&holder.reservations_ == this, "holder {} belongs to another AddressSpace", holder.place_);
  SC_ASSERT(is_reserving_access(ea, bytes), "{} bytes at {}", bytes, ea);
  const std::uint64_t line = line_of(ea);
  State::Reservation& own = state_->reservations[holder.place_];
  if (own.last_line != line) state_->give_up(holder.place_);
  const std::lock_guard lock(state_->lock_of(line));
  own.last_line = line;
  own.line.store(line, std::memory_order_seq_cst);
  state_->wait_for_long_copies(line);
  copy_indivisibly(to, host, bytes);
}

bool Reservations::store_conditional(ReservationHolder& holder, EffectiveAddress ea, std::byte* host,
                                     const std::byte* from, std::uint32_t bytes) {
  SC_ASSERT(&holder.reservations_ == this, "holder {} belongs to another AddressSpace", holder.place_);
  SC_ASSERT(is_reserving_access(ea, bytes), "{} bytes at {}", bytes, ea);
  const std::uint64_t line = line_of(ea);
  State::Reservation& own = state_->reservations[holder.place_];
  if (own.last_line != line) {
    state_->give_up(holder.place_);
    return false;
  }
  const std::lock_guard lock(state_->lock_of(line));
  const bool stands = own.line.load(std::memory_order_relaxed) == line;
  if (stands) {
    state_->announce(ea, from, bytes);
    copy_indivisibly(host, from, bytes);
    state_->lose_reservations(line, holder.place_);
  }
  own.last_line = kNoLine;
  return stands;
}

void Reservations::store_line(ReservationHolder& holder, EffectiveAddress line, std::byte* host,
                              const std::byte* from) {
  SC_ASSERT(line.value % kLineBytes == 0, "{} is not the begin of a line", line);
  write(holder, line, host, from, kLineBytes);
}

void Reservations::read(ReservationHolder& holder, EffectiveAddress ea, const std::byte* host, std::byte* to,
                        std::uint32_t bytes, bool may_be_code) {
  SC_ASSERT(&holder.reservations_ == this, "holder {} belongs to another AddressSpace", holder.place_);
  SC_ASSERT(bytes != 0 && bytes <= kMaxTransferBytes, "a get of {} bytes at {}", bytes, ea);
  const auto whole = [&] {
    if (may_be_code) return copy_to_local_store(to, host, bytes);
    std::memmove(to, host, bytes);
  };
  if (!fits_one_line(ea, bytes) && state_->copy_at_once(holder.place_, {ea, bytes}, whole)) {
    return;
  }
  for_each_line(ea, bytes, [&](std::uint32_t offset, std::uint32_t size) {
    const std::lock_guard lock(state_->lock_of(line_of(ea + offset)));
    copy_indivisibly(to + offset, host + offset, size);
  });
}

void Reservations::write(ReservationHolder& holder, EffectiveAddress ea, std::byte* host,
                         const std::byte* from, std::uint32_t bytes) {
  SC_ASSERT(&holder.reservations_ == this, "holder {} belongs to another AddressSpace", holder.place_);
  SC_ASSERT(bytes != 0 && bytes <= kMaxTransferBytes + kLineBytes, "a put of {} bytes at {}", bytes, ea);
  if (state_->announce(ea, from, bytes)) return;
  if (!fits_one_line(ea, bytes) &&
      state_->copy_at_once(holder.place_, {ea, bytes}, [&] { copy_to_storage(ea, host, from, bytes); })) {
    return;
  }
  for_each_line(ea, bytes, [&](std::uint32_t offset, std::uint32_t size) {
    const std::uint64_t line = line_of(ea + offset);
    const std::lock_guard lock(state_->lock_of(line));
    copy_indivisibly(host + offset, from + offset, size);
    state_->lose_reservations(line, holder.place_);
  });
}

void Reservations::give_up(ReservationHolder& holder) { state_->give_up(holder.place_); }

bool Reservations::holds(const ReservationHolder& holder) const {
  return state_->reservations[holder.place_].line.load(std::memory_order_acquire) != kNoLine;
}

}  // namespace softcell::dma
