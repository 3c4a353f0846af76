#include "write_toml.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::demos {
namespace {

std::string toml_text(std::string_view text) {
  std::string result = "\"";
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t length = base::utf8_length(text, i);
    if (length == 0)
      throw std::runtime_error(
          fmt::format("the text '{}' cannot be saved: it is not UTF-8", base::one_line(text)));
    const auto first = static_cast<unsigned char>(text[i]);
    if (first == '"' || first == '\\') {
      result += '\\';
      result += text[i];
    } else if (first < 0x20 || first == 0x7f) {
      fmt::format_to(std::back_inserter(result), "\\u{:04X}", first);
    } else {
      result += text.substr(i, length);
    }
    i += length;
  }
  return result + '"';
}

std::string key_text(const std::string& name) {
  const bool bare = !name.empty() && std::ranges::all_of(name, [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
  });
  return bare ? name : toml_text(name);
}

/// The table's fields in the order in which they are written: first these four, then the others by name.
std::vector<const Field*> in_order(const Table& table) {
  constexpr std::array<std::string_view, 4> kFirst{"name", "title", "dimension", "kind"};
  std::vector<const Field*> fields;
  for (const Field& field : table) fields.push_back(&field);
  std::ranges::sort(fields, [&](const Field* a, const Field* b) {
    const auto rank = [&](const Field* field) {
      return std::ranges::find(kFirst, field->name) - kFirst.begin();
    };
    return std::pair(rank(a), std::string_view(a->name)) < std::pair(rank(b), std::string_view(b->name));
  });
  return fields;
}

bool is_table(const Value& value) { return std::holds_alternative<Table>(value.data); }
bool is_array_of_tables(const Value& value) {
  const auto* const array = std::get_if<Array>(&value.data);
  return array != nullptr && !array->empty() && std::ranges::all_of(*array, is_table);
}

std::string inline_value(const Value& value);

std::string inline_array(const Array& array) {
  // One can recognise a picture in text only if its rows stand below each other.
  const bool lines = array.size() > 1 && std::ranges::all_of(array, [](const Value& item) {
                       return std::holds_alternative<std::string>(item.data);
                     });
  std::string result = "[";
  for (std::size_t i = 0; i < array.size(); ++i) {
    if (lines) result += "\n  ";
    result += inline_value(array[i]);
    if (lines || i + 1 < array.size()) result += lines ? "," : ", ";
  }
  return result + (lines ? "\n]" : "]");
}

std::string inline_value(const Value& value) {
  if (const auto* flag = std::get_if<bool>(&value.data)) return *flag ? "true" : "false";
  if (const auto* integer = std::get_if<std::int64_t>(&value.data)) return fmt::format("{}", *integer);
  if (const auto* number = std::get_if<double>(&value.data)) {
    SC_ASSERT(std::isfinite(*number), "the number {} of a scene", *number);
    const std::string text = fmt::format("{}", *number);
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
  }
  if (const auto* text = std::get_if<std::string>(&value.data)) return toml_text(*text);
  if (const auto* array = std::get_if<Array>(&value.data)) return inline_array(*array);
  std::string result = "{";
  for (const Field* field : in_order(std::get<Table>(value.data)))
    result += fmt::format("{}{} = {}", result.size() > 1 ? ", " : " ", key_text(field->name),
                          inline_value(field->value));
  return result + " }";
}

void append_field(std::string& text, const Field& field) {
  text += fmt::format("{} = {}\n", key_text(field.name), inline_value(field.value));
}

}  // namespace

std::string write_toml(const Value& root) {
  SC_ASSERT(is_table(root), "a TOML document is {}", kind_of(root));
  const std::vector<const Field*> fields = in_order(std::get<Table>(root.data));
  std::string text;
  for (const Field* field : fields)
    if (!is_table(field->value) && !is_array_of_tables(field->value)) append_field(text, *field);
  const auto append_table = [&](const std::string& heading, const Value& table) {
    text += fmt::format("\n{}\n", heading);
    for (const Field* field : in_order(std::get<Table>(table.data))) append_field(text, *field);
  };
  for (const Field* field : fields) {
    if (!is_table(field->value)) continue;
    const auto& table = std::get<Table>(field->value.data);
    const std::string key = key_text(field->name);
    if (!table.empty() &&
        std::ranges::all_of(table, is_table, &Field::value)) {  // tables of tables, such as materials
      for (const Field& inner : table)
        append_table(fmt::format("[{}.{}]", key, key_text(inner.name)), inner.value);
    } else {
      append_table(fmt::format("[{}]", key), field->value);
    }
  }
  for (const Field* field : fields) {
    if (!is_array_of_tables(field->value)) continue;
    for (const Value& item : std::get<Array>(field->value.data))
      append_table(fmt::format("[[{}]]", key_text(field->name)), item);
  }
  return text;
}

Value number_value(float number) {
  SC_ASSERT(std::isfinite(number), "the number {} of a scene", number);
  // The shortest text of the float, not that of its double, whose digits nobody would recognise.
  const std::string text = fmt::format("{}", number);
  double shortest = 0;
  std::from_chars(text.data(), text.data() + text.size(), shortest);
  return {.data = shortest, .location = {}};
}

}  // namespace softcell::demos
