#include "ppu/bullet/prepared_piece.h"

#include <utility>

#include "softcell/base/assert.h"

namespace softcell::ppu {

std::vector<PreparedPiece> prepare_pieces(const std::shared_ptr<const SoftBodyModel<3>>& model,
                                          std::span<const std::uint32_t> faces, const ContactModel* whole,
                                          const PrepareModel& prepare) {
  SC_ASSERT(static_cast<bool>(prepare), "nobody prepares the pieces of {} faces", faces.size());
  std::vector<PreparedPiece> made;
  for (BodyPiece<3>& piece : plan_pieces(model, faces)) {
    prepare(piece.body.shared_model());
    std::unique_ptr<ContactModel> contact;
    if (whole != nullptr) contact = std::make_unique<ContactModel>(piece.body.shared_model(), *whole);
    made.push_back({std::move(piece), std::move(contact)});
  }
  return made;
}

}  // namespace softcell::ppu
