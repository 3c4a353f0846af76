#pragma once

#include <span>
#include <string>
#include <string_view>

namespace softcell::base {

/// The name in `known` that a user who typed `name` most likely meant, for "did you mean ...?". A candidate
/// counts if at most a third of the letters of the longer name (and at least one) must be inserted, removed,
/// replaced or swapped with the next.
/// @return  the nearest candidate, or an empty text when there is none. Any thread.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known);

}  // namespace softcell::base
