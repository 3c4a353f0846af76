#pragma once
// Breaks a body into pieces.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ppu/fracture/break_test.h"
#include "softcell/soft_bodies/fracture.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

template <int kDimension>
struct BodyPiece {
  SoftBody<kDimension> body;
  std::vector<std::uint32_t> particle_of;  ///< of each particle: its number in the whole
};

/// The numbers of faces that are strained beyond the limits of the body's settings. Valid until the next call.
template <int kDimension>
std::span<const std::uint32_t> strained_faces(const SoftBody<kDimension>& body, BreakTest<kDimension>& test);
/// @throws std::invalid_argument  the cut is not finite, or has no area
std::vector<std::uint32_t> faces_across(const SoftBody<3>& body, const Cut& cut);
/// @throws std::invalid_argument  the cut is not finite, or has no length
std::vector<std::uint32_t> faces_across(const SoftBody<2>& body, const Cut2d& cut);

/// Pieces of at least this many cells stay: given by the body's fracture settings.
template <int kDimension>
std::uint32_t least_cells_of(const SoftBody<kDimension>& body);

template <int kDimension>
struct PlannedPieces {
  std::vector<BodyPiece<kDimension>> stay;  ///< the largest piece first
  /// For each piece that is too small to stay: the numbers of its particles in the whole, ascending.
  std::vector<std::vector<std::uint32_t>> vanished;
};

/// The pieces of a body of this model if faces break, as bodies at rest. When the body breaks, they take over their part of its state
/// (SoftBody::inherit_state()). This is the slow part of pieces_of(), and may run on any thread.
/// @param least_cells  least_cells_of() the body
template <int kDimension>
PlannedPieces<kDimension> plan_pieces(const std::shared_ptr<const SoftBodyModel<kDimension>>& model,
                                      std::span<const std::uint32_t> faces, std::uint32_t least_cells);

/// The pieces of a body that stay if faces break; the largest piece first. The body itself does not change.
template <int kDimension>
std::vector<BodyPiece<kDimension>> pieces_of(const SoftBody<kDimension>& body,
                                             std::span<const std::uint32_t> faces);

}  // namespace softcell::ppu
