#pragma once
// One MFC's access to main storage: it translates effective addresses and copies bytes.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <variant>

#include "softcell/base/assert.h"
#include "softcell/dma/address_space.h"
#include "softcell/dma/address_window.h"
#include "softcell/dma/local_store_bytes.h"
#include "softcell/dma/reservations.h"
#include "softcell/dma/translation_cache.h"

namespace softcell::dma {

/// A translated address of main storage.
struct StoragePlace {
  EffectiveAddress ea = {};
  std::byte* host = nullptr;
  ElementWidths swapped = {};  ///< widths of the elements whose byte order is changed during a copy

  bool is_swapped() const { return swapped.element_bytes > 1 || swapped.layout != nullptr; }
  StoragePlace after(std::uint32_t bytes) const { return {ea + bytes, host + bytes, swapped}; }
};

/// Only the thread of its MFC may use it, except for expect_code_below().
///
/// The local store of a program for the SPU is big-endian. Then copies change the byte order of the elements of typed buffers
/// (BufferOptions::element_bytes and record), so that the PPU side sees the host's order; all other bytes stay as they are.
///
/// It knows which part of the local store may hold instructions. It writes those bytes as local_store_bytes.h requires, and all others in
/// the host's fastest way.
class StoragePort {
 public:
  /// @param local_store  the MFC's local store, kLocalStoreBytes long.
  /// @param listener  called when this MFC loses its reservation; may be null.
  StoragePort(const std::byte* local_store, AddressSpace& space, ReservationListener* listener)
      : local_store_(local_store),
        space_(space),
        translation_(space),
        reservations_(space.reservations()),
        local_stores_(space.local_store_ea(0)),
        holder_(reservations_, listener) {
    SC_ASSERT(local_store != nullptr, "an MFC without a local store");
  }

  /// Sets the window through which this SPE reaches the threads of its own group (AddressWindow); without this call it has none.
  void set_window(AddressWindow window) { window_ = std::move(window); }

  /// Resolves an address as AddressSpace::resolve() does, after translating it with the window.
  std::variant<StoragePlace, Fault> resolve(EffectiveAddress ea, std::uint64_t bytes, SpeAccess wanted) {
    ea = window_.translate(ea);
    auto resolved = translation_.resolve(ea, bytes, wanted);
    if (auto* fault = std::get_if<Fault>(&resolved)) return std::move(*fault);
    return StoragePlace{ea, std::get<std::byte*>(resolved),
                        is_big_endian_ ? space_.element_widths_at(ea) : ElementWidths{}};
  }

  /// Declares the byte order of the local store, little-endian until then.
  void set_big_endian(bool is_big_endian) { is_big_endian_ = is_big_endian; }
  bool is_big_endian() const { return is_big_endian_; }

  /// Resolves all lines that [ea, ea + bytes) touches. Buffers consist of whole lines, so that a line
  /// belongs to the buffer that contains its first quadword.
  std::variant<StoragePlace, Fault> resolve_lines(EffectiveAddress ea, std::uint32_t bytes,
                                                  SpeAccess wanted) {
    const EffectiveAddress first{ea.value / kLineBytes * kLineBytes};
    const std::uint64_t end = ea.value + bytes;
    const std::uint64_t last = (end - 1) / kLineBytes * kLineBytes;
    return resolve(first, last - first.value + kQuadwordBytes, wanted);
  }

  /// Declares that all instructions lie below `end`, until a later call says otherwise. Without this call
  /// they may lie anywhere.
  /// @pre  end <= kLocalStoreBytes
  void confine_code(LocalStoreAddress end) {
    SC_ASSERT(end.value <= kLocalStoreBytes, "instructions end at {}, outside the local store", end);
    code_end_.store(end.value, std::memory_order_relaxed);
  }

  /// Declares that an image will arrive with instructions up to `end`. Any thread.
  /// @pre  end <= kLocalStoreBytes
  void expect_code_below(LocalStoreAddress end) {
    SC_ASSERT(end.value <= kLocalStoreBytes, "instructions end at {}, outside the local store", end);
    std::uint32_t known = code_end_.load(std::memory_order_relaxed);
    while (known < end.value &&
           !code_end_.compare_exchange_weak(known, end.value, std::memory_order_relaxed)) {
    }
  }

  /// Declares that all bytes may be instructions, those that were already read and later ones.
  void expect_code_everywhere() {
    const std::uint32_t known = code_end_.exchange(kLocalStoreBytes, std::memory_order_relaxed);
    if (known == kLocalStoreBytes) return;
    flush_local_store(local_store_ + known, kLocalStoreBytes - known);
  }

  /// The end of the part that may hold instructions.
  LocalStoreAddress code_end() const { return {code_end_.load(std::memory_order_relaxed)}; }

  /// Copies to the local store: Reservations::read(). @param bytes  1..16384. @pre `to` is in the local store
  void read(const StoragePlace& place, std::byte* to, std::uint32_t bytes) {
    SC_ASSERT(to >= local_store_ && to + bytes <= local_store_ + kLocalStoreBytes,
              "{} bytes from {} leave the local store: {} bytes past its begin", bytes, place.ea,
              to - local_store_);
    if (place.is_swapped()) return read_swapped(place, to, bytes);
    const bool may_be_code = static_cast<std::size_t>(to - local_store_) < code_end().value;
    reservations_.read(holder_, place.ea, place.host, to, bytes, may_be_code);
  }
  /// Copies to main storage: Reservations::write().
  void write(const StoragePlace& place, const std::byte* from, std::uint32_t bytes) {
    if (place.is_swapped()) return write_swapped(place, from, bytes);
    reservations_.write(holder_, place.ea, place.host, from, bytes);
  }

  /// The line commands, 128 bytes each.
  void load_and_reserve(const StoragePlace& line, std::byte* to);
  bool store_conditional(const StoragePlace& line, const std::byte* from);
  void store_line(const StoragePlace& line, const std::byte* from);
  void release_reservation() { reservations_.release(holder_); }
  /// Reservations::look_for_host_stores().
  void look_for_host_stores() { reservations_.look_for_host_stores(holder_); }
  bool may_miss_host_stores() const { return reservations_.may_miss_host_stores(holder_); }

  /// The address of SPE 0's local store in main storage, and a translated address.
  EffectiveAddress local_stores() const { return local_stores_; }
  EffectiveAddress translate(EffectiveAddress ea) const { return window_.translate(ea); }

 private:
  void read_swapped(const StoragePlace& place, std::byte* to, std::uint32_t bytes);
  void write_swapped(const StoragePlace& place, const std::byte* from, std::uint32_t bytes);

  const std::byte* const local_store_;
  const AddressSpace& space_;
  bool is_big_endian_ = false;
  std::atomic<std::uint32_t> code_end_{kLocalStoreBytes};
  AddressWindow window_;
  TranslationCache translation_;
  Reservations& reservations_;
  const EffectiveAddress local_stores_;
  ReservationHolder holder_;
};

}  // namespace softcell::dma
