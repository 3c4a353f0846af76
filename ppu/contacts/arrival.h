#pragma once
// Where a point that moves arrives at a convex obstacle, and at which of its faces.

#include <Eigen/Core>
#include <optional>

#include "ppu/obstacles/obstacle.h"

namespace softcell::ppu {

/// A point before and after the substep, in the frame of an obstacle, as if the obstacle stood still.
struct PointWay {
  Eigen::Vector3f from, to;
};

/// A contact in the obstacle's frame.
struct ObstacleHit {
  Eigen::Vector3f normal;
  float end;  ///< metres, along the normal, at the end of the motion: below 0 inside
};

/// A point that arrives at a face this near to an edge, in cells, may belong to the face beside it.
inline constexpr float kBeside = 0.1f;

/// The place where a point's motion comes near an obstacle.
struct Arrival {
  float share;  ///< of the way
  Separation there;

  /// On the obstacle.
  Eigen::Vector3f place_on(const PointWay& way) const {
    return way.from + share * (way.to - way.from) - there.distance * there.normal;
  }
};

/// @param near  metres from the obstacle  @return  the first such place of the motion; none: it does not come near
std::optional<Arrival> arrive(const Obstacle& obstacle, const Eigen::Vector3f& from,
                              const Eigen::Vector3f& along, float near, float spacing);

/// For a point from outside the first place inside counts: at the end it may be nearer to the other side.
ObstacleHit hit_at(const Arrival& arrival, const PointWay& way);

/// Corrects the contact of a point that arrives at a face a little way from its edge, while its body's surface slides past the edge. Where
/// a block slides on a soft floor, points ahead of it lie a little above its bottom: they pass below the block, and do not stop it.
/// @param inwards  from the point into its own body, across its surface: of unit length, in the obstacle's frame
/// @return  the contact with the face beyond the edge; none: there is no edge near, or the body runs into the face
std::optional<ObstacleHit> hit_of_face_beside(const Obstacle& obstacle, const PointWay& way,
                                              const Arrival& arrival, const Eigen::Vector3f& inwards,
                                              float spacing);

/// A contact with the face through which a line from the inside of a body enters an obstacle.
struct EnteredFace {
  ObstacleHit hit;
  Eigen::Vector3f place;  ///< on the face, in the obstacle's frame
};

/// Corrects the contact of a point that has been pressed in so deep that it is nearer to another face than to the one through which it
/// entered: to the far side of a thin shape, or to a side near an edge. It would leave through that face, and its body would get stuck
/// there.
/// @param inside  a place of the point's body, before the substep, in the obstacle's frame
/// @param hit     of the point, as hit_at() finds it
/// @return  the contact with the face that the line from inside of the body meets; none: it is the same face, or `inside` does not tell
std::optional<EnteredFace> entered_face(const Obstacle& obstacle, const PointWay& way,
                                        const Eigen::Vector3f& inside, const ObstacleHit& hit, float spacing);

}  // namespace softcell::ppu
