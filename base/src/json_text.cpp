#include "softcell/base/json_text.h"

#include <algorithm>

#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::base {

JsonText& JsonText::microseconds(std::int64_t nanoseconds) {
  nanoseconds = std::max<std::int64_t>(nanoseconds, 0);
  number(nanoseconds / 1000);
  const auto rest = static_cast<int>(nanoseconds % 1000);
  const auto digit = [](int value) { return static_cast<char>('0' + value % 10); };
  const char decimals[4] = {'.', digit(rest / 100), digit(rest / 10), digit(rest)};
  return raw({decimals, 4});
}

JsonText& JsonText::hex(std::uint64_t value, int digits) {
  SC_ASSERT(digits >= 0 && digits <= kMostHexDigits, "{} hexadecimal digits; a 64-bit number has {} at most",
            digits, kMostHexDigits);
  char text[kMostHexDigits];
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

}  // namespace softcell::base
