#pragma once
// How bodies of a scene break and are cut, as plain data, in either dimension.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <type_traits>
#include <vector>

#include "softcell/soft_bodies/fracture.h"

namespace softcell::demos {

/// Makes a body that breaks weaker or stronger in a slab: in the cells whose centres lie within the slab about a plane, in two dimensions
/// within a strip about a line.
template <int Dimension>
struct StrengthSlab {
  using Vector = Eigen::Vector<float, Dimension>;
  /// Metres, in the coordinates of the body's mesh; in two dimensions from the centre of its cells.
  Vector point = Vector::Zero();
  Vector normal = Vector::Unit(1);  ///< of any length but 0
  float thickness = 0;              ///< metres
  float strength = 1;               ///< a factor on the body's fracture limits, 0 or above

  bool operator==(const StrengthSlab&) const = default;
};

/// The factor at a point: that of the weakest slab around it; 1 where there is none. @param at  metres
template <int Dimension>
float strength_at(const std::vector<StrengthSlab<Dimension>>& slabs,
                  const Eigen::Vector<float, Dimension>& at) {
  float least = 1;
  bool in_one = false;
  for (const StrengthSlab<Dimension>& slab : slabs) {
    if (std::abs((at - slab.point).dot(slab.normal)) > 0.5f * slab.thickness * slab.normal.norm()) continue;
    least = in_one ? std::min(least, slab.strength) : slab.strength;
    in_one = true;
  }
  return least;
}

/// A plane or a stroke that cuts a soft body and all of its pieces; in two dimensions a line or a segment of one.
template <int Dimension>
struct ScriptedCut {
  float time = 0;         ///< seconds
  std::size_t body = 0;   ///< number of the soft body
  std::string described;  ///< where it is written, for messages: "bread.toml:12:1: cut 2"
  std::conditional_t<Dimension == 3, ppu::Cut, ppu::Cut2d> where;
};

}  // namespace softcell::demos
