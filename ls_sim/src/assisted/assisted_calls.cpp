#include "assisted_calls.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <string>

#include "format.h"
#include "softcell/base/assert.h"

namespace softcell::ls_sim::assisted {
namespace {

constexpr std::uint32_t kError = ~0u;
constexpr std::uint32_t kStandardError = 3;  // of the three FILEs: 1 in, 2 out, 3 error

class Memory {
 public:
  explicit Memory(std::span<std::byte> bytes) : bytes_(bytes) {
    SC_ASSERT(bytes.size() == dma::kLocalStoreBytes, "a local store of {} bytes", bytes.size());
  }

  /// Addresses wrap at the end of the local store, as the SPU's do.
  template <class T>
  T read(std::uint32_t address) const {
    T value;
    auto* const to = reinterpret_cast<std::byte*>(&value);
    for (std::size_t i = 0; i < sizeof value; ++i)
      to[i] = bytes_[(address + static_cast<std::uint32_t>(i)) & dma::kLocalStoreMask];
    return value;
  }
  template <class T>
  void write(std::uint32_t address, T value) {
    const auto* const from = reinterpret_cast<const std::byte*>(&value);
    for (std::size_t i = 0; i < sizeof value; ++i)
      bytes_[(address + static_cast<std::uint32_t>(i)) & dma::kLocalStoreMask] = from[i];
  }
  std::string text(std::uint32_t address, std::size_t most) const {
    const std::span<const std::byte> rest = bytes_.subspan(address & dma::kLocalStoreMask);
    const auto whole = rest.first(std::min(most, rest.size()));
    const auto end = std::find(whole.begin(), whole.end(), std::byte{0});
    return {reinterpret_cast<const char*>(whole.data()), static_cast<std::size_t>(end - whole.begin())};
  }
  std::string bytes(std::uint32_t address, std::size_t count) const {
    const std::span<const std::byte> rest = bytes_.subspan(address & dma::kLocalStoreMask);
    return {reinterpret_cast<const char*>(rest.data()), std::min(count, rest.size())};
  }

 private:
  std::span<std::byte> bytes_;
};

/// The arguments of a variadic function.  [x32 psABI, variable argument lists] documented
class VariadicArguments final : public FormatArguments {
 public:
  VariadicArguments(Memory& memory, std::uint32_t list) : memory_(memory), list_(list) {}

  std::uint32_t next_word() override { return memory_.read<std::uint32_t>(next_integer()); }
  std::uint64_t next_doubleword() override { return memory_.read<std::uint64_t>(next_integer()); }
  double next_double() override { return memory_.read<double>(next(kVectorOffset, kVectorsEnd, 16)); }
  std::string text(std::uint32_t address, std::size_t most) override { return memory_.text(address, most); }
  std::uint32_t local_store_address(std::uint32_t pointer) override { return pointer & dma::kLocalStoreMask; }

 private:
  // Of a va_list: how far the saved registers have been used, the arguments on the stack, the saved registers.
  static constexpr std::uint32_t kIntegerOffset = 0, kVectorOffset = 4, kStack = 8, kRegisters = 12;
  static constexpr std::uint32_t kIntegersEnd = 48, kVectorsEnd = 176;

  std::uint32_t next_integer() { return next(kIntegerOffset, kIntegersEnd, 8); }

  /// The address of the next argument of a class.
  std::uint32_t next(std::uint32_t offset_at, std::uint32_t end, std::uint32_t step) {
    const auto offset = memory_.read<std::uint32_t>(list_ + offset_at);
    if (offset < end) {
      memory_.write(list_ + offset_at, offset + step);
      return memory_.read<std::uint32_t>(list_ + kRegisters) + offset;
    }
    const auto stack = memory_.read<std::uint32_t>(list_ + kStack);
    memory_.write(list_ + kStack, stack + 8);
    return stack;
  }

  Memory& memory_;
  std::uint32_t list_;
};

std::uint32_t put(std::uint32_t file, const std::string& text) {
  std::FILE* const to = file == kStandardError ? stderr : stdout;
  if (std::fwrite(text.data(), 1, text.size(), to) != text.size()) return kError;
  return static_cast<std::uint32_t>(text.size());
}

}  // namespace

std::uint32_t serve_c99_call(std::span<std::byte> local_store, std::uint32_t request) {
  Memory memory(local_store);
  const auto argument = [&](std::uint32_t i) { return memory.read<std::uint32_t>(request + 16 * i); };
  const auto formatted = [&](std::uint32_t format, std::uint32_t list) {
    VariadicArguments arguments(memory, list);
    return format_text(memory.text(format, std::string::npos), arguments);
  };
  switch (request >> 24) {
    case kFflush:
      return static_cast<std::uint32_t>(std::fflush(nullptr));
    case kFputc:
      put(argument(1), std::string(1, static_cast<char>(argument(0))));
      return argument(0) & 0xFFu;
    case kPutchar:
      put(0, std::string(1, static_cast<char>(argument(0))));
      return argument(0) & 0xFFu;
    case kFputs:
      return put(argument(1), memory.text(argument(0), std::string::npos));
    case kPuts:
      return put(0, memory.text(argument(0), std::string::npos) + "\n");
    case kFwrite: {
      const std::uint32_t size = argument(1), wanted = size * argument(2);
      if (size == 0) return 0;
      const std::uint32_t written = put(argument(3), memory.bytes(argument(0), wanted));
      return written == kError ? 0 : written / size;
    }
    case kVprintf:
      return put(0, formatted(argument(0), argument(1)));
    case kVfprintf:
      return put(argument(0), formatted(argument(1), argument(2)));
    case kVsnprintf: {
      const std::string text = formatted(argument(2), argument(3));
      const std::uint32_t room = std::min(argument(1), dma::kLocalStoreBytes);
      for (std::uint32_t i = 0; room != 0 && i <= text.size() && i < room; ++i)
        memory.write(argument(0) + i, i < text.size() && i + 1 < room ? text[i] : '\0');
      return static_cast<std::uint32_t>(text.size());
    }
  }
  return kError;
}

}  // namespace softcell::ls_sim::assisted
