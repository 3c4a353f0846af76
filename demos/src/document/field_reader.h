#pragma once
// Reads the fields of one table of a scene file. All checks of fields and all their error messages are here.
//
//     FieldReader fields(table, "a box");
//     fields.vector("size", box.size, kLength, Need::kRequired)
//         .number("mass", box.mass, kMass)
//         .finish();
//
// A missing field leaves its variable unchanged: the value before is the default. finish() refuses fields that were
// not read, and suggests the one that was probably meant.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "softcell/render/colour.h"
#include "value.h"

namespace softcell::demos {

enum class Need : std::uint8_t { kOptional, kRequired };

/// The values that a number field may have. NaN and infinity are always refused.
struct Range {
  double low, high;
  bool low_excluded = false;
};
inline constexpr double kFar = 1e4;  ///< metres: farther away or larger than this, float positions get coarse
inline constexpr Range kLength{.low = 0, .high = kFar, .low_excluded = true};
inline constexpr Range kCoordinate{.low = -kFar, .high = kFar};
inline constexpr Range kShare{.low = 0, .high = 1};

class FieldReader {
 public:
  /// @param table  must outlive this object   @param what  what error messages call the table: "a box".
  /// @throws SceneError  the value is not a table.
  FieldReader(const Value& table, std::string what);

  FieldReader& number(std::string_view key, float& out, Range range, Need need = Need::kOptional);
  FieldReader& number(std::string_view key, std::optional<float>& out, Range range);
  FieldReader& integer(std::string_view key, int& out, int low, int high, Need need = Need::kOptional);
  FieldReader& flag(std::string_view key, bool& out);
  FieldReader& text(std::string_view key, std::string& out, Need need = Need::kOptional);
  FieldReader& colour(std::string_view key, render::Colour& out);  ///< "#RRGGBB", in sRGB
  /// The same, kept in sRGB instead of converted to linear light.
  FieldReader& painted_colour(std::string_view key, std::optional<Eigen::Vector3f>& out);

  template <int N>
  FieldReader& vector(std::string_view key, Eigen::Matrix<float, N, 1>& out, Range range,
                      Need need = Need::kOptional) {
    std::array<float, N> numbers;
    if (read_numbers(key, numbers, range, need)) out = Eigen::Map<Eigen::Matrix<float, N, 1>>(numbers.data());
    return *this;
  }

  /// One of several texts; `out` becomes its index.
  FieldReader& choice(std::string_view key, std::size_t& out, std::span<const std::string_view> names,
                      Need need = Need::kOptional);

  /// A field that the caller reads itself; null when it is absent.
  const Value* field(std::string_view key, Need need = Need::kOptional);

  /// The items of an array; none when it is absent. @throws SceneError  the field is no array, or has more than `at_most` items.
  std::span<const Value> items(std::string_view key, std::size_t at_most);

  /// @throws SceneError  the table has a field that was never asked for, or lacks a required one.
  void finish() const;

  const Location& location() const { return table_.location; }
  /// The location of a field, or of the table when it is absent.
  const Location& location(std::string_view key) const;
  const std::string& what() const { return what_; }
  /// Location and name of the table, for messages of those who use what was read: "arena.toml:12:1: soft body 3".
  std::string described() const { return to_string(location()) + ": " + what_; }
  bool has(std::string_view key) const { return find(key) != nullptr; }

 private:
  const Value* find(std::string_view key) const;
  std::optional<std::uint32_t> read_colour(std::string_view key);  ///< 0xRRGGBB
  bool read_numbers(std::string_view key, std::span<float> out, Range range, Need need);
  [[noreturn]] void refuse(std::string_view key, const Value& value, const std::string& expected) const;

  const Value& table_;
  std::string what_;
  std::vector<std::string_view> known_;
  std::string missing_;  // the first required field that is absent
};

/// A finite number within the range.
/// @param name  of the number in messages: "mass of a box".
float read_number(const Value& value, const std::string& name, Range range);
/// A whole number from `low` to `high`.
int read_integer(const Value& value, const std::string& name, int low, int high);

/// The entries of a table.
/// @throws SceneError  the value is no table, or is an array where a table was expected.
const Table& as_table(const Value& value, std::string_view what);

}  // namespace softcell::demos
