#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

namespace softcell::base {

/// Builds JSON text piece by piece. Whole numbers only: what is written does not depend on a locale or on how
/// a host prints floats.
class JsonText {
 public:
  JsonText& raw(std::string_view text) {
    text_ += text;
    return *this;
  }

  JsonText& number(std::int64_t value) {
    char digits[24];
    text_.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
    return *this;
  }

  /// Microseconds with three decimals from nanoseconds, as the trace format counts time. Never negative.
  JsonText& microseconds(std::int64_t nanoseconds);

  /// A quoted string; bytes that are no UTF-8 become question marks.
  JsonText& string(std::string_view text);

  /// "0x0001F", with at least so many digits.
  JsonText& hex(std::uint64_t value, int digits);

  JsonText& boolean(bool value) { return raw(value ? "true" : "false"); }

  const std::string& text() const { return text_; }
  void clear() { text_.clear(); }

 private:
  std::string text_;
};

}  // namespace softcell::base
