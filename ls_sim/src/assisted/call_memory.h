#pragma once
// The local store as the arguments of an assisted call have it.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "softcell/base/assert.h"
#include "softcell/dma/addresses.h"

namespace softcell::ls_sim::assisted {

/// Values at local-store addresses, which wrap around as those of an SPU do.
class CallMemory {
 public:
  /// @param order  of the bytes of a value: big for a program that a compiler for the SPU has made
  explicit CallMemory(std::span<std::byte> local_store, std::endian order = std::endian::big)
      : bytes_(local_store), order_(order) {
    SC_ASSERT(local_store.size() == dma::kLocalStoreBytes, "a local store of {} bytes", local_store.size());
  }

  std::uint8_t byte(std::uint32_t lsa) const { return static_cast<std::uint8_t>(value(lsa, 1)); }
  std::uint32_t word(std::uint32_t lsa) const { return static_cast<std::uint32_t>(value(lsa, 4)); }
  std::uint64_t doubleword(std::uint32_t lsa) const { return value(lsa, 8); }

  /// @param size  bytes, 1 to 8; of the value as many low ones
  void set_value(std::uint32_t lsa, std::uint64_t value, std::uint32_t size) {
    tell(lsa, size, true);
    for (std::uint32_t i = 0; i < size; ++i)
      at(lsa + i) = static_cast<std::byte>(static_cast<std::uint8_t>(value >> 8 * place(i, size)));
  }
  void set_word(std::uint32_t lsa, std::uint32_t value) { set_value(lsa, value, 4); }

  /// Called with each range before it is read or written. No range wraps around.
  using Listener = std::function<void(std::uint32_t lsa, std::uint32_t bytes, bool is_store)>;
  /// @param listener  empty: none
  void set_listener(Listener listener) { listener_ = std::move(listener); }

  /// Reads a text up to its terminating zero, at most `most` characters or a whole local store.
  std::string text(std::uint32_t lsa, std::size_t most = dma::kLocalStoreBytes) const {
    most = std::min<std::size_t>(most, dma::kLocalStoreBytes);
    std::uint32_t length = 0;
    while (length < most && at(lsa + length) != std::byte{0}) ++length;
    tell(lsa, static_cast<std::uint32_t>(std::min<std::size_t>(length + 1, most)), false);
    return copy(lsa, length);
  }
  std::string bytes(std::uint32_t lsa, std::uint32_t count) const {
    count = std::min(count, dma::kLocalStoreBytes);
    tell(lsa, count, false);
    return copy(lsa, count);
  }
  void set_bytes(std::uint32_t lsa, std::string_view text) {
    SC_ASSERT(text.size() <= dma::kLocalStoreBytes, "{} bytes for a local store", text.size());
    tell(lsa, static_cast<std::uint32_t>(text.size()), true);
    for (const char each : text) at(lsa++) = static_cast<std::byte>(each);
  }

 private:
  std::uint32_t place(std::uint32_t i, std::uint32_t size) const {
    return order_ == std::endian::big ? size - 1 - i : i;
  }
  std::byte& at(std::uint32_t lsa) const { return bytes_[lsa & dma::kLocalStoreMask]; }
  std::string copy(std::uint32_t lsa, std::uint32_t count) const {
    std::string text;
    for (std::uint32_t i = 0; i < count; ++i) text += static_cast<char>(at(lsa + i));
    return text;
  }
  std::uint64_t value(std::uint32_t lsa, std::uint32_t size) const {
    tell(lsa, size, false);
    std::uint64_t sum = 0;
    for (std::uint32_t i = 0; i < size; ++i)
      sum |= std::uint64_t{static_cast<std::uint8_t>(at(lsa + i))} << 8 * place(i, size);
    return sum;
  }
  void tell(std::uint32_t lsa, std::uint32_t bytes, bool is_store) const {
    if (!listener_ || bytes == 0) return;
    lsa &= dma::kLocalStoreMask;
    const std::uint32_t first = std::min(bytes, dma::kLocalStoreBytes - lsa);
    listener_(lsa, first, is_store);
    if (first < bytes) listener_(0, bytes - first, is_store);
  }

  std::span<std::byte> bytes_;
  std::endian order_;
  Listener listener_;
};

}  // namespace softcell::ls_sim::assisted
