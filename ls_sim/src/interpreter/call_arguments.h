#pragma once
// The local store as the arguments of an assisted call have it.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "assisted/format.h"
#include "softcell/base/assert.h"
#include "softcell/dma/addresses.h"

namespace softcell::ls_sim::interpreter {

/// Big-endian values at local-store addresses, which wrap around as those of an SPU do.
class CallMemory {
 public:
  explicit CallMemory(std::span<std::byte> local_store) : bytes_(local_store) {
    SC_ASSERT(local_store.size() == dma::kLocalStoreBytes, "a local store of {} bytes", local_store.size());
  }

  std::uint8_t byte(std::uint32_t lsa) const {
    return static_cast<std::uint8_t>(bytes_[lsa & dma::kLocalStoreMask]);
  }
  std::uint32_t word(std::uint32_t lsa) const {
    std::uint32_t value = 0;
    for (std::uint32_t i = 0; i < 4; ++i) value = value << 8 | byte(lsa + i);
    return value;
  }
  std::uint64_t doubleword(std::uint32_t lsa) const { return std::uint64_t{word(lsa)} << 32 | word(lsa + 4); }

  void set_byte(std::uint32_t lsa, std::uint8_t value) {
    bytes_[lsa & dma::kLocalStoreMask] = static_cast<std::byte>(value);
  }
  void set_word(std::uint32_t lsa, std::uint32_t value) {
    for (std::uint32_t i = 0; i < 4; ++i) set_byte(lsa + i, static_cast<std::uint8_t>(value >> (24 - 8 * i)));
  }

  /// Up to its zero, at the longest a whole local store.
  std::string text(std::uint32_t lsa) const {
    std::string text;
    while (text.size() < dma::kLocalStoreBytes && byte(lsa) != 0) text += static_cast<char>(byte(lsa++));
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
  std::span<std::byte> bytes_;
};

/// The variable arguments of a call, one quadword each. [SPU ABI, va_list] documented
class VariableArguments final : public assisted::FormatArguments {
 public:
  /// @param next  of the first argument. @param caller_stack  where the caller's frame begins, whose first 32 bytes hold
  /// none.
  VariableArguments(const CallMemory& memory, std::uint32_t next, std::uint32_t caller_stack)
      : memory_(memory), next_(next), caller_stack_(caller_stack) {}

  std::uint32_t next_word() override { return memory_.word(take()); }
  std::uint64_t next_doubleword() override { return memory_.doubleword(take()); }
  double next_double() override { return std::bit_cast<double>(next_doubleword()); }
  std::string text(std::uint32_t address, std::size_t most) override {
    return memory_.text(address).substr(0, most);
  }
  std::uint32_t local_store_address(std::uint32_t pointer) override { return pointer; }

 private:
  static constexpr std::uint32_t kFrameHeaderBytes = 32;

  std::uint32_t take() {
    if (next_ == caller_stack_) next_ += kFrameHeaderBytes;
    const std::uint32_t at = next_;
    next_ += dma::kQuadwordBytes;
    return at;
  }

  const CallMemory& memory_;
  std::uint32_t next_, caller_stack_;
};

}  // namespace softcell::ls_sim::interpreter
