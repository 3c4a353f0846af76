#include "value.h"
#include "softcell/base/assert.h"

#include <fmt/format.h>

#include <array>

namespace softcell::demos {

std::string to_string(const Location& location) {
  std::string text = location.file ? *location.file : "scene";
  if (location.line > 0) text += fmt::format(":{}", location.line);
  if (location.line > 0 && location.column > 0) text += fmt::format(":{}", location.column);
  return text;
}

std::string_view kind_of(const Value& value) {
  constexpr std::array<std::string_view, 6> kinds{"true or false", "a number", "a number",
                                                  "a text",        "an array", "a table"};
  SC_ASSERT(value.data.index() < kinds.size(), "a value of kind {} of {}", value.data.index(), kinds.size());
  return kinds[value.data.index()];
}

}  // namespace softcell::demos
