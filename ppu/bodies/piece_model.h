#pragma once
// The model of a piece of a broken body.

#include <memory>

#include "ppu/fracture/cracks.h"
#include "softcell/soft_bodies/soft_body_model.h"

namespace softcell::ppu {

/// With the settings of the body that breaks. What has not changed, because no crack has opened, is shared with it.
/// @param broken  whole, or a piece itself
std::shared_ptr<const SoftBodyModel<3>> make_piece_model(
    const std::shared_ptr<const SoftBodyModel<3>>& broken, CrackedPiece<3> piece);
std::shared_ptr<const SoftBodyModel<2>> make_piece_model(
    const std::shared_ptr<const SoftBodyModel<2>>& broken, CrackedPiece<2> piece);

}  // namespace softcell::ppu
