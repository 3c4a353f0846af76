#pragma once
// Pieces of a broken body, together with data that takes long to make.

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "ppu/bodies/break_body.h"
#include "ppu/contacts/contact_body.h"

namespace softcell::ppu {

struct PreparedPiece {
  BodyPiece<3> piece;
  std::unique_ptr<ContactModel> contact;  ///< null: not made ahead
};

struct PreparedPieces {
  std::vector<PreparedPiece> stay;                   ///< the largest piece first
  std::vector<std::vector<std::uint32_t>> vanished;  ///< as PlannedPieces
};

/// Makes what else pieces need. May run on any thread; does not change results.
using PrepareModel = std::function<void(const std::shared_ptr<const SoftBodyModel<3>>&)>;

/// May run on any thread.
/// @param least_cells  as plan_pieces()
/// @param whole  contact model of the body before it ever broke, for those of pieces; null: none are made
PreparedPieces prepare_pieces(const std::shared_ptr<const SoftBodyModel<3>>& model,
                              std::span<const std::uint32_t> faces, std::uint32_t least_cells,
                              const ContactModel* whole, const PrepareModel& prepare);

}  // namespace softcell::ppu
