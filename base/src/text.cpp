#include "softcell/base/text.h"

#include <array>
#include <charconv>
#include <cinttypes>
#include <cstdio>

#include "softcell/base/assert.h"

namespace softcell::base {
namespace {

constexpr std::size_t kLongestBeginning = 1500, kLongestEnd = 500;

unsigned char byte_at(std::string_view text, std::size_t at) {
  return at < text.size() ? static_cast<unsigned char>(text[at]) : 0;
}

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character.front());
  if (character.size() == 1) return first < 0x20 || first == 0x7F;
  return first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0;
}

/// "\x1b"
std::string escaped(char c) {
  constexpr char kDigits[] = "0123456789abcdef";
  const auto byte = static_cast<unsigned char>(c);
  return {'\\', 'x', kDigits[byte >> 4], kDigits[byte & 15]};
}

std::string shortened(const std::string& text) {
  if (text.size() <= kLongestBeginning + kLongestEnd) return text;
  std::size_t beginning = kLongestBeginning, end = text.size() - kLongestEnd;
  while (continues(text[beginning])) --beginning;
  while (continues(text[end])) ++end;
  return text.substr(0, beginning) + " ... " + text.substr(end);
}

}  // namespace

std::size_t utf8_length(std::string_view text, std::size_t at) {
  SC_ASSERT(at < text.size(), "byte {} of a text of {} bytes", at, text.size());
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

std::string one_line(std::string_view sentence) {
  std::string text;
  while (!sentence.empty()) {
    const std::size_t known = utf8_length(sentence, 0);
    const std::string_view character = sentence.substr(0, known == 0 ? 1 : known);
    sentence.remove_prefix(character.size());
    if (character == "\n" || character == "\t") {
      text += ' ';
    } else if (known != 0 && !is_control(character)) {
      text += character;
    } else {
      for (const char c : character) text += escaped(c);
    }
  }
  return shortened(text);
}

std::string hex(std::uint64_t value, int digits) {
  SC_ASSERT(digits >= 0 && digits <= kMostHexDigits, "{} hexadecimal digits; a 64-bit number has {} at most",
            digits, kMostHexDigits);
  char text[2 + kMostHexDigits + 1];
  std::snprintf(text, sizeof text, "0x%0*" PRIX64, digits, value);
  return text;
}

std::string counted(std::uint64_t count, std::string_view one, std::string_view many) {
  std::string text = std::to_string(count) + " ";
  if (count == 1) return text.append(one);
  return many.empty() ? text.append(one).append("s") : text.append(many);
}

namespace {

template <class Number>
std::string shortest_of(Number number) {
  std::array<char, 32> text{};
  const std::to_chars_result end = std::to_chars(text.data(), text.data() + text.size(), number);
  SC_ASSERT(end.ec == std::errc(), "{} has more than {} digits", number, text.size());
  return {text.data(), end.ptr};
}

}  // namespace

std::string shortest(float number) { return shortest_of(number); }

std::string shortest(double number) {
  const auto narrow = static_cast<float>(number);
  return static_cast<double>(narrow) == number ? shortest_of(narrow) : shortest_of(number);
}

std::string byte_count(std::uint64_t bytes) { return counted(bytes, "byte"); }

}  // namespace softcell::base
