#include "softcell/dma/reservations.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bitset>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "host_access.h"
#include "indivisible_copy.h"
#include "local_stores.h"
#include "softcell/base/assert.h"
#include "softcell/dma/fault.h"
#include "softcell/dma/local_store_bytes.h"
#include "softcell/dma/mfc_command.h"
#include "text.h"

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
    // The holder sets it under the line's lock. Any thread that has this lock may clear it: it is lost or given up.
    std::atomic<std::uint64_t> line{kNoLine};
    // For the holder alone: the line whose lock it must take to be sure that the listener is not just being told
    // of a loss.
    std::uint64_t last_line = kNoLine;
    ReservationListener* listener = nullptr;
  };
  struct alignas(kHostLineBytes) LongCopy {
    std::atomic<std::uint64_t> lines{LineRange().word()};
  };

  static constexpr int kLockBits = 6;

  State(LocalStores* stores, Storage storage)
      : local_stores(stores), seen(storage == Storage::kHostProgram ? kMaxHolders : 0) {}
  ~State() { SC_ASSERT(places_taken.none(), "{} holders outlive their Reservations", places_taken.count()); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  /// @return  whether the write went to a register, so that there is nothing to copy.
  bool announce(EffectiveAddress ea, const std::byte* from, std::uint32_t bytes) {
    return is_local_store(ea) && local_stores->on_write(ea, from, bytes);
  }

  bool is_local_store(EffectiveAddress ea) const {
    return local_stores != nullptr && local_stores->contains(ea);
  }

  bool is_host_program() const { return !seen.empty(); }

  /// Runs copy(), which accesses the storage and does nothing else.
  template <class Copy>
  void access(Copy&& copy) const {
    if (!is_host_program()) return copy();
    std::uint64_t lost = 0;
    if (access_guarded(copy, lost)) return;
    throw StorageLost(
        Fault{.rule = Rule::kEaNotMapped,
              .detail = "the program has unmapped " + hex(lost) + " while the bytes were moving"});
  }

  /// Main storage is data, unless it is the local store of an SPE.
  void copy_to_storage(EffectiveAddress ea, std::byte* host, const std::byte* from,
                       std::uint32_t bytes) const {
    access([&] {
      if (is_local_store(ea)) return copy_to_local_store(host, from, bytes);
      std::memmove(host, from, bytes);
    });
  }

  bool store_line_as_seen(int place, std::byte* host, const std::byte* from) const;

  std::mutex& lock_of(std::uint64_t line) {
    constexpr std::uint64_t kSpread = 0x9E37'79B9'7F4A'7C15;  // 2^64 over the golden ratio: neighbours differ
    return locks[line / kLineBytes * kSpread >> (64 - kLockBits)].mutex;
  }

  int take_place(ReservationListener* listener);
  void leave_place(int place);

  void release(int place);
  void lose_reservations_of_others(std::uint64_t line, int writer);
  void lose_reservations(std::uint64_t line, int writer);

  bool any_reserved(LineRange lines) const;
  void wait_for_long_copies(std::uint64_t line) const;

  /// Runs whole() if no line of the range is reserved. No line of it can be reserved until whole() has returned.
  /// @return  whether it ran.
  template <class Whole>
  bool copy_at_once(int place, LineRange lines, Whole&& whole) {
    struct Announcement {
      std::atomic<std::uint64_t>& lines;
      ~Announcement() { lines.store(LineRange().word(), std::memory_order_release); }
    };
    const Announcement announced{long_copies[place].lines};
    announced.lines.store(lines.word(), std::memory_order_seq_cst);
    const bool free = !any_reserved(lines);
    if (free) whole();
    return free;
  }

  LocalStores* const local_stores;  // null: none

  /// A line of a host program's memory, as its holder's getllar has found it, and where.
  struct alignas(kQuadwordBytes) Seen {
    std::array<std::byte, kLineBytes> bytes;
    const std::byte* host = nullptr;
  };
  std::vector<Seen> seen;  // of each place; empty: the storage has buffers

  std::array<Lock, 1 << kLockBits> locks;
  std::array<Reservation, kMaxHolders> reservations;
  std::array<LongCopy, kMaxHolders> long_copies;
  std::atomic<int> places_used{0};  // below this; never falls

  std::mutex places_mutex;
  std::bitset<kMaxHolders> places_taken;  // places_mutex held
};

