#pragma once

#include <string>

#include "value.h"

namespace softcell::demos {

/// The value as a TOML document, which parse_toml() reads as the same value. Numbers come first, then tables, then arrays of tables; within
/// a table, `name`, `title`, `dimension` and `kind` come first.
/// @param root  a table
/// @throws std::runtime_error  a text is not UTF-8, which TOML requires
std::string write_toml(const Value& root);

/// A number that, read as a field of floats, gives the same float.
Value number_value(float number);

}  // namespace softcell::demos
