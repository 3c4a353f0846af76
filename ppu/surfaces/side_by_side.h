#pragma once
// Shapes side by side, such as the planks of a floor: what they have in common is no edge of the floor, and no face.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ppu/surfaces/obstacle.h"

namespace softcell::ppu {

/// What lies at an obstacle that has an inside and is not rounded. Used by one thread; obstacles stay where they are meanwhile.
/// Allocates only when there are more of them than ever before.
class Beside {
 public:
  /// Looks for them when they are asked for.
  /// @param near     the indices of those that may touch `own`, itself perhaps among them
  /// @param spacing  metres: of the body that touches `own`. Gaps of less than a quarter of it are none, nor are steps of less than a
  ///                 four-hundredth
  void begin(std::span<const Obstacle> obstacles, std::span<const std::uint32_t> near, const Obstacle& own,
             float spacing);

  /// Whether one of the two faces at an edge goes on in another shape, or ends at it: what the two are together has no edge there, and
  /// nothing that has to be looked up. (Within a body's distance field it would be pushed sideways out of the body's rim.)
  /// @param point  of the edge, in the world  @param along  the edge, in the world, of any length but 0
  bool face_goes_on(const Eigen::Vector3f& point, const Eigen::Vector3f& along);

  /// The way out by another face, where the nearest one has another shape behind it. Engines call it a ghost collision when a body that
  /// slides over a floor is stopped by the side of the next plank.
  /// @param point    a bit within the obstacle, in its frame, as the result
  /// @param nearest  face of it
  /// @param from     where the point was, in the same frame: a face that it was well behind is no way out
  /// @return  none: the nearest face is free, or no other one is near
  std::optional<Separation> way_out(const Eigen::Vector3f& point, const Separation& nearest,
                                    const Eigen::Vector3f& from);

 private:
  struct Other {
    const Obstacle* obstacle;
    Bounds<3> box;  // a bit wider: a point outside is not inside, nor level with a face
  };
  bool none();
  bool is_inside_others(const Eigen::Vector3f& world, float most) const;

  std::span<const Obstacle> obstacles_;
  std::span<const std::uint32_t> near_;
  const Obstacle* own_ = nullptr;
  float spacing_ = 0;
  bool has_looked_ = false;
  std::vector<Other> others_;
};

}  // namespace softcell::ppu
