#pragma once
// Convex shapes of Bullet that softcell does not know one by one: the hull of their corners or, where they are round, of many points.

#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <BulletCollision/CollisionShapes/btMultiSphereShape.h>

#include <Eigen/Core>
#include <span>
#include <vector>

#include "ppu/obstacles/obstacle.h"

namespace softcell::ppu {

/// Up to this share of another length a length counts as none; and the thickness it gets instead, in both directions.
inline constexpr float kNoLength = 1e-5f, kThickness = 1e-3f;

/// Faces and edges of the hull of a convex shape. Polyhedra of every class are exact. Any other shape reaches beyond no face of its hull by
/// more than kTolerance of half its length, unless this takes more than some 1,000 points.
class ConvexHull {
 public:
  static constexpr float kTolerance = 0.005f;

  /// Makes the hull anew if the shape has changed since the last call.
  void follow(const btConvexShape& shape);

  /// Outward unit normals, and distances from the shape's origin, metres. None: the shape has no size.
  std::span<const Eigen::Vector4f> planes() const { return planes_; }
  std::span<const ObstacleEdge> edges() const { return edges_; }

 private:
  std::vector<btVector3> points_, before_;  // what follow() compares
  std::vector<Eigen::Vector4f> planes_;
  std::vector<ObstacleEdge> edges_;
};

/// Whether a shape is a sphere or capsule in Bullet's general form: one sphere, or two of one size.
bool is_sphere_or_capsule(const btCollisionShape& shape);
/// Makes an obstacle of one, in place of the obstacle's kind, extent and rounding; moves and turns it accordingly.
/// @pre  is_sphere_or_capsule()
void set_sphere_or_capsule(const btMultiSphereShape& shape, Obstacle& obstacle);

}  // namespace softcell::ppu
