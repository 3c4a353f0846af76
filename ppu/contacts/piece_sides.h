#pragma once
// What a piece of a broken body knows of the walls near it.

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <span>

#include "ppu/contacts/contact_body.h"
#include "ppu/contacts/known_sides.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// The piece is on the sides on which the whole was, and comes from well inside of it.
/// @param whole        the whole body's  @param contact  likewise  @param positions  of its particles, metres, as contacts have them
/// @param lattice      of the whole, in its own dimension: `contact` numbers its cells likewise
/// @param particle_of  of each particle of the piece: which one of the whole it was
template <int kDimension>
KnownSides sides_of_piece(const KnownSides& whole, const ContactModel& contact,
                          std::span<const Eigen::Vector3f> positions, const Lattice<kDimension>& lattice,
                          const Lattice<kDimension>& piece, std::span<const std::uint32_t> particle_of) {
  KnownSides sides = whole;
  auto corners = piece.corners[piece.cells.size() / 2];
  for (std::uint32_t& corner : corners) corner = particle_of[corner];
  const auto cell = std::ranges::find(lattice.corners, corners);
  SC_ASSERT(cell != lattice.corners.end(), "a piece of {} cells is no part of a body of {}",
            piece.cells.size(), lattice.cells.size());
  const auto number = static_cast<std::uint32_t>(cell - lattice.corners.begin());
  sides.begin_piece(inner_place(contact, number, positions));
  return sides;
}

}  // namespace softcell::ppu
