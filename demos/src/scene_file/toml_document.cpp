#include "toml_document.h"

#include <toml++/toml.h>

namespace softcell::demos {
namespace {

Place place_of(const toml::source_region& region, const std::shared_ptr<const std::string>& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

Value convert(const toml::node& node, const std::shared_ptr<const std::string>& file) {
  Value value{.data = false, .place = place_of(node.source(), file)};
  if (const auto* flag = node.as_boolean()) {
    value.data = flag->get();
  } else if (const auto* integer = node.as_integer()) {
    value.data = integer->get();
  } else if (const auto* real = node.as_floating_point()) {
    value.data = real->get();
  } else if (const auto* text = node.as_string()) {
    value.data = text->get();
  } else if (const auto* items = node.as_array()) {
    Array array;
    for (const toml::node& item : *items) array.push_back(convert(item, file));
    value.data = std::move(array);
  } else if (const auto* entries = node.as_table()) {
    Table table;
    for (const auto& [key, entry] : *entries) {
      table.push_back({std::string(key.str()), convert(entry, file)});
      // The place of a field is that of its name; a table in brackets already begins there.
      if (key.source().begin.line > 0) table.back().value.place = place_of(key.source(), file);
    }
    value.data = std::move(table);
  } else {
    throw SceneError(value.place, "a scene has no dates or times");
  }
  return value;
}

}  // namespace

Value parse_toml(std::string_view text, const std::shared_ptr<const std::string>& file) {
  try {
    return convert(toml::parse(text), file);
  } catch (const toml::parse_error& error) {
    throw SceneError(place_of(error.source(), file), std::string(error.description()));
  }
}

}  // namespace softcell::demos
