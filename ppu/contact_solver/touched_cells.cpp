#include "ppu/contact_solver/touched_cells.h"

#include <array>

#include "ppu/numbers/keep_each_once.h"

namespace softcell::ppu {
namespace {

using TwoCells = std::array<std::uint32_t, 2>;

TwoCells cells_of(const SoftContact& contact) { return {contact.a.cell, contact.b.cell}; }
TwoCells cells_of(const spu::SolveContact& contact) { return {contact.cell_a, contact.cell_b}; }

}  // namespace

/// Most cells are touched at several points. Room for each cell twice is enough.
void TouchedCells::add(std::size_t body, std::uint32_t cell) {
  std::vector<std::uint32_t>& cells = cells_[body];
  if (cells.size() == cells.capacity()) keep_each_once(cells);
  cells.push_back(cell);
}

void TouchedCells::find(std::span<const ContactBody> bodies, std::span<const ContactGroup> groups) {
  cells_.resize(bodies.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    cells_[i].clear();
    cells_[i].reserve(2 * bodies[i].lattice().cells.size());
  }
  for (const ContactGroup& group : groups) {
    group.for_each_contact([&](const auto& contact) {
      const auto [cell_a, cell_b] = cells_of(contact);
      add(group.a, cell_a);
      if (!group.with_rigid) add(group.b, cell_b);
    });
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].asleep) cells_[i].clear();
    keep_each_once(cells_[i]);
  }
}

}  // namespace softcell::ppu
