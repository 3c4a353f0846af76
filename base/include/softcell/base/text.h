#pragma once
// Text for messages: what is UTF-8, sentences of any origin in one line, numbers as messages write them.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace softcell::base {

/// Bytes of the UTF-8 sequence at `at`, or 0 when there is none. [RFC 3629] @pre at < text.size()
std::size_t utf8_length(std::string_view text, std::size_t at);

/// A sentence as it may be printed, whatever a file has put into it: in one line, control characters and what
/// is no UTF-8 as "\x1b", and no longer than some 2000 bytes: of a longer one beginning and end.
std::string one_line(std::string_view sentence);

/// 0x-prefixed, upper case, at least `digits` digits.
std::string hex(std::uint64_t value, int digits = 1);

/// "1 frame", "0 frames", "2 bodies".
/// @param many  the plural, where it is not `one` with an s.
std::string counted(std::uint64_t count, std::string_view one, std::string_view many = {});

/// "1 byte", "16 bytes".
std::string byte_count(std::uint64_t bytes);

}  // namespace softcell::base
