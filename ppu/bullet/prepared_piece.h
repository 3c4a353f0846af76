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

/// What else pieces need. Of any thread; changes no result.
using PrepareModel = std::function<void(const std::shared_ptr<const SoftBodyModel<3>>&)>;

/// Any thread may do it.
/// @param whole  of the body that was never broken, for contact models of pieces; null: none are made
std::vector<PreparedPiece> prepare_pieces(const std::shared_ptr<const SoftBodyModel<3>>& model,
                                          std::span<const std::uint32_t> faces, const ContactModel* whole,
                                          const PrepareModel& prepare);

}  // namespace softcell::ppu
