#pragma once
// Cells that are pressed flat or turned inside out: they are held from going on, and pushed back.
//
// A cell's volume is that of the parallelepiped of its mean edges. It is 1 at rest and below 0 inside out. Shape
// matching resists compression by forces, which a load beats; a cell without volume has no inside in which others
// could be found. So below kLeastVolume volume is a constraint.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/contacts/contact_body.h"
#include "softcell/soft_bodies/contact.h"

namespace softcell::ppu {

inline constexpr float kLeastVolume = 0.5f;  ///< of rest: what is below it is crushed

/// Of its volume at rest, at the substep's beginning; below 0 inside out.
float volume_of_cell(const ContactBody& body, std::uint32_t cell);

/// Of a body that is in no substep.
/// @param positions  of the lattice's particles
CrushedCellCount count_crushed_cells(const Lattice<3>& lattice, std::span<const Eigen::Vector3f> positions);

/// Used by one thread. Allocates when there are more particles, or more crushed cells, than ever before.
class CrushedCells {
 public:
  /// Looks for cells that would be crushed at the substep's end. They lose the velocities that crush them further,
  /// and get pushes that give them back a share of their volume. Both momenta are kept.
  /// @param body  its velocities and pushes change; its ends do not follow
  /// @return      whether velocities have changed
  bool hold(ContactBody& body, float step);

  /// Of the last hold(): cells that are crushed at the substep's beginning and would be at its end.
  std::uint32_t count() const { return count_; }
  /// Of them: those that are inside out.
  std::uint32_t inside_out() const { return inside_out_; }

 private:
  void place_ends(const ContactBody& body, float step);
  float volume_at_end(const std::array<std::uint32_t, 8>& corners) const;

  std::vector<Eigen::Array4f> ends_;  // of each particle
  std::vector<std::uint32_t> cells_;  // that would be crushed at the end
  std::vector<float> least_;          // of each of them: the volume that it is to have then
  std::uint32_t count_ = 0, inside_out_ = 0;
};

}  // namespace softcell::ppu
