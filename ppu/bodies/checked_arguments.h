#pragma once
// What couplings to engines refuse alike.

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

#include "softcell/base/text.h"

namespace softcell::ppu {

/// Whether a step is longer than 0 s.
/// @param what  "Box2dSoftBodies: a step"   @throws std::invalid_argument  the step (s) is negative or not finite
inline bool passes_time(const char* what, float step) {
  if (!(step >= 0) || !std::isfinite(step))
    throw std::invalid_argument(std::string(what) + " of " + base::shortest(step) +
                                " s; expected 0 s or more" + (step >= 0 ? ", and finite" : ""));
  return step > 0;
}

/// @throws std::invalid_argument  it is null
inline void require_model(const void* model) {
  if (model == nullptr)
    throw std::invalid_argument("a soft body needs a model; make_soft_body_model() makes one");
}

/// A soft body of a world. @throws std::out_of_range  there are not so many
template <class CoupledBodies>
const auto& body_at(const CoupledBodies& bodies, std::size_t index) {
  if (index >= bodies.size())
    throw std::out_of_range("soft body " + std::to_string(index) + " of a world of " +
                            std::to_string(bodies.size()) + "; the first one is 0");
  return std::as_const(*bodies[index]).soft();
}

}  // namespace softcell::ppu
