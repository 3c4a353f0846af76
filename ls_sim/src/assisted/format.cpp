#include "format.h"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "call_memory.h"

namespace softcell::ls_sim::assisted {
namespace {

constexpr std::size_t kMostText = 1 << 20;  // more than any local store holds
constexpr int kMostWidth = 4096;  // of a field, and its digits: more is cut; C asks for 4095 [C17, 7.21.6.1]

/// One conversion as it was read: "%-08.3ll" and "x".
struct Conversion {
  std::string flags;
  int width = -1, precision = -1;
  std::string length;
  char kind = 0;

  /// The same for the host's printf, with its own length.
  std::string for_host(const char* host_length) const {
    std::string text(1, '%');
    text += flags;
    if (width >= 0) text += std::to_string(width);
    if (precision >= 0) {
      text += '.';
      text += std::to_string(precision);
    }
    text += host_length;
    text += kind;
    return text;
  }
};

template <class Value>
std::string print(const std::string& format, Value value) {
  // The format is one conversion that was made by for_host() for this type.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
#pragma GCC diagnostic ignored "-Wformat-security"
  const int size = std::snprintf(nullptr, 0, format.c_str(), value);
  std::string text(static_cast<std::size_t>(std::max(size, 0)) + 1, '\0');
  std::snprintf(text.data(), text.size(), format.c_str(), value);
#pragma GCC diagnostic pop
  text.pop_back();
  return text;
}

/// Reads a conversion; `at` is behind the percent sign and moves behind what was read.
Conversion read_conversion(const std::string& format, std::size_t& at, FormatArguments& arguments) {
  Conversion c;
  const auto is = [&](const char* these) {
    return at < format.size() && format[at] != '\0' &&
           std::string(these).find(format[at]) != std::string::npos;
  };
  const auto number = [&] {
    if (is("*")) {
      ++at;
      return static_cast<int>(arguments.next_word());
    }
    int value = 0;
    while (is("0123456789")) value = std::min(kMostWidth, value * 10 + (format[at++] - '0'));
    return value;
  };
  while (is("-+ #0")) c.flags += format[at++];
  if (is("*0123456789")) c.width = number();
  if (c.width < -1) {
    c.flags += '-';
    c.width = -std::max(c.width, -kMostWidth);
  }
  c.width = std::min(c.width, kMostWidth);
  if (is(".")) {
    ++at;
    c.precision = std::min(number(), kMostWidth);
  }
  while (is("hlLqjzt")) c.length += format[at++];
  if (at < format.size()) c.kind = format[at++];
  return c;
}

/// A character of a wide text, as UTF-8; nothing for a number that stands for none.
std::string utf8(std::uint32_t character) {
  const auto byte = [&](unsigned int head, unsigned int shift, unsigned int mask) {
    return static_cast<char>(head | (character >> shift & mask));
  };
  if (character < 0x80) return {byte(0, 0, 0x7F)};
  if (character < 0x800) return {byte(0xC0, 6, 0x1F), byte(0x80, 0, 0x3F)};
  if (character >= 0xD800 && character < 0xE000) return {};
  if (character < 0x10000) return {byte(0xE0, 12, 0x0F), byte(0x80, 6, 0x3F), byte(0x80, 0, 0x3F)};
  if (character > 0x10FFFF) return {};
  return {byte(0xF0, 18, 0x07), byte(0x80, 12, 0x3F), byte(0x80, 6, 0x3F), byte(0x80, 0, 0x3F)};
}

/// A text in the field of the conversion.
std::string padded(Conversion c, const std::string& text) {
  c.kind = 's';
  c.precision = -1;
  return print(c.for_host(""), text.c_str());
}

/// A wide text up to its zero, as at the longest `most` bytes of UTF-8.
std::string wide_text(std::uint32_t lsa, std::size_t most, const CallMemory& memory) {
  std::string text;
  for (std::uint32_t read = 0; read < dma::kLocalStoreBytes; read += 4) {
    const std::uint32_t character = memory.word(lsa + read);
    const std::string bytes = utf8(character);
    if (character == 0 || text.size() + bytes.size() > most) break;
    text += bytes;
  }
  return text;
}

std::string convert(const Conversion& c, FormatArguments& arguments, const CallMemory& memory) {
  switch (c.kind) {
    case 'd':
    case 'i': {
      if (is_long_long(c.length))
        return print(c.for_host("ll"), static_cast<long long>(arguments.next_doubleword()));
      const auto value = static_cast<int>(arguments.next_word());
      if (c.length == "hh") return print(c.for_host(""), static_cast<int>(static_cast<signed char>(value)));
      return print(c.for_host(""), c.length == "h" ? static_cast<int>(static_cast<short>(value)) : value);
    }
    case 'u':
    case 'o':
    case 'x':
    case 'X': {
      if (is_long_long(c.length))
        return print(c.for_host("ll"), static_cast<unsigned long long>(arguments.next_doubleword()));
      const std::uint32_t value = arguments.next_word();
      return print(c.for_host(""), c.length == "hh"  ? value & 0xFFu
                                   : c.length == "h" ? value & 0xFFFFu
                                                     : value);
    }
    case 'c':
      if (c.length == "l") return padded(c, utf8(arguments.next_word()));
      return print(c.for_host(""), static_cast<int>(arguments.next_word() & 0xFFu));
    case 's': {
      const std::size_t most = c.precision < 0 ? std::string::npos : static_cast<std::size_t>(c.precision);
      if (c.length == "l") return padded(c, wide_text(arguments.next_word(), most, memory));
      return print(c.for_host(""), arguments.text(arguments.next_word(), most).c_str());
    }
    case 'p': {
      Conversion hexadecimal = c;
      hexadecimal.kind = 'x';
      if (hexadecimal.flags.find('#') == std::string::npos) hexadecimal.flags += '#';
      return print(hexadecimal.for_host(""), arguments.local_store_address(arguments.next_word()));
    }
    case 'a':
    case 'A':
    case 'e':
    case 'E':
    case 'f':
    case 'F':
    case 'g':
    case 'G':
      return print(c.for_host(""), arguments.next_double());
    case '%':
      return "%";
    default:
      return {};
  }
}

}  // namespace

bool is_long_long(const std::string& length) {
  return length == "ll" || length == "q" || length == "j" || length == "L";
}

std::uint32_t integer_bytes(const std::string& length) {
  if (length == "hh") return 1;
  if (length == "h") return 2;
  return is_long_long(length) ? 8 : 4;
}

std::string format_text(const std::string& format, FormatArguments& arguments, CallMemory& memory) {
  std::string text;
  for (std::size_t at = 0; at < format.size() && text.size() < kMostText;) {
    if (format[at] != '%') {
      text += format[at++];
    } else {
      const std::size_t begin = at++;
      const Conversion conversion = read_conversion(format, at, arguments);
      if (conversion.kind == 'n') {
        memory.set_value(arguments.next_word(), text.size(), integer_bytes(conversion.length));
        continue;
      }
      constexpr std::string_view kKinds = "diuoxXcspaAeEfFgG%";
      const bool known = conversion.kind != '\0' && kKinds.find(conversion.kind) != std::string_view::npos;
      text += known ? convert(conversion, arguments, memory) : format.substr(begin, at - begin);
    }
  }
  text.resize(std::min(text.size(), kMostText));
  return text;
}

}  // namespace softcell::ls_sim::assisted
