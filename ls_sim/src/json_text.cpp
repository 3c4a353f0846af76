#include "json_text.h"

#include <algorithm>

namespace softcell::ls_sim {
namespace {

unsigned char byte_at(std::string_view text, std::size_t at) {
  return at < text.size() ? static_cast<unsigned char>(text[at]) : 0;
}

/// Bytes of the UTF-8 sequence at `at`, or 0 when there is none. [RFC 3629]
std::size_t utf8_length(std::string_view text, std::size_t at) {
  const unsigned char first = byte_at(text, at), second = byte_at(text, at + 1);
  const std::size_t length = first < 0x80   ? 1
                             : first < 0xC2 ? 0
                             : first < 0xE0 ? 2
                             : first < 0xF0 ? 3
                             : first < 0xF5 ? 4
                                            : 0;
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte_at(text, at + i) & 0xC0) != 0x80) return 0;
  }
  // Longer than needed, a surrogate, past the last code point.
  if ((first == 0xE0 && second < 0xA0) || (first == 0xED && second >= 0xA0)) return 0;
  if ((first == 0xF0 && second < 0x90) || (first == 0xF4 && second >= 0x90)) return 0;
  return length;
}

}  // namespace

JsonText& JsonText::microseconds(std::int64_t nanoseconds) {
  nanoseconds = std::max<std::int64_t>(nanoseconds, 0);
  number(nanoseconds / 1000);
  const auto rest = static_cast<int>(nanoseconds % 1000);
  const auto digit = [](int value) { return static_cast<char>('0' + value % 10); };
  const char decimals[4] = {'.', digit(rest / 100), digit(rest / 10), digit(rest)};
  return raw({decimals, 4});
}

JsonText& JsonText::hex(std::uint64_t value, int digits) {
  char text[16];
  const auto end = std::to_chars(text, text + sizeof text, value, 16).ptr;
  std::transform(text, end, text, [](char c) { return c >= 'a' ? static_cast<char>(c - 'a' + 'A') : c; });
  const auto length = static_cast<int>(end - text);
  text_ += "\"0x";
  if (length < digits) text_.append(static_cast<std::size_t>(digits - length), '0');
  text_.append(text, end);
  return raw("\"");
}

JsonText& JsonText::string(std::string_view text) {
  text_ += '"';
  for (std::size_t at = 0; at < text.size();) {
    const auto c = static_cast<unsigned char>(text[at]);
    const std::size_t length = utf8_length(text, at);
    if (length == 0) {
      text_ += '?';
    } else if (c == '"' || c == '\\') {
      text_ += {'\\', text[at]};
    } else if (c < 0x20) {
      const char digits[] = "0123456789abcdef";
      text_ += {'\\', 'u', '0', '0', digits[c >> 4], digits[c & 15]};
    } else {
      text_ += text.substr(at, length);
    }
    at += std::max<std::size_t>(length, 1);
  }
  return raw("\"");
}

}  // namespace softcell::ls_sim
