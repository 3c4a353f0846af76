#include "one_line.h"

#include <fmt/format.h>

namespace softcell::demos {
namespace {

constexpr std::size_t kLongestBeginning = 1500, kLongestEnd = 500;

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

/// Bytes of the UTF-8 character at the beginning of the text, which is not empty; 0 when there is none.
std::size_t character_bytes(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  const std::size_t bytes = lead < 0x80                   ? 1
                            : lead >= 0xC2 && lead < 0xE0 ? 2
                            : lead >= 0xE0 && lead < 0xF0 ? 3
                            : lead >= 0xF0 && lead < 0xF5 ? 4
                                                          : 0;
  if (bytes > text.size()) return 0;
  for (std::size_t i = 1; i < bytes; ++i) {
    if (!continues(text[i])) return 0;
  }
  return bytes;
}

bool is_control(std::string_view character) {
  const auto first = static_cast<unsigned char>(character.front());
  if (character.size() == 1) return first < 0x20 || first == 0x7F;
  return first == 0xC2 && static_cast<unsigned char>(character[1]) < 0xA0;
}

std::string shortened(const std::string& text) {
  if (text.size() <= kLongestBeginning + kLongestEnd) return text;
  std::size_t beginning = kLongestBeginning, end = text.size() - kLongestEnd;
  while (continues(text[beginning])) --beginning;
  while (continues(text[end])) ++end;
  return text.substr(0, beginning) + " ... " + text.substr(end);
}

}  // namespace

std::string one_line(std::string_view sentence) {
  std::string text;
  while (!sentence.empty()) {
    const std::size_t known = character_bytes(sentence);
    const std::string_view character = sentence.substr(0, known == 0 ? 1 : known);
    sentence.remove_prefix(character.size());
    if (character == "\n" || character == "\t") {
      text += ' ';
    } else if (known != 0 && !is_control(character)) {
      text += character;
    } else {
      for (const char c : character) text += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    }
  }
  return shortened(text);
}

}  // namespace softcell::demos
