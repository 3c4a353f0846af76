#pragma once
// One MFC's door to main storage: where an effective address lies, and every copy through it.

#include <cstddef>
#include <cstdint>
#include <variant>

#include "softcell/dma/address_space.h"
#include "softcell/dma/reservations.h"
#include "softcell/dma/translation_cache.h"

namespace softcell::dma {

/// Where bytes of main storage lie, as resolved once for a command.
struct StoragePlace {
  EffectiveAddress ea = {};
  std::byte* host = nullptr;

  StoragePlace after(std::uint32_t bytes) const { return {ea + bytes, host + bytes}; }
};

/// Used by the thread of its MFC.
class StoragePort {
 public:
  /// @param listener  told when this MFC's reservation is lost; may be null.
  StoragePort(AddressSpace& space, ReservationListener* listener)
      : translation_(space), reservations_(space.reservations()), holder_(reservations_, listener) {}

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

  /// @param bytes  1..16384.
  void read(const StoragePlace& place, std::byte* to, std::uint32_t bytes) {
    reservations_.read(holder_, place.ea, place.host, to, bytes);
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
  TranslationCache translation_;
  Reservations& reservations_;
  ReservationHolder holder_;
};

}  // namespace softcell::dma
