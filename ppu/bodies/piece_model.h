#pragma once
// Makes the model of a piece of a broken body.

#include <memory>

#include "ppu/fracture/cracks.h"
#include "softcell/soft_bodies/soft_body_model.h"

namespace softcell::ppu {

/// The settings are those of the broken body. If no crack has opened, unchanged data is shared with its model.
/// @param broken  a whole body's model, or a piece's
std::shared_ptr<const SoftBodyModel<3>> make_piece_model(
    const std::shared_ptr<const SoftBodyModel<3>>& broken, CrackedPiece<3> piece);
std::shared_ptr<const SoftBodyModel<2>> make_piece_model(
    const std::shared_ptr<const SoftBodyModel<2>>& broken, CrackedPiece<2> piece);

}  // namespace softcell::ppu
