#pragma once

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

namespace softcell::base {

/// Builds JSON text piece by piece. It writes whole numbers only, so that the text depends neither on a
/// locale nor on how a host prints floats. One thread uses one object.
class JsonText {
 public:
  /// Appends text as it is: brackets, commas, names of keys.
  JsonText& raw(std::string_view text) {
    text_ += text;
    return *this;
  }

  /// Writes a whole number.
  JsonText& number(std::int64_t value) {
    char digits[24];
    text_.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
    return *this;
  }

  /// Writes nanoseconds as microseconds with three decimals, the unit of the trace format. Writes 0.000 for a
  /// negative time.
  JsonText& microseconds(std::int64_t nanoseconds);

  /// Writes a quoted string. Bytes that are not UTF-8 become question marks.
  JsonText& string(std::string_view text);

  /// Writes "0x0001F" in quotes, with at least `digits` digits. @pre 0 <= digits <= 16
  JsonText& hex(std::uint64_t value, int digits);

  JsonText& boolean(bool value) { return raw(value ? "true" : "false"); }  ///< true or false

  const std::string& text() const { return text_; }  ///< what was written so far
  void clear() { text_.clear(); }                    ///< begins anew

 private:
  std::string text_;
};

}  // namespace softcell::base
