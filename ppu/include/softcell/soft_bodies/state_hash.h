#pragma once
// One number for the state of soft bodies: equal numbers, equal bytes.

#include <cstdint>
#include <span>

#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// Hash of the positions and velocities of a body's particles, and of its rest shape if it has yielded. For several bodies, pass on the
/// hash of the bodies before: state_hash(b, state_hash(a)). The order counts.
/// @source  XXH3, the 64-bit variant; `before` is its seed
std::uint64_t state_hash(const SoftBody<2>& body, std::uint64_t before = 0);
std::uint64_t state_hash(const SoftBody<3>& body, std::uint64_t before = 0);

/// The hash of several bodies, in order. @pre none is null
std::uint64_t state_hash(std::span<const SoftBody<3>* const> bodies);

}  // namespace softcell::ppu
