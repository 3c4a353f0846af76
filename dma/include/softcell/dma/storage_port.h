#pragma once
// One MFC's door to main storage: where an effective address lies, and every copy through it.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <variant>

#include "softcell/dma/address_space.h"
#include "softcell/dma/local_store_bytes.h"
#include "softcell/dma/reservations.h"
#include "softcell/dma/translation_cache.h"

namespace softcell::dma {

/// Where bytes of main storage lie, as resolved once for a command.
struct StoragePlace {
  EffectiveAddress ea = {};
  std::byte* host = nullptr;

  StoragePlace after(std::uint32_t bytes) const { return {ea + bytes, host + bytes}; }
};

/// Used by the thread of its MFC, except for expect_code_below().
///
/// It knows where the local store may hold instructions: those bytes it writes as local_store_bytes.h says,
/// all others in the host's fastest way.
class StoragePort {
 public:
  /// @param local_store  the MFC's, kLocalStoreBytes.
  /// @param listener  told when this MFC's reservation is lost; may be null.
  StoragePort(const std::byte* local_store, AddressSpace& space, ReservationListener* listener)
      : local_store_(local_store),
        translation_(space),
        reservations_(space.reservations()),
        holder_(reservations_, listener) {}

  /// As AddressSpace::resolve().
  std::variant<StoragePlace, Fault> resolve(EffectiveAddress ea, std::uint64_t bytes, SpeAccess wanted) {
    auto resolved = translation_.resolve(ea, bytes, wanted);
    if (auto* fault = std::get_if<Fault>(&resolved)) return std::move(*fault);
    return StoragePlace{ea, std::get<std::byte*>(resolved)};
  }

  /// The lines that [ea, ea + bytes) touches. Buffers start at lines and own theirs whole, so that a line
  /// belongs to the buffer that has its first quadword.
  std::variant<StoragePlace, Fault> resolve_lines(EffectiveAddress ea, std::uint32_t bytes,
                                                  SpeAccess wanted) {
    const EffectiveAddress first{ea.value / kLineBytes * kLineBytes};
    const std::uint64_t end = ea.value + bytes;
    const std::uint64_t last = (end - 1) / kLineBytes * kLineBytes;
    return resolve(first, last - first.value + kQuadwordBytes, wanted);
  }

  /// Instructions lie at the bottom of the local store, below `end`, and will do so until somebody says
  /// otherwise. Without this call they may lie anywhere.
  void confine_code(LocalStoreAddress end) { code_end_.store(end.value, std::memory_order_relaxed); }

  /// An image will arrive that has instructions up to `end`. Any thread.
  void expect_code_below(LocalStoreAddress end) {
    std::uint32_t known = code_end_.load(std::memory_order_relaxed);
    while (known < end.value &&
           !code_end_.compare_exchange_weak(known, end.value, std::memory_order_relaxed)) {
    }
  }

  /// What has been read so far may be instructions, and what will be, too.
  void expect_code_everywhere() {
    const std::uint32_t known = code_end_.exchange(kLocalStoreBytes, std::memory_order_relaxed);
    if (known == kLocalStoreBytes) return;
    flush_local_store(local_store_ + known, kLocalStoreBytes - known);
  }

  /// Behind which no instructions are expected.
  LocalStoreAddress code_end() const { return {code_end_.load(std::memory_order_relaxed)}; }

  /// @param bytes  1..16384.
  void read(const StoragePlace& place, std::byte* to, std::uint32_t bytes) {
    const bool may_be_code = static_cast<std::size_t>(to - local_store_) < code_end().value;
    reservations_.read(holder_, place.ea, place.host, to, bytes, may_be_code);
  }
  void write(const StoragePlace& place, const std::byte* from, std::uint32_t bytes) {
    reservations_.write(holder_, place.ea, place.host, from, bytes);
  }

  /// The line commands, 128 bytes each.
  void load_and_reserve(const StoragePlace& line, std::byte* to) {
    reservations_.load_and_reserve(holder_, line.ea, line.host, to);
  }
  bool store_conditional(const StoragePlace& line, const std::byte* from) {
    return reservations_.store_conditional(holder_, line.ea, line.host, from);
  }
  void store_line(const StoragePlace& line, const std::byte* from) {
    reservations_.store_line(holder_, line.ea, line.host, from);
  }
  void give_up_reservation() { reservations_.give_up(holder_); }

 private:
  const std::byte* const local_store_;
  std::atomic<std::uint32_t> code_end_{kLocalStoreBytes};
  TranslationCache translation_;
  Reservations& reservations_;
  ReservationHolder holder_;
};

}  // namespace softcell::dma
