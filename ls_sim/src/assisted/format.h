#pragma once
// Text by a format of printf, for a program whose int and pointers have 32 bits.

#include <cstdint>
#include <string>

namespace softcell::ls_sim::assisted {

class CallMemory;

/// Where the arguments behind a format come from, one after another.
class FormatArguments {
 public:
  virtual ~FormatArguments() = default;
  virtual std::uint32_t next_word() = 0;
  virtual std::uint64_t next_doubleword() = 0;
  virtual double next_double() = 0;
  /// The text at an address of the local store, up to its zero, `most` characters, or the end of the local store.
  virtual std::string text(std::uint32_t address, std::size_t most) = 0;
  virtual std::uint32_t local_store_address(std::uint32_t pointer) = 0;
};

/// Whether a conversion's length says 64 bits.
bool is_long_long(const std::string& length);

/// The size in bytes of an integer whose conversion has this length modifier.
std::uint32_t integer_bytes(const std::string& length);

/// The text that printf makes of a format and its arguments, cut at 2^20 characters. `l`, `z` and `t` are 32 bits, `ll` and `j` 64,
/// `L` is a double. `%p` shows a local-store address, `%ls` and `%lc` write UTF-8, `%n` writes to `memory`. Invalid conversions are
/// copied as text.
/// [C17, 7.21.6.1]
std::string format_text(const std::string& format, FormatArguments& arguments, CallMemory& memory);

}  // namespace softcell::ls_sim::assisted
