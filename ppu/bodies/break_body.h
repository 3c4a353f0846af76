#pragma once
// A body and its pieces.

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
  std::vector<std::uint32_t> particle_of;  ///< of each particle: which one of the whole it was
};

/// The numbers of faces that are strained beyond the limits of the body's settings. Good until the next call.
template <int kDimension>
std::span<const std::uint32_t> strained_faces(const SoftBody<kDimension>& body, BreakTest<kDimension>& test);
/// @throws std::invalid_argument  the cut is not finite, or has no area
std::vector<std::uint32_t> faces_across(const SoftBody<3>& body, const Cut& cut);
/// @throws std::invalid_argument  the cut is not finite, or has no length
std::vector<std::uint32_t> faces_across(const SoftBody<2>& body, const Cut2d& cut);

/// The number of cells from which on a piece of the body stays: what its fracture says.
template <int kDimension>
std::uint32_t least_cells_of(const SoftBody<kDimension>& body);

template <int kDimension>
struct PlannedPieces {
  std::vector<BodyPiece<kDimension>> stay;  ///< the largest piece first
  /// Of each piece that is too small to stay: which particles of the whole its own were, ascending.
  std::vector<std::vector<std::uint32_t>> vanished;
};

/// What comes of bodies of a model when faces break: bodies at rest, which take part of a body (SoftBody::inherit_state()) when it breaks.
/// This is what takes long of pieces_of(), and any thread may do it.
/// @param least_cells  least_cells_of() the body
template <int kDimension>
PlannedPieces<kDimension> plan_pieces(const std::shared_ptr<const SoftBodyModel<kDimension>>& model,
                                      std::span<const std::uint32_t> faces, std::uint32_t least_cells);

/// What stays of a body when faces break; the largest piece first. The body stays as it is.
template <int kDimension>
std::vector<BodyPiece<kDimension>> pieces_of(const SoftBody<kDimension>& body,
                                             std::span<const std::uint32_t> faces);

}  // namespace softcell::ppu
