#pragma once
// What a piece of a broken body knows about the rigid triangles near it.

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <span>

#include "ppu/contacts/contact_body.h"
#include "ppu/contacts/known_sides.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// Puts a piece on the sides on which the whole was, with an origin well inside the whole.
/// @param whole, contact, positions  of the whole; the positions are those of its particles as contacts have them, in metres
/// @param lattice      of the whole, in its own dimension; `contact` numbers the cells in the same order
/// @param particle_of  for each particle of the piece, the particle of the whole that it was
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
