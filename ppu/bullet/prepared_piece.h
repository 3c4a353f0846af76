#pragma once
// Pieces of a broken body with what takes long to make for them.

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
  std::unique_ptr<ContactModel> contact;  ///< null: it is not made ahead
};

struct PreparedPieces {
  std::vector<PreparedPiece> stay;                   ///< the largest piece first
  std::vector<std::vector<std::uint32_t>> vanished;  ///< as PlannedPieces
};

/// What else pieces need. Of any thread; changes no result.
using PrepareModel = std::function<void(const std::shared_ptr<const SoftBodyModel<3>>&)>;

/// Any thread may do it.
/// @param least_cells  as plan_pieces()
/// @param whole  of the body that was never broken, for contact models of pieces; null: none are made
PreparedPieces prepare_pieces(const std::shared_ptr<const SoftBodyModel<3>>& model,
                              std::span<const std::uint32_t> faces, std::uint32_t least_cells,
                              const ContactModel* whole, const PrepareModel& prepare);

}  // namespace softcell::ppu
