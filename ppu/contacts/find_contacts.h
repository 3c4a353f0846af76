#pragma once
// Where bodies would enter something in the coming substep.

#include <span>
#include <vector>

#include "ppu/contacts/cell_finder.h"
#include "ppu/contacts/contact_group.h"

namespace softcell::ppu {

/// The cells of where a body will be, placed when somebody asks: most bodies need none.
class EndCells {
 public:
  void begin(const ContactBody& body) { body_ = &body, is_placed_ = false; }
  const CellFinder& finder() {
    if (!is_placed_) finder_.place(body_->lattice(), body_->ends);
    is_placed_ = true;
    return finder_;
  }

 private:
  const ContactBody* body_ = nullptr;
  CellFinder finder_;
  bool is_placed_ = false;
};

/// Points of the body's surface, and its particles, in an obstacle, and the obstacle's edges in the body.
/// Appends to `contacts`.
/// @param cells  the body's
/// @param step   seconds
void find_contacts(const ContactBody& body, EndCells& cells, const Obstacle& obstacle,
                   std::span<const ContactRigid> rigids, float step, std::vector<SoftContact>& contacts);

/// Points of a's surface in b. Appends to `contacts`, as seen from a.
void find_contacts(const ContactBody& a, const ContactBody& b, EndCells& cells_of_b, float step,
                   std::vector<SoftContact>& contacts);

/// Whether a body may touch itself. Else it need not be asked for.
bool may_touch_itself(const ContactBody& body);

}  // namespace softcell::ppu
