#pragma once
// Bodies some of whose cells are crushed: pushes give the cells their volume back (crushed_cells.h), and must not move bodies into others.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/contact_solver/contact_groups.h"
#include "ppu/contact_solver/lost_spin.h"
#include "ppu/contacts/contact_body.h"
#include "ppu/contacts/crushed_cells.h"

namespace softcell::ppu {

/// Used by one thread; keeps allocated memory.
class CrushedBodies {
 public:
  /// Begins a substep.
  void begin(std::size_t bodies);
  /// CrushedCells::hold() of a body that is awake. @return  whether velocities have changed
  bool hold(std::uint32_t number, ContactBody& body, float step);

  /// Whether some of its cells are crushed.
  bool is_crushed(std::size_t body) const { return is_crushed_[body]; }

  /// Tells crushed bodies' contacts of their pushes, whoever solves them (SoftContact::holds_pushes, slide). Cells that get their volume
  /// back in a slant push their lower corners one way and their upper ones the other, and matching takes that motion back. Friction must
  /// feel both: it would drive a crushed body over level ground if it felt one of them.
  void hold_pushes(std::span<ContactGroup> groups, std::span<const ContactBody> bodies) const;

  /// Whether add_lost_spin() has anything to add.
  bool change_spin() const { return count_ > 0; }
  /// Adds the angular momentum that crushed cells have given bodies. @param is_free  of each body: nothing else turns it
  /// @throws std::runtime_error  velocities are not finite.
  void add_lost_spin(LostSpin& lost, std::span<const ContactBody> bodies, const std::vector<bool>& is_free,
                     float step) const;

 private:
  /// What crushed cells have done to a body, apart from contacts.
  struct Crushed {
    std::uint32_t body = 0;
    Eigen::Vector3d moment{0, 0, 0};      // CrushedCells::moment()
    std::vector<Eigen::Vector3f> pushes;  // m/s
  };

  CrushedCells cells_;
  std::vector<bool> is_crushed_;  // of each body
  std::vector<Crushed> crushed_;  // the first count_ are used
  std::size_t count_ = 0;
};

}  // namespace softcell::ppu
