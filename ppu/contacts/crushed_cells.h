#pragma once
// Finds cells that are pressed flat or turned inside out, keeps them from being crushed further, and pushes them back.
//
// A cell's volume is that of the parallelepiped of its mean edges: 1 at rest, below 0 inside out. Shape matching resists compression by
// forces, which a load can exceed; and a cell without volume has no inside in which other bodies could be found. So below kLeastVolume the
// volume becomes a constraint.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/contacts/contact_body.h"
#include "softcell/soft_bodies/contact.h"

namespace softcell::ppu {

inline constexpr float kLeastVolume = 0.5f;  ///< of the volume at rest: cells below it are crushed

/// The volume of a cell at the substep's beginning, as a share of that at rest; below 0 inside out.
float volume_of_cell(const ContactBody& body, std::uint32_t cell);

/// Counts the crushed cells of a body between substeps.
/// @param positions  of the lattice's particles
template <int kDimension>
CrushedCellCount count_crushed_cells(const Lattice<kDimension>& lattice,
                                     std::span<const typename Lattice<kDimension>::Position> positions);

/// The same for all bodies of a coupling. @param bodies  pointers to what has a soft()
template <class Bodies>
CrushedCellCount count_crushed_cells(const Bodies& bodies) {
  CrushedCellCount all;
  for (const auto& body : bodies) {
    const CrushedCellCount of_body =
        count_crushed_cells(body->soft().model().lattice(), body->soft().positions());
    all.crushed += of_body.crushed;
    all.inside_out += of_body.inside_out;
  }
  return all;
}

/// Used by one thread. Allocates when there are more particles, or more crushed cells, than ever before.
class CrushedCells {
 public:
  /// Finds cells that would be crushed at the substep's end. It removes velocities that crush them further, and adds pushes that give them
  /// back a share of their volume. Momentum is kept. Of angular momentum moment() is gained, and what
  /// pushes make of it, which depends on the velocities at the end (ContactSolver::take_back_lost_spin()).
  /// @param body  its velocities and pushes change; its ends are not updated
  /// @return      whether velocities have changed
  bool hold(ContactBody& body, float step);

  /// The number of cells that were crushed at the beginning of the substep of the last hold(), and would have been at its end.
  std::uint32_t count() const { return count_; }
  /// kg m^2/s: the angular momentum that the last hold() has given its body. Its impulses act where particles would be at the end.
  const Eigen::Vector3d& moment() const { return moment_; }

 private:
  void place_ends(const ContactBody& body, float step);
  float volume_at_end(const std::array<std::uint32_t, 8>& corners) const;

  std::vector<Eigen::Array4f> ends_;  // of each particle
  std::vector<std::uint32_t> cells_;  // cells that would be crushed at the end
  std::vector<float> least_;          // for each of them: the volume that it shall have then
  std::uint32_t count_ = 0;
  Eigen::Vector3d moment_{0, 0, 0};
};

}  // namespace softcell::ppu