int Reservations::State::take_place(ReservationListener* listener) {
  const std::lock_guard lock(places_mutex);
  int place = 0;
  while (place < kMaxHolders && places_taken[static_cast<std::size_t>(place)]) ++place;
  if (place == kMaxHolders) {
    throw std::runtime_error("one address space supports " + std::to_string(kMaxHolders) +
                             " holders of reservations (MFCs and Atomics), and all are in use");
  }
  places_taken.set(static_cast<std::size_t>(place));
  reservations[place].listener = listener;
  places_used.store(std::max(places_used.load(std::memory_order_relaxed), place + 1));
  return place;
}

void Reservations::State::leave_place(int place) {
  release(place);
  const std::lock_guard lock(places_mutex);
  SC_ASSERT(places_taken[static_cast<std::size_t>(place)], "holder {} is gone already", place);
  places_taken.reset(static_cast<std::size_t>(place));
}

// Takes the lock of the line that was reserved last. A write that ends the reservation calls the listener with that lock held, so the
// listener is not called after this.
void Reservations::State::release(int place) {
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

/// putllc in the memory of a host program. With the line's lock, which keeps all but host threads away.
bool Reservations::State::store_line_as_seen(int place, std::byte* host, const std::byte* from) const {
  const Seen& then = seen[static_cast<std::size_t>(place)];
  const auto differs = [](const std::byte* a, const std::byte* b) {
    return std::memcmp(a, b, kQuadwordBytes) != 0;
  };
  std::array<std::byte, kLineBytes> now;
  copy_indivisibly(now.data(), host, kLineBytes);
  std::uint32_t changed = 0, last = 0;
  for (std::uint32_t at = 0; at < kLineBytes; at += kQuadwordBytes) {
    if (differs(&now[at], &then.bytes[at])) return false;
    if (!differs(from + at, &now[at])) continue;
    ++changed;
    last = at;
  }
  if (changed == 1) return exchange_quadword(host + last, &then.bytes[last], from + last);
  for (std::uint32_t at = 0; at < kLineBytes; at += kQuadwordBytes) {
    if (differs(from + at, &now[at])) copy_quadword(host + at, from + at);
  }
  return true;
}

Reservations::Reservations(LocalStores* local_stores, Storage storage)
    : state_(std::make_unique<State>(local_stores, storage)) {}
Reservations::~Reservations() = default;

void Reservations::load_and_reserve(ReservationHolder& holder, EffectiveAddress ea, const std::byte* host,
                                    std::byte* to, std::uint32_t bytes) {
  SC_ASSERT(&holder.reservations_ == this, "holder {} belongs to another AddressSpace", holder.place_);
  SC_ASSERT(is_reserving_access(ea, bytes), "{} bytes at {}", bytes, ea);
  const std::uint64_t line = line_of(ea);
  State::Reservation& own = state_->reservations[holder.place_];
  if (own.last_line != line) state_->release(holder.place_);
  const std::lock_guard lock(state_->lock_of(line));
  own.last_line = line;
  own.line.store(line, std::memory_order_seq_cst);
  state_->wait_for_long_copies(line);
  state_->access([&] { copy_indivisibly(to, host, bytes); });
  if (state_->is_host_program() && bytes == kLineBytes) {
    State::Seen& seen = state_->seen[static_cast<std::size_t>(holder.place_)];
    std::memcpy(seen.bytes.data(), to, kLineBytes);
    seen.host = host;
  }
}

bool Reservations::store_conditional(ReservationHolder& holder, EffectiveAddress ea, std::byte* host,
                                     const std::byte* from, std::uint32_t bytes) {
  SC_ASSERT(&holder.reservations_ == this, "holder {} belongs to another AddressSpace", holder.place_);
  SC_ASSERT(is_reserving_access(ea, bytes), "{} bytes at {}", bytes, ea);
  const std::uint64_t line = line_of(ea);
  State::Reservation& own = state_->reservations[holder.place_];
  if (own.last_line != line) {
    state_->release(holder.place_);
    return false;
  }
  const std::lock_guard lock(state_->lock_of(line));
  bool stands = own.line.load(std::memory_order_relaxed) == line;
  if (stands && state_->is_host_program() && bytes == kLineBytes && !state_->is_local_store(ea)) {
    state_->access([&] { stands = state_->store_line_as_seen(holder.place_, host, from); });
    if (stands) {
      state_->lose_reservations(line, holder.place_);
    } else {
      own.line.store(kNoLine, std::memory_order_release);
    }
  } else if (stands) {
    state_->announce(ea, from, bytes);
    state_->access([&] { copy_indivisibly(host, from, bytes); });
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
    state_->access([&] {
      if (may_be_code) return copy_to_local_store(to, host, bytes);
      std::memmove(to, host, bytes);
    });
  };
  if (!fits_one_line(ea, bytes) && state_->copy_at_once(holder.place_, {ea, bytes}, whole)) {
    return;
  }
  for_each_line(ea, bytes, [&](std::uint32_t offset, std::uint32_t size) {
    const std::lock_guard lock(state_->lock_of(line_of(ea + offset)));
    state_->access([&] { copy_indivisibly(to + offset, host + offset, size); });
  });
}

void Reservations::write(ReservationHolder& holder, EffectiveAddress ea, std::byte* host,
                         const std::byte* from, std::uint32_t bytes) {
  SC_ASSERT(&holder.reservations_ == this, "holder {} belongs to another AddressSpace", holder.place_);
  SC_ASSERT(bytes != 0 && bytes <= kMaxTransferBytes + kLineBytes, "a put of {} bytes at {}", bytes, ea);
  if (state_->announce(ea, from, bytes)) return;
  if (!fits_one_line(ea, bytes) && state_->copy_at_once(holder.place_, {ea, bytes}, [&] {
        state_->copy_to_storage(ea, host, from, bytes);
      })) {
    return;
  }
  for_each_line(ea, bytes, [&](std::uint32_t offset, std::uint32_t size) {
    const std::uint64_t line = line_of(ea + offset);
    const std::lock_guard lock(state_->lock_of(line));
    state_->access([&] { copy_indivisibly(host + offset, from + offset, size); });
    state_->lose_reservations(line, holder.place_);
  });
}

void Reservations::release(ReservationHolder& holder) { state_->release(holder.place_); }

void Reservations::look_for_host_stores(ReservationHolder& holder) {
  if (!state_->is_host_program()) return;
  State::Reservation& own = state_->reservations[holder.place_];
  const std::uint64_t line = own.last_line;
  if (line == kNoLine) return;
  const std::lock_guard lock(state_->lock_of(line));
  if (own.line.load(std::memory_order_relaxed) != line) return;
  const State::Seen& seen = state_->seen[static_cast<std::size_t>(holder.place_)];
  std::array<std::byte, kLineBytes> now;
  state_->access([&] { copy_indivisibly(now.data(), seen.host, kLineBytes); });
  if (std::memcmp(now.data(), seen.bytes.data(), kLineBytes) == 0) return;
  own.line.store(kNoLine, std::memory_order_release);
  if (own.listener != nullptr) own.listener->on_reservation_lost();
}

bool Reservations::may_miss_host_stores(const ReservationHolder& holder) const {
  return state_->is_host_program() && holds(holder);
}

bool Reservations::holds(const ReservationHolder& holder) const {
  return state_->reservations[holder.place_].line.load(std::memory_order_acquire) != kNoLine;
}

}  // namespace softcell::dma
