#pragma once
// Handles shapes side by side, such as the planks of a floor: where two of them meet, the floor has no edge and no face.

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "ppu/obstacles/obstacle.h"

namespace softcell::ppu {

/// Finds the shapes beside an obstacle that has an inside and is not rounded. Used by one thread; obstacles must stay in place meanwhile.
/// Allocates only when there are more of them than ever before.
class Beside {
 public:
  /// Sets the obstacle. The shapes beside it are looked for when they are first needed.
  /// @param near     the indices of obstacles that may touch `own`; `own` itself may be among them
  /// @param spacing  metres: of the body that touches `own`. Gaps of less than a quarter of it do not count, nor do steps of less than a
  ///                 four-hundredth
  void begin(std::span<const Obstacle> obstacles, std::span<const std::uint32_t> near, const Obstacle& own,
             float spacing);

  /// Whether one of the two faces at an edge goes on in another shape, or ends at it. Both shapes together have no edge there, so nothing
  /// has to be looked up. (Within a body's distance field the point would be pushed sideways out of the body's rim.)
  /// @param point  of the edge, in the world  @param along  the edge, in the world, of any length but 0
  bool face_goes_on(const Eigen::Vector3f& point, const Eigen::Vector3f& along);

  /// The way out through another face, if another shape lies behind the nearest one. Without this the side of the next plank would stop a
  /// body that slides over a floor; engines call that a ghost collision.
  /// @param point    slightly within the obstacle, in its frame; so is the result
  /// @param nearest  its nearest face
  /// @param from     where the point was before, in the same frame: a face that it was well behind is no way out
  /// @param inside   a place of the point's body, in the same frame: a face that it is in front of, or hardly behind, is a way out from
  ///                 deeper places, too
  /// @return  none: the nearest face is free, or no other face is near
  std::optional<Separation> way_out(const Eigen::Vector3f& point, const Separation& nearest,
                                    const Eigen::Vector3f& from, const Eigen::Vector3f& inside);

  /// Whether another shape lies behind a face of the obstacle, or goes on with it.
  /// @param place  on the face, in the obstacle's frame
  bool is_covered(const Eigen::Vector3f& place, const Eigen::Vector3f& normal);

 private:
  struct Other {
    const Obstacle* obstacle;
    Bounds<3> box;  // slightly wider: a point outside of it is not inside, nor level with a face
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
