#pragma once
// Text for messages: UTF-8, one-line sentences from any source, numbers. Any thread.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace softcell::base {

/// Length in bytes of the UTF-8 character that begins at byte `at`, or 0 if these bytes are not UTF-8. [RFC
/// 3629]
/// @pre  at < text.size()
std::size_t utf8_length(std::string_view text, std::size_t at);

/// Makes a sentence safe to print, whatever a file has put into it: one line, with control characters and bytes that are not UTF-8 written
/// as "\x1b". Shortens a sentence of more than about 2000 bytes to its beginning and end.
std::string one_line(std::string_view sentence);

inline constexpr int kMostHexDigits = 16;  // of a 64-bit number

/// "0x01F": hexadecimal in upper case with at least `digits` digits. @pre 0 <= digits <= kMostHexDigits
std::string hex(std::uint64_t value, int digits = 1);

/// "1 frame", "0 frames", "2 bodies".
/// @param many  the plural, if it is not `one` with an s.
std::string counted(std::uint64_t count, std::string_view one, std::string_view many = {});

/// A number with as few digits as distinguish it from all others of its type: "0.1", "1e-08", "nan".
std::string shortest(float number);
/// The same; a double that is exactly a float gets the float's digits.
std::string shortest(double number);

/// "1 byte", "16 bytes".
std::string byte_count(std::uint64_t bytes);

}  // namespace softcell::base
