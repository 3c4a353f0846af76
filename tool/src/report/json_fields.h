#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

namespace softcell::tool {

/// Reads an object of a file field by field. Refuses a field that is missing, of another type or out of range with a std::runtime_error
/// that says where it is, what was found and what is expected.
class JsonFields {
 public:
  /// @param where  the object's name in messages: "traceEvents[3]".
  JsonFields(const nlohmann::json& object, std::string where);

  std::uint64_t integer(const char* key, std::uint64_t least, std::uint64_t most) const;
  bool boolean(const char* key) const;
  std::string text(const char* key) const;

  /// A number written as a string, "0x5EA010000080".
  std::uint64_t hex(const char* key, std::uint64_t most) const;

  /// Nanoseconds, from a number of microseconds.
  std::int64_t time(const char* key) const;

  const nlohmann::json& array(const char* key) const;
  JsonFields object(const char* key) const;
  bool has(const char* key) const { return object_.contains(key); }
  bool is_null(const char* key) const { return field(key).is_null(); }

  [[noreturn]] void refuse(const std::string& what) const;

 private:
  const nlohmann::json& field(const char* key) const;
  [[noreturn]] void refuse_field(const char* key, const std::string& expected) const;

  const nlohmann::json& object_;
  std::string where_;
};

}  // namespace softcell::tool
