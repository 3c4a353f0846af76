#pragma once
// Shares one model among equal bodies: its constants, plan and mesh are made once, are in memory once, and an SPE fetches them once for
// many bodies.

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "softcell/base/assert.h"

namespace softcell::demos {

/// The models of `count` bodies, in order; equal bodies share one.
/// @param same  (i, j) -> whether bodies i and j have equal models
/// @param make  (i) -> a shared pointer to the model of body i
template <typename Same, typename Make>
auto shared_models(std::size_t count, const Same& same, const Make& make) {
  std::vector<std::invoke_result_t<const Make&, std::size_t>> models;
  std::vector<std::size_t> first;  // the first body with each model
  for (std::size_t i = 0; i < count; ++i) {
    const auto known = std::ranges::find_if(first, [&](std::size_t j) { return same(i, j); });
    if (known == first.end()) {
      first.push_back(i);
      models.push_back(make(i));
    } else {
      models.push_back(models[*known]);
    }
  }
  SC_ASSERT(models.size() == count && first.size() <= count, "{} models of {} kinds for {} bodies",
            models.size(), first.size(), count);
  return models;
}

}  // namespace softcell::demos
