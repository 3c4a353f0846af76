#include "ppu/bullet/prepared_piece.h"

#include <utility>

#include "softcell/base/assert.h"

namespace softcell::ppu {

PreparedPieces prepare_pieces(const std::shared_ptr<const SoftBodyModel<3>>& model,
                              std::span<const std::uint32_t> faces, std::uint32_t least_cells,
                              const ContactModel* whole, const PrepareModel& prepare) {
  SC_ASSERT(static_cast<bool>(prepare), "the pieces of {} faces have no function that prepares them",
            faces.size());
  PlannedPieces<3> planned = plan_pieces(model, faces, least_cells);
  PreparedPieces made{.stay = {}, .vanished = std::move(planned.vanished)};
  for (BodyPiece<3>& piece : planned.stay) {
    prepare(piece.body.shared_model());
    std::unique_ptr<ContactModel> contact;
    if (whole != nullptr) contact = std::make_unique<ContactModel>(piece.body.shared_model(), *whole);
    made.stay.push_back({std::move(piece), std::move(contact)});
  }
  return made;
}

}  // namespace softcell::ppu
