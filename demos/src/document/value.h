#pragma once
// The contents of a scene file, whatever language it is written in: numbers, texts, arrays and tables, each with the location where it is
// written.

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace softcell::demos {

/// Where something is written. Lines and columns count from 1; 0: not known.
struct Location {
  std::shared_ptr<const std::string> file;
  int line = 0, column = 0;
};

/// "arena.toml:12:3", as far as it is known.
std::string to_string(const Location& location);

struct Value;
struct Field;
using Array = std::vector<Value>;
using Table = std::vector<Field>;  ///< in no particular order, names unique

struct Value {
  std::variant<bool, std::int64_t, double, std::string, Array, Table> data;
  Location location;
};

struct Field {
  std::string name;
  Value value;
};

/// How deep tables and arrays may be nested. A scene needs five levels; all readers refuse deeper ones, because their recursion must end.
inline constexpr int kMaxValueDepth = 32;

/// "a number", "a table", ...
std::string_view kind_of(const Value& value);

/// A scene that cannot be used. The message is one sentence that begins with the location.
class SceneError : public std::runtime_error {
 public:
  SceneError(const Location& location, const std::string& sentence)
      : std::runtime_error(to_string(location) + ": " + sentence) {}
};

}  // namespace softcell::demos
