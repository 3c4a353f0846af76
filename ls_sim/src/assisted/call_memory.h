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

  std::uint8_t byte(std::uint32_t lsa) const {
    return static_cast<std::uint8_t>(bytes_[lsa & dma::kLocalStoreMask]);
  }
  std::uint32_t word(std::uint32_t lsa) const { return static_cast<std::uint32_t>(value(lsa, 4)); }
  std::uint64_t doubleword(std::uint32_t lsa) const { return value(lsa, 8); }

  void set_byte(std::uint32_t lsa, std::uint8_t value) {
    bytes_[lsa & dma::kLocalStoreMask] = static_cast<std::byte>(value);
    if (on_write_) on_write_(lsa & dma::kLocalStoreMask);
  }
  /// @param size  bytes, 1 to 8; of the value as many low ones
  void set_value(std::uint32_t lsa, std::uint64_t value, std::uint32_t size) {
    for (std::uint32_t i = 0; i < size; ++i)
      set_byte(lsa + i, static_cast<std::uint8_t>(value >> 8 * place(i, size)));
  }
  void set_word(std::uint32_t lsa, std::uint32_t value) { set_value(lsa, value, 4); }

  /// Is told of each byte that is set. Empty: nobody.
  void on_write(std::function<void(std::uint32_t lsa)> listener) { on_write_ = std::move(listener); }

  /// Up to its zero, at the longest `most` characters or a whole local store.
  std::string text(std::uint32_t lsa, std::size_t most = dma::kLocalStoreBytes) const {
    std::string text;
    most = std::min<std::size_t>(most, dma::kLocalStoreBytes);
    while (text.size() < most && byte(lsa) != 0) text += static_cast<char>(byte(lsa++));
    return text;
  }
  std::string bytes(std::uint32_t lsa, std::uint32_t count) const {
    std::string text;
    for (std::uint32_t i = 0; i < count && i < dma::kLocalStoreBytes; ++i)
      text += static_cast<char>(byte(lsa + i));
    return text;
  }
  void set_bytes(std::uint32_t lsa, std::string_view text) {
    for (const char each : text) set_byte(lsa++, static_cast<std::uint8_t>(each));
  }

 private:
  std::uint32_t place(std::uint32_t i, std::uint32_t size) const {
    return order_ == std::endian::big ? size - 1 - i : i;
  }
  std::uint64_t value(std::uint32_t lsa, std::uint32_t size) const {
    std::uint64_t sum = 0;
    for (std::uint32_t i = 0; i < size; ++i) sum |= std::uint64_t{byte(lsa + i)} << 8 * place(i, size);
    return sum;
  }

  std::span<std::byte> bytes_;
  std::endian order_;
  std::function<void(std::uint32_t)> on_write_;
};

}  // namespace softcell::ls_sim::assisted
