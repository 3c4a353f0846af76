#include "ppu/contacts/sharp_contacts.h"

#include <algorithm>

#include "ppu/contacts/crushed_cells.h"
#include "ppu/numbers/keep_each_once.h"
#include "ppu/surfaces/inner_places.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

// A load reaches this many cells deep before it spreads: a cell behind the touched one is crushed first.
constexpr int kCellsBehind = 3;
// These cells keep this share of their volume at rest. With 0.5, below which cells are crushed, edges get a fifth of a cell deep; with 0.6
// an eighth, and no less with more.
constexpr float kLeastAtEdges = 0.6f;
// An edge that would be deeper than this at the substep's end has passed the touched cell.
constexpr float kDeep = 0.5f;  // cells

/// Whether cells are less than a third of the area on which the body would lie on a floor. If more is touched, it is no edge.
bool are_few(std::size_t cells, const ContactBody& body) {
  const double touched = 3 * static_cast<double>(cells);
  const auto particles = static_cast<double>(body.positions.size());
  // A flat body has each particle twice, and touches a floor along a line.
  return body.model->is_flat() ? touched * touched < particles / 2
                               : touched * touched * touched < particles * particles;
}

}  // namespace

float room_to_squeeze(const ContactBody& body, const DeformedPlace& place, const Vector3f& inwards,
                      float depth) {
  SC_ASSERT(place.cell < body.lattice().cells.size(), "cell {} of {}", place.cell,
            body.lattice().cells.size());
  const Lattice<3>& lattice = body.lattice();
  const Vector3f begin = lattice.cells[place.cell].cast<float>() + place.xi;
  float least = 1;
  for (int k = 0; k <= kCellsBehind; ++k) {
    const auto cell = cell_at(lattice.cells, begin + static_cast<float>(k) * inwards);
    if (cell) least = std::min(least, volume_of_cell(body, *cell));
  }
  const float cells = std::min(least - kLeastAtEdges, kDeep - depth / body.spacing());
  return std::max(cells, 0.0f) * body.spacing();
}

bool SharpContacts::keep(std::span<SoftContact> contacts, const ContactBody& body) {
  const auto is_sharp = [](const SoftContact& contact) { return contact.room < SoftContact::kNoLimit; };
  if (std::ranges::none_of(contacts, is_sharp)) return false;
  cells_.clear();
  for (const SoftContact& contact : contacts) cells_.push_back(contact.a.cell);
  keep_each_once(cells_);
  if (are_few(cells_.size(), body)) return true;
  for (SoftContact& contact : contacts) contact.room = SoftContact::kNoLimit;
  return false;
}

}  // namespace softcell::ppu
