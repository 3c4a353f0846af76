#include "field_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "softcell/base/assert.h"
#include "softcell/base/nearest_name.h"

namespace softcell::demos {
namespace {

std::string describe(Range range) {
  return range.low_excluded ? fmt::format("a number above {} and at most {}", range.low, range.high)
                            : fmt::format("a number from {} to {}", range.low, range.high);
}

std::string shown(const Value& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) return fmt::format("{}", *integer);
  if (const auto* real = std::get_if<double>(&value.data)) return fmt::format("{}", *real);
  if (const auto* flag = std::get_if<bool>(&value.data)) return *flag ? "true" : "false";
  if (const auto* text = std::get_if<std::string>(&value.data)) {
    constexpr std::size_t kShown = 40;
    return text->size() <= kShown ? "'" + *text + "'" : "'" + text->substr(0, kShown) + "...'";
  }
  if (const auto* array = std::get_if<Array>(&value.data))
    return fmt::format("an array of {}", array->size());
  return std::string(kind_of(value));
}

std::optional<double> number_in(const Value& value) {
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) return static_cast<double>(*integer);
  if (const auto* real = std::get_if<double>(&value.data)) return *real;
  return std::nullopt;
}

std::optional<float> number_within(const Value& value, Range range) {
  SC_ASSERT(range.low <= range.high, "a range from {} to {}", range.low, range.high);
  const auto number = number_in(value);
  if (!number || !std::isfinite(*number)) return std::nullopt;
  const auto single = static_cast<float>(*number);  // the float that is used must be in range as well
  const auto inside = [&](double x) {
    return x <= range.high && (range.low_excluded ? x > range.low : x >= range.low);
  };
  if (!inside(*number) || (range.low_excluded && !inside(double{single}))) return std::nullopt;
  // A number that is not 0 does not become 0, since a mass of 0 does not move.
  return single == 0 && *number != 0 ? std::nextafter(0.0f, *number > 0 ? 1.0f : -1.0f) : single;
}

std::string list(std::span<const std::string_view> names) {
  std::string text;
  for (const std::string_view name : names) text += (text.empty() ? "" : ", ") + std::string(name);
  return text;
}

[[noreturn]] void refuse_value(const Value& value, const std::string& name, const std::string& expected) {
  throw SceneError(value.location, fmt::format("{} is {}; it must be {}", name, shown(value), expected));
}

}  // namespace

float read_number(const Value& value, const std::string& name, Range range) {
  if (const auto number = number_within(value, range)) return *number;
  refuse_value(value, name, describe(range));
}

int read_integer(const Value& value, const std::string& name, int low, int high) {
  SC_ASSERT(low <= high, "{} is from {} to {}", name, low, high);
  const auto number = number_in(value);
  // In Lua a user sees one kind of number: 3.0 is a whole number.
  if (!number || *number < low || *number > high || std::floor(*number) != *number) {
    refuse_value(value, name, fmt::format("a whole number from {} to {}", low, high));
  }
  return static_cast<int>(*number);
}

const Table& as_table(const Value& value, std::string_view what) {
  if (const auto* table = std::get_if<Table>(&value.data)) return *table;
  throw SceneError(value.location, fmt::format("{} must be a table, and is {}", what, kind_of(value)));
}

FieldReader::FieldReader(const Value& table, std::string what) : table_(table), what_(std::move(what)) {
  as_table(table, what_);
}

const Value* FieldReader::find(std::string_view key) const {
  for (const auto& [name, value] : std::get<Table>(table_.data)) {
    if (name == key) return &value;
  }
  return nullptr;
}

const Value* FieldReader::field(std::string_view key, Need need) {
  SC_ASSERT(!key.empty(), "a field of {} without a name", what_);
  known_.push_back(key);
  const Value* value = find(key);
  // finish() reports it: if the field is there under a wrong name, its message is better.
  if (value == nullptr && need == Need::kRequired && missing_.empty()) missing_ = key;
  return value;
}

const Location& FieldReader::location(std::string_view key) const {
  const Value* value = find(key);
  return value != nullptr ? value->location : table_.location;
}

void FieldReader::refuse(std::string_view key, const Value& value, const std::string& expected) const {
  refuse_value(value, fmt::format("{} of {}", key, what_), expected);
}

FieldReader& FieldReader::number(std::string_view key, float& out, Range range, Need need) {
  if (const Value* value = field(key, need)) {
    out = read_number(*value, fmt::format("{} of {}", key, what_), range);
  }
  return *this;
}

FieldReader& FieldReader::number(std::string_view key, std::optional<float>& out, Range range) {
  float value = 0;
  number(key, value, range);
  if (has(key)) out = value;
  return *this;
}

