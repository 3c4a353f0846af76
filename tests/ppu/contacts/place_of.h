#pragma once
// Where an anchor is, by the definition of its shares.

#include <Eigen/Core>
#include <cstddef>
#include <span>

#include "ppu/contacts/contact_body.h"

namespace softcell::ppu {

/// What Anchor::of() returns. A test that called that one would have a copy of its own, which with sanitizers is not optimised and which the
/// linker would take for the whole library: tests of contacts took three times as long.
inline Eigen::Vector3f place_of(const Anchor& anchor, std::span<const Eigen::Vector3f> places) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (std::size_t k = 0; k < anchor.share.size(); ++k) sum += anchor.share[k] * places[anchor.particle[k]];
  return sum;
}

}  // namespace softcell::ppu
