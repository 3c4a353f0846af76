#include "scan.h"

#include <algorithm>
#include <bit>
#include <cctype>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <string_view>
#include <vector>

namespace softcell::ls_sim::assisted {
namespace {

/// One conversion as it was read: "%*5lld", "%[^,]".
struct ScanConversion {
  bool stores = true;
  std::size_t width = 0;  ///< 0: none was said
  std::string length;
  char kind = 0;
  std::string set;  ///< of '[': from the bracket on
};

/// Reads a conversion; `at` is behind the percent sign and moves behind what was read.
ScanConversion read_scan_conversion(const std::string& format, std::size_t& at) {
  ScanConversion c;
  const auto is = [&](const std::string& these) {
    return at < format.size() && these.find(format[at]) != std::string::npos;
  };
  if (is("*")) c.stores = false, ++at;
  while (is("0123456789")) {
    c.width = std::min<std::size_t>(c.width * 10 + static_cast<std::size_t>(format[at++] - '0'),
                                    dma::kLocalStoreBytes);
  }
  while (is("hlLqjzt")) c.length += format[at++];
  if (at < format.size()) c.kind = format[at++];
  if (c.kind == '[') {
    const std::size_t begin = at - 1;
    if (is("^")) ++at;
    if (is("]")) ++at;  // as the first of the set it does not end it
    while (at < format.size() && format[at] != ']') ++at;
    if (at == format.size()) return {};
    c.set = format.substr(begin, ++at - begin);
  }
  return c;
}

/// One conversion by the host's scanf, given without its percent sign; counts what it reads.
template <class Value>
int scan_one(std::FILE* from, const std::string& conversion, Value* value, long long& consumed) {
  int used = 0;
  std::string format(1, '%');
  format += conversion;
  format += "%n";
  // The format is one conversion that was made for this type.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wformat-nonliteral"
#pragma GCC diagnostic ignored "-Wformat-security"
  const int stored = std::fscanf(from, format.c_str(), value, &used);
#pragma GCC diagnostic pop
  consumed += used;
  return stored;
}

/// The characters of UTF-8; a byte that belongs to none is one of its own.
std::vector<std::uint32_t> wide(std::string_view text) {
  std::vector<std::uint32_t> characters;
  for (std::size_t at = 0; at < text.size();) {
    const auto head = static_cast<std::uint8_t>(text[at++]);
    std::size_t more = head >= 0xF0 ? 3 : head >= 0xE0 ? 2 : head >= 0xC0 ? 1 : 0;
    more = at + more <= text.size() ? more : 0;
    std::uint32_t character = more == 0 ? head : head & (0x3Fu >> more);
    for (; more > 0; --more) character = character << 6 | (static_cast<std::uint8_t>(text[at++]) & 0x3Fu);
    characters.push_back(character);
  }
  return characters;
}

class Scan {
 public:
  Scan(std::FILE* from, FormatArguments& arguments, CallMemory& memory)
      : from_(from), arguments_(arguments), memory_(memory) {}

  int run(const std::string& format) {
    for (std::size_t at = 0; at < format.size();) {
      const auto letter = static_cast<unsigned char>(format[at]);
      if (std::isspace(letter) != 0) {
        skip_space();
        ++at;
      } else if (letter != '%') {
        if (!match(letter)) return result();
        ++at;
      } else {
        const ScanConversion c = read_scan_conversion(format, ++at);
        if (!convert(c)) return result();
      }
    }
    return stored_;
  }

 private:
  int result() const { return stored_ == 0 && ended_ ? EOF : stored_; }

  void skip_space() {
    int letter = std::getc(from_);
    for (; letter != EOF && std::isspace(letter) != 0; letter = std::getc(from_)) ++consumed_;
    if (letter != EOF) std::ungetc(letter, from_);
  }

  bool match(int wanted) {
    const int letter = std::getc(from_);
    if (letter == wanted) return ++consumed_, true;
    ended_ = letter == EOF;
    if (letter != EOF) std::ungetc(letter, from_);
    return false;
  }

