#pragma once
// The variable arguments of a call, as the two kinds of programs pass them.

#include <bit>
#include <cstdint>
#include <string>

#include "call_memory.h"
#include "format.h"

namespace softcell::ls_sim::assisted {

/// The arguments of a program built for the SPU, a quadword each. [SPU ABI, va_list] documented
class SpuVariableArguments final : public FormatArguments {
 public:
  /// @param next          address of the first argument
  /// @param caller_stack  where the caller's frame begins, whose first 32 bytes hold no arguments
  SpuVariableArguments(const CallMemory& memory, std::uint32_t next, std::uint32_t caller_stack)
      : memory_(memory), next_(next), caller_stack_(caller_stack) {}

  std::uint32_t next_word() override { return memory_.word(take()); }
  std::uint64_t next_doubleword() override { return memory_.doubleword(take()); }
  double next_double() override { return std::bit_cast<double>(next_doubleword()); }
  std::string text(std::uint32_t address, std::size_t most) override { return memory_.text(address, most); }
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

/// The arguments of a kernel built for the host. [x32 psABI, variable argument lists] documented
class HostVariableArguments final : public FormatArguments {
 public:
  /// @param list  where the va_list is
  HostVariableArguments(CallMemory& memory, std::uint32_t list) : memory_(memory), list_(list) {}

  std::uint32_t next_word() override { return memory_.word(next_integer()); }
  std::uint64_t next_doubleword() override { return memory_.doubleword(next_integer()); }
  double next_double() override {
    return std::bit_cast<double>(memory_.doubleword(next(kVectorOffset, kVectorsEnd, 16)));
  }
  std::string text(std::uint32_t address, std::size_t most) override { return memory_.text(address, most); }
  std::uint32_t local_store_address(std::uint32_t pointer) override { return pointer & dma::kLocalStoreMask; }

 private:
  // Offsets in a va_list: the offset of the next saved integer register, and of the next vector register; the address of the next argument
  // on the stack; the address of the saved registers.
  static constexpr std::uint32_t kIntegerOffset = 0, kVectorOffset = 4, kStack = 8, kRegisters = 12;
  static constexpr std::uint32_t kIntegersEnd = 48, kVectorsEnd = 176;

  std::uint32_t next_integer() { return next(kIntegerOffset, kIntegersEnd, 8); }

  /// The address of the next argument of a class.
  std::uint32_t next(std::uint32_t offset_at, std::uint32_t end, std::uint32_t step) {
    const std::uint32_t offset = memory_.word(list_ + offset_at);
    if (offset < end) {
      memory_.set_word(list_ + offset_at, offset + step);
      return memory_.word(list_ + kRegisters) + offset;
    }
    const std::uint32_t stack = memory_.word(list_ + kStack);
    memory_.set_word(list_ + kStack, stack + 8);
    return stack;
  }

  CallMemory& memory_;
  std::uint32_t list_;
};

}  // namespace softcell::ls_sim::assisted