FieldReader& FieldReader::integer(std::string_view key, int& out, int low, int high, Need need) {
  if (const Value* value = field(key, need)) {
    out = read_integer(*value, fmt::format("{} of {}", key, what_), low, high);
  }
  return *this;
}

FieldReader& FieldReader::flag(std::string_view key, bool& out) {
  if (const Value* value = field(key)) {
    const auto* given = std::get_if<bool>(&value->data);
    if (given == nullptr) refuse(key, *value, "true or false");
    out = *given;
  }
  return *this;
}

FieldReader& FieldReader::text(std::string_view key, std::string& out, Need need) {
  if (const Value* value = field(key, need)) {
    const auto* given = std::get_if<std::string>(&value->data);
    if (given == nullptr) refuse(key, *value, "a text");
    out = *given;
  }
  return *this;
}

std::optional<std::uint32_t> FieldReader::read_colour(std::string_view key) {
  const Value* value = field(key);
  if (value == nullptr) return std::nullopt;
  const auto* given = std::get_if<std::string>(&value->data);
  const auto is_hex = [](char c) { return std::isxdigit(static_cast<unsigned char>(c)) != 0; };
  if (given == nullptr || given->size() != 7 || given->front() != '#' ||
      !std::all_of(given->begin() + 1, given->end(), is_hex)) {
    refuse(key, *value, "a colour, such as \"#D26A35\"");
  }
  return static_cast<std::uint32_t>(std::stoul(given->substr(1), nullptr, 16));
}

FieldReader& FieldReader::colour(std::string_view key, render::Colour& out) {
  if (const auto rrggbb = read_colour(key)) out = render::srgb(*rrggbb);
  return *this;
}

FieldReader& FieldReader::painted_colour(std::string_view key, std::optional<Eigen::Vector3f>& out) {
  const auto rrggbb = read_colour(key);
  if (!rrggbb) return *this;
  out.emplace();
  for (int i = 0; i < 3; ++i) (*out)[i] = static_cast<float>(*rrggbb >> (16 - 8 * i) & 0xFFu) / 255.0f;
  return *this;
}

bool FieldReader::read_numbers(std::string_view key, std::span<float> out, Range range, Need need) {
  SC_ASSERT(!out.empty(), "{} of {} is an array of no numbers", key, what_);
  const Value* value = field(key, need);
  if (value == nullptr) return false;
  const auto* array = std::get_if<Array>(&value->data);
  if (array == nullptr || array->size() != out.size()) {
    refuse(key, *value, fmt::format("an array of {} numbers", out.size()));
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = read_number((*array)[i], fmt::format("number {} in {} of {}", i + 1, key, what_), range);
  }
  return true;
}

FieldReader& FieldReader::choice(std::string_view key, std::size_t& out,
                                 std::span<const std::string_view> names, Need need) {
  const Value* value = field(key, need);
  if (value == nullptr) return *this;
  SC_ASSERT(!names.empty(), "{} of {} has no names to choose from", key, what_);
  const auto* given = std::get_if<std::string>(&value->data);
  const auto found = given != nullptr ? std::find(names.begin(), names.end(), *given) : names.end();
  if (found == names.end()) refuse(key, *value, "one of " + list(names));
  out = static_cast<std::size_t>(found - names.begin());
  return *this;
}

std::span<const Value> FieldReader::items(std::string_view key, std::size_t at_most) {
  const Value* value = field(key);
  if (value == nullptr) return {};
  const auto* array = std::get_if<Array>(&value->data);
  // An empty table in Lua is an empty array as well.
  if (const auto* table = std::get_if<Table>(&value->data); table != nullptr && table->empty()) return {};
  if (array == nullptr) refuse(key, *value, "an array");
  if (array->size() > at_most) {
    throw SceneError(value->location, fmt::format("{} has {} {}; {} are the most that a scene may have",
                                                  what_, array->size(), key, at_most));
  }
  return *array;
}

void FieldReader::finish() const {
  for (const auto& [name, value] : std::get<Table>(table_.data)) {
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    const std::string_view meant = base::nearest_name(name, known_);
    throw SceneError(value.location, meant.empty() ? fmt::format("{} has no field '{}'; it has {}", what_,
                                                                 name.substr(0, 64), list(known_))
                                                   : fmt::format("{} has no field '{}'; did you mean '{}'?",
                                                                 what_, name, meant));
  }
  if (!missing_.empty())
    throw SceneError(table_.location, fmt::format("{} needs the field '{}'", what_, missing_));
}

}  // namespace softcell::demos