  bool convert(const ScanConversion& c) {
    switch (c.kind) {
      case '%':
        skip_space();
        return match('%');
      case 'n':
        if (c.stores)
          memory_.set_value(arguments_.next_word(), static_cast<std::uint64_t>(consumed_),
                            integer_bytes(c.length));
        return true;
      case 'd':
      case 'i':
      case 'u':
      case 'o':
      case 'x':
      case 'X':
      case 'p':
        return integer(c);
      case 'a':
      case 'A':
      case 'e':
      case 'E':
      case 'f':
      case 'F':
      case 'g':
      case 'G':
        return real(c);
      case 'c':
        return characters(c);
      case 's':
      case '[':
        return text(c);
      default:
        return false;
    }
  }

  static std::string width_of(const ScanConversion& c) { return c.width == 0 ? "" : std::to_string(c.width); }

  /// @return  whether there is a value, which has been counted if it is to be stored
  bool got_one(const ScanConversion& c, int scanned) {
    ended_ = scanned == EOF;
    if (scanned != 1) return false;
    if (c.stores) ++stored_;
    return true;
  }

  bool integer(const ScanConversion& c) {
    unsigned long long value = 0;
    const char kind = c.kind == 'p' ? 'x' : c.kind;
    if (!got_one(c, scan_one(from_, width_of(c) + "ll" + kind, &value, consumed_))) return false;
    if (c.stores)
      memory_.set_value(arguments_.next_word(), value, c.kind == 'p' ? 4 : integer_bytes(c.length));
    return true;
  }

  bool real(const ScanConversion& c) {
    double value = 0;
    if (!got_one(c, scan_one(from_, width_of(c) + "lf", &value, consumed_))) return false;
    if (!c.stores) return true;
    if (c.length.empty())
      memory_.set_word(arguments_.next_word(), std::bit_cast<std::uint32_t>(static_cast<float>(value)));
    else
      memory_.set_value(arguments_.next_word(), std::bit_cast<std::uint64_t>(value), 8);
    return true;
  }

  bool characters(const ScanConversion& c) {
    std::string found;
    const std::size_t width = std::max<std::size_t>(c.width, 1);
    while (found.size() < width) {
      const int letter = std::getc(from_);
      if (letter == EOF) break;
      found += static_cast<char>(letter);
    }
    consumed_ += static_cast<long long>(found.size());
    if (!got_one(c, found.empty() ? EOF : 1)) return false;
    if (c.stores) store(c, found);
    return true;
  }

  bool text(const ScanConversion& c) {
    char* found = nullptr;
    const std::size_t width = c.width != 0 ? c.width : dma::kLocalStoreBytes - 1;
    const std::string kind = c.kind == '[' ? c.set : std::string(1, c.kind);
    const int scanned = scan_one(from_, std::to_string(width) + "m" + kind, &found, consumed_);
    const std::unique_ptr<char, decltype(&std::free)> owner(found, &std::free);
    if (!got_one(c, scanned)) return false;
    if (!c.stores) return true;
    const std::string_view letters(found);
    const std::uint32_t end = store(c, letters);
    memory_.set_value(end, 0, c.length == "l" ? 4 : 1);
    return true;
  }

  /// Stores a text, without a zero at its end. @return  the address behind it
  std::uint32_t store(const ScanConversion& c, std::string_view letters) {
    std::uint32_t to = arguments_.next_word();
    if (c.length != "l")
      return memory_.set_bytes(to, letters), to + static_cast<std::uint32_t>(letters.size());
    for (const std::uint32_t character : wide(letters)) {
      memory_.set_word(to, character);
      to += 4;
    }
    return to;
  }

  std::FILE* from_;
  FormatArguments& arguments_;
  CallMemory& memory_;
  long long consumed_ = 0;
  int stored_ = 0;
  bool ended_ = false;
};

}  // namespace

int scan_stream(std::FILE* from, const std::string& format, FormatArguments& arguments, CallMemory& memory) {
  return Scan(from, arguments, memory).run(format);
}

}  // namespace softcell::ls_sim::assisted
