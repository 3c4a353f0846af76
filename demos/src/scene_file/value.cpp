#include "value.h"

#include <fmt/format.h>

#include <array>

namespace softcell::demos {

std::string to_string(const Place& place) {
  std::string text = place.file ? *place.file : "scene";
  if (place.line > 0) text += fmt::format(":{}", place.line);
  if (place.line > 0 && place.column > 0) text += fmt::format(":{}", place.column);
  return text;
}

std::string_view kind_of(const Value& value) {
  constexpr std::array<std::string_view, 6> kinds{"true or false", "a number", "a number",
                                                  "a text",        "an array", "a table"};
  return kinds[value.data.index()];
}

}  // namespace softcell::demos
