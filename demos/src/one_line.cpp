#include "one_line.h"

#include <fmt/format.h>

#include "softcell/ls_sim/utf8.h"

namespace softcell::demos {
namespace {

constexpr std::size_t kLongestBeginning = 1500, kLongestEnd = 500;

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

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
    const std::size_t known = ls_sim::utf8_length(sentence, 0);
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
