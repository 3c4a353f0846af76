#pragma once
// What couplings to engines refuse alike.

#include <algorithm>
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

/// Where a soft body is among those of a world.
/// @param purpose  "to be cut"   @param coupling  the class's name
/// @throws std::invalid_argument  it is none of them
template <class CoupledBodies, class Body>
auto find_coupled(CoupledBodies& bodies, const Body& body, const char* purpose, const char* coupling) {
  const auto found = std::find_if(bodies.begin(), bodies.end(),
                                  [&](const auto& coupled) { return &coupled->soft() == &body; });
  if (found == bodies.end())
    throw std::invalid_argument(std::string("the soft body ") + purpose + " is not one of this " + coupling);
  return found;
}

}  // namespace softcell::ppu
