#pragma once
// Functions that change tables of a scene's document.

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include "value.h"
#include "write_toml.h"

namespace softcell::demos {

/// Null: the table has no such field.
inline Value* find_field(Table& table, std::string_view name) {
  const auto found = std::ranges::find(table, name, &Field::name);
  return found == table.end() ? nullptr : &found->value;
}

inline void set_field(Table& table, const std::string& name, Value value) {
  if (Value* const known = find_field(table, name)) {
    *known = std::move(value);
  } else {
    table.push_back({name, std::move(value)});
  }
}

inline void erase_fields(Table& table, std::initializer_list<std::string_view> names) {
  std::erase_if(table,
                [&](const Field& field) { return std::ranges::find(names, field.name) != names.end(); });
}

/// The table in the field; it is created if there is none.
inline Table& table_in(Table& table, const std::string& name) {
  if (find_field(table, name) == nullptr) set_field(table, name, {.data = Table{}, .location = {}});
  return std::get<Table>(find_field(table, name)->data);
}

/// The items of the field's array. Null: there is no such field, or it is an empty table, which Lua uses for an empty array.
inline Array* items_in(Table& table, std::string_view name) {
  Value* const value = find_field(table, name);
  return value == nullptr ? nullptr : std::get_if<Array>(&value->data);
}

inline Value integer_value(std::int64_t number) { return {.data = number, .location = {}}; }
inline Value text_value(std::string_view text) { return {.data = std::string(text), .location = {}}; }
template <class Vector>
Value vector_value(const Vector& vector) {
  Array numbers;
  for (int i = 0; i < vector.size(); ++i) numbers.push_back(number_value(vector[i]));
  return {.data = std::move(numbers), .location = {}};
}

}  // namespace softcell::demos
