#pragma once
// Reading the text of mesh files: lines, words, numbers, and complaints that name the line.

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace softcell::ppu {

[[noreturn]] inline void refuse(const std::string& problem) { throw std::runtime_error(problem); }

/// A word of a file as it may appear in a message: short, and printable.
inline std::string in_quotes(std::string_view word, std::size_t longest = 24) {
  std::string text = "'";
  for (const char c : word.substr(0, longest)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > longest ? "...'" : "'");
}

/// The same for names of files and extensions, which a user must recognise.
inline std::string name_in_quotes(std::string_view name) { return in_quotes(name, 80); }

/// Takes a text apart into lines of words. Views stay valid as long as the text.
class LineReader {
 public:
  /// @param continuation  a backslash at the end of a line joins the next one to it
  explicit LineReader(std::string_view text, bool continuation = false)
      : rest_(text), continuation_(continuation) {}

  /// Moves to the next line that has a word. @return false at the end of the text.
  bool next() {
    words_.clear();
    while (words_.empty() && !rest_.empty()) {
      bool more = true;
      while (more && !rest_.empty()) more = read_physical_line();
    }
    return !words_.empty();
  }

  const std::vector<std::string_view>& words() const { return words_; }
  std::string_view rest() const { return rest_; }

  [[noreturn]] void refuse(const std::string& problem) const {
    ppu::refuse("line " + std::to_string(line_) + ": " + problem);
  }

  /// A word as a number; NaN and infinity are numbers here.
  double number(std::string_view word) const {
    const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (error == std::errc::invalid_argument || end != digits.data() + digits.size()) {
      refuse(in_quotes(word) + " is not a number");
    }
    // Out of a double's range, too large or too small: which, from_chars does not say.
    return error == std::errc() ? value : std::numeric_limits<double>::infinity();
  }

  /// A word as a number that a float can hold.
  double finite_number(std::string_view word) const {
    const double value = number(word);
    if (!(std::abs(value) <= std::numeric_limits<float>::max())) {
      refuse(in_quotes(word) + " is not a finite number (of at most 3.4e38)");
    }
    return value;
  }

  std::int64_t integer(std::string_view word) const {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size())
      refuse(in_quotes(word) + " is not a whole number");
    return value;
  }

 private:
  /// Appends the next line's words. @return true when it ends with a backslash.
  bool read_physical_line() {
    ++line_;
    const std::size_t end = std::min(rest_.find('\n'), rest_.size());
    std::string_view text = rest_.substr(0, end);
    rest_.remove_prefix(std::min(end + 1, rest_.size()));
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    const bool more = continuation_ && text.ends_with('\\');
    if (more) text.remove_suffix(1);
    for (std::size_t i = 0; i < text.size();) {
      if (is_space(text[i])) {
        ++i;
        continue;
      }
      const std::size_t start = i;
      while (i < text.size() && !is_space(text[i])) ++i;
      words_.push_back(text.substr(start, i - start));
    }
    return more;
  }
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }

  std::string_view rest_;
  bool continuation_;
  std::size_t line_ = 0;
  std::vector<std::string_view> words_;
};

}  // namespace softcell::ppu
