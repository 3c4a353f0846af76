#pragma once
// Who computes the shape matching of soft bodies in two dimensions.

#include <span>

#include "softcell/soft_bodies/soft_body_2d.h"

namespace softcell::ppu {

/// Does for many bodies at once what SoftBody2d::pull() does for one. Without one a world's bodies are pulled
/// by the thread that steps it. Used by that thread.
class Solver2d {
 public:
  virtual ~Solver2d() = default;

  /// The bodies of the steps to come, in an order that says nothing. They stay where they are until the next
  /// call. What directions of regions a solver has kept from the last step is forgotten here, not when a body
  /// is reset. It shows only where a region has none of its own: all in one point, or a mirror image.
  /// @throws std::runtime_error  a body that this solver cannot take.
  virtual void set_bodies(std::span<SoftBody2d* const> bodies) = 0;

  /// v += alpha (g - x) / h, then damping, by the settings of each body's model.
  /// @param step  h, seconds, above 0
  /// @throws std::runtime_error  a position or velocity is not a finite number.
  virtual void pull(float step) = 0;
};

}  // namespace softcell::ppu
