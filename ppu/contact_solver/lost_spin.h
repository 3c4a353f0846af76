#pragma once
// Measures the angular momentum that contacts add or remove by error, and corrects it.
//
// A contact's two impulses are equal and opposite. They act on two points, one of each body, which should coincide at the step's beginning.
// The other body's point is found by a few steps of an iteration, and kept within half a cell outside of its cell, so the two are somewhat
// apart:
//
//     a  --o--->         lost = (x_a - x_b) x J
//           \  gap
//     b  <---o--
//
// Both bodies of a pair get the same small turn about their centres of mass, so that the sum is right again. Bodies at rest lose nothing.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/contacts/contact_body.h"

namespace softcell::ppu {

/// Used by one thread. Allocates when there are more bodies than ever before.
class LostSpin {
 public:
  void begin(std::size_t bodies);

  /// Adds the angular momentum that the contacts of a pair have given both bodies together. @param b  may be a
  void add(std::span<const ContactBody> bodies, std::uint32_t a, std::uint32_t b,
           const Eigen::Vector3d& given);

  /// Removes it from the velocities of all bodies of these pairs.
  void take_back(std::span<ContactBody> bodies) const;

 private:
  struct Spinning {
    bool is_known = false;
    Eigen::Vector3d centre{0, 0, 0}, turn{0, 0, 0};  // metres; rad/s
    Eigen::Matrix3d inertia;                         // kg m^2, about the centre
  };
  Spinning& spinning(std::span<const ContactBody> bodies, std::uint32_t body);

  std::vector<Spinning> of_bodies_;
};

}  // namespace softcell::ppu
