#pragma once

#include <span>
#include <string>
#include <string_view>

namespace softcell::base {

/// The one of `known` that `name` is most likely a slip for; empty when none is near. Near is: at most a
/// third of the longer one's letters, or one, inserted, left out, replaced or swapped with its neighbour.
std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known);

}  // namespace softcell::base
