#include "documents.h"
#include "softcell/base/assert.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <memory>
#include <string>
#include <string_view>

namespace softcell::demos {
namespace {

/// The position after the string that begins at `begin`; the end of the text if the string has no end.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  SC_ASSERT(begin < text.size() && (text[begin] == '"' || text[begin] == '\''),
            "no string begins at {} of {}", begin, text.size());
  const char quote = text[begin];
  const std::string three(3, quote);
  const bool many_lines = text.substr(begin).starts_with(three);
  const std::string_view end = many_lines ? std::string_view(three) : text.substr(begin, 1);
  for (std::size_t i = begin + end.size(); i < text.size(); ++i) {
    if (text.substr(i).starts_with(end)) {
      i += end.size();
      // A text in three quotes may end with two quotes of its own.
      for (int more = 0; many_lines && more < 2 && text.substr(i).starts_with(quote); ++more) ++i;
      return i;
    }
    if (text[i] == '\\' && quote == '"') ++i;
    if (text[i] == '\n' && !many_lines) return i;  // a mistake, which toml++ will report
  }
  return text.size();
}

/// toml++ makes and destroys nested tables by recursion, and does not limit names with dots: a name of a million parts would end the
/// process.
void refuse_deep_nesting(std::string_view text, const std::shared_ptr<const std::string>& file) {
  int brackets = 0, dots = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    switch (text[i]) {
      case '"':
      case '\'':
        i = end_of_string(text, i) - 1;
        break;
      case '#':
        i = std::min(text.find('\n', i), text.size()) - 1;
        break;
      case '.':
        ++dots;
        break;
      case '[':
      case '{':
        ++brackets, dots = 0;
        break;
      case ']':
      case '}':
        --brackets, dots = 0;
        break;
      case '=':
      case ',':
      case '\n':
        dots = 0;
        break;
    }
    if (brackets <= kMaxValueDepth && dots <= kMaxValueDepth) continue;
    const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(i), '\n');
    throw SceneError({file, static_cast<int>(line), 0},
                     fmt::format("tables or arrays are nested more than {} deep", kMaxValueDepth));
  }
}

Location location_of(const toml::source_region& region, const std::shared_ptr<const std::string>& file) {
  return {file, static_cast<int>(region.begin.line), static_cast<int>(region.begin.column)};
}

Value convert(const toml::node& node, const std::shared_ptr<const std::string>& file) {
  Value value{.data = false, .location = location_of(node.source(), file)};
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
      // The location of a field is that of its name. A table in brackets already begins at its name.
      if (key.source().begin.line > 0) table.back().value.location = location_of(key.source(), file);
    }
    value.data = std::move(table);
  } else {
    throw SceneError(value.location, "a scene has no dates or times");
  }
  return value;
}

}  // namespace

Value parse_toml(std::string_view text, const std::shared_ptr<const std::string>& file) {
  refuse_deep_nesting(text, file);
  try {
    return convert(toml::parse(text), file);
  } catch (const toml::parse_error& error) {
    throw SceneError(location_of(error.source(), file), std::string(error.description()));
  }
}

}  // namespace softcell::demos
