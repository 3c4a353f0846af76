#pragma once
// The cells of soft bodies that something touches in a substep.

#include <cstdint>
#include <span>
#include <vector>

#include "ppu/contact_solver/contact_groups.h"
#include "ppu/contacts/contact_body.h"

namespace softcell::ppu {

/// Used by one thread. Allocates when there are more cells than ever before.
class TouchedCells {
 public:
  void find(std::span<const ContactBody> bodies, std::span<const ContactGroup> groups);

  /// Ascending. Empty for a body that sleeps.
  std::span<const std::uint32_t> of(std::size_t body) const { return cells_[body]; }

  /// Calls stiffen() for those of a body. @param share  0..1
  void stiffen_those_of(std::size_t number, ContactBody& body, float share) const {
    for (const std::uint32_t cell : cells_[number]) stiffen(body, cell, share);
  }

 private:
  void add(std::size_t body, std::uint32_t cell);

  std::vector<std::vector<std::uint32_t>> cells_;  // of each body
};

}  // namespace softcell::ppu
