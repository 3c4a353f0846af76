#include "json_fields.h"
#include "softcell/base/assert.h"

#include <charconv>
#include <cmath>
#include <stdexcept>

namespace softcell::tool {
namespace {

constexpr std::size_t kMostCharacters = 4096;
constexpr double kMostMicroseconds = 4e12;  // about 46 days: a double holds nanoseconds exactly up to there

/// A value in the form in which messages show it: cut if it is long.
std::string shown(const nlohmann::json& value) {
  if (value.is_structured()) return value.is_array() ? "an array" : "an object";
  std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  if (text.size() > 40) text = text.substr(0, 40) + "...";
  return text;
}

}  // namespace

JsonFields::JsonFields(const nlohmann::json& object, std::string where)
    : object_(object), where_(std::move(where)) {
  if (!object.is_object()) refuse("it is " + shown(object) + "; an object is expected");
}

void JsonFields::refuse(const std::string& what) const { throw std::runtime_error(where_ + ": " + what); }

void JsonFields::refuse_field(const char* key, const std::string& expected) const {
  refuse("\"" + std::string(key) + "\" is " + shown(field(key)) + "; " + expected + " is expected");
}

const nlohmann::json& JsonFields::field(const char* key) const {
  const auto found = object_.find(key);
  if (found == object_.end()) refuse("\"" + std::string(key) + "\" is missing");
  return *found;
}

std::uint64_t JsonFields::integer(const char* key, std::uint64_t least, std::uint64_t most) const {
  SC_ASSERT(least <= most, "\"{}\" is from {} to {}", key, least, most);
  const nlohmann::json& value = field(key);
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() < least ||
      value.get<std::uint64_t>() > most) {
    refuse_field(key, "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
  }
  return value.get<std::uint64_t>();
}

bool JsonFields::boolean(const char* key) const {
  const nlohmann::json& value = field(key);
  if (!value.is_boolean()) refuse_field(key, "true or false");
  return value.get<bool>();
}

std::string JsonFields::text(const char* key) const {
  const nlohmann::json& value = field(key);
  if (!value.is_string() || value.get_ref<const std::string&>().size() > kMostCharacters) {
    refuse_field(key, "a string of at most " + std::to_string(kMostCharacters) + " characters");
  }
  return value.get<std::string>();
}

std::uint64_t JsonFields::hex(const char* key, std::uint64_t most) const {
  const std::string written = text(key);
  std::uint64_t value = 0;
  const char* const end = written.data() + written.size();
  const bool prefixed = written.starts_with("0x");
  const auto parsed = std::from_chars(written.data() + (prefixed ? 2 : 0), end, value, 16);
  if (!prefixed || parsed.ec != std::errc() || parsed.ptr != end || value > most) {
    char digits[16];
    const auto last = std::to_chars(digits, digits + sizeof digits, most, 16).ptr;
    refuse_field(key, "an address such as \"0x00400\", at most 0x" + std::string(digits, last));
  }
  return value;
}

std::int64_t JsonFields::time(const char* key) const {
  const nlohmann::json& value = field(key);
  const double microseconds = value.is_number() ? value.get<double>() : -1;
  if (!(microseconds >= 0 && microseconds <= kMostMicroseconds)) {
    refuse_field(key, "a time in microseconds from 0 to 4e12");
  }
  return std::llround(microseconds * 1000);
}

const nlohmann::json& JsonFields::array(const char* key) const {
  const nlohmann::json& value = field(key);
  if (!value.is_array()) refuse_field(key, "an array");
  return value;
}

JsonFields JsonFields::object(const char* key) const { return {field(key), where_ + "." + key}; }

}  // namespace softcell::tool
