#pragma once
// Rays, moving spheres and distances against the present drawn surface of a soft body; in two dimensions circles and the drawn edge.
//
//     const SurfaceQuery surface(body);                       // after a step; valid until the next one
//     if (auto hit = surface.cast_ray(eye, eye + 100 * look)) mark(hit->position, hit->normal);
//
// All bodies of a world at once: BulletSoftBodies::cast_ray(), Box2dSoftBodies::cast_ray().

#include <Eigen/Core>
#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <vector>

#include "softcell/soft_bodies/lattice.h"
#include "softcell/soft_bodies/skin_2d.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// The point where a ray or sphere meets a surface.
template <int kDimension>
struct SurfaceHit {
  using Vector = Eigen::Vector<float, kDimension>;
  float share = 0;                   ///< 0..1, fraction of the motion
  Vector position = Vector::Zero();  ///< metres, on the surface
  Vector normal = Vector::UnitY();   ///< unit length, out of the body
  /// The triangle of the model's mesh; in two dimensions the edge of the skin's outlines, counted through all of them.
  std::uint32_t face = 0;
};

/// The triangles of a deformed body, in two dimensions the edges of its outlines, in a tree of boxes. If a body in three dimensions has no
/// mesh, the surface is the boundary of its lattice. A query copies what it needs: it does not change with the body, and may outlive it.
/// Immutable; any thread.
/// @tparam kDimension  2 or 3
template <int kDimension>
class SurfaceQuery {
 public:
  using Vector = Eigen::Vector<float, kDimension>;
  using Hit = SurfaceHit<kDimension>;

  /// Takes about half a microsecond for each triangle. In two dimensions it also makes a skin, as make_skin_2d() does with the contact
  /// radius of the model, which takes longer than the rest.
  /// @throws std::runtime_error  a particle is not finite.
  explicit SurfaceQuery(const SoftBody<kDimension>& body);
  /// For a body in two dimensions that is drawn with its own skin. @pre the skin has outlines, and is made for the body's lattice
  /// @throws std::invalid_argument  as validate() of the skin and the lattice of the body's model.
  /// @throws std::runtime_error  a particle is not finite.
  template <std::same_as<Skin2d> Skin>
  requires(kDimension == 2) SurfaceQuery(const SoftBody<kDimension>& body, const Skin& drawn);

  /// The first point at which the line from `from` to `to` (metres) meets the surface, from inside or outside. The normal points out of the
  /// body, not towards the ray. @pre both are finite
  std::optional<Hit> cast_ray(const Vector& from, const Vector& to) const;

  /// The point where a sphere that moves from `from` to `to` (metres) first touches the surface from outside. If the sphere touches at
  /// `from`, or its centre is inside the body there, the share is 0. The normal points from the surface to the sphere's centre; if that is
  /// inside, out of the body. @param radius  metres, above 0
  /// @throws std::invalid_argument  the radius is not above 0 and finite  @pre both are finite
  std::optional<Hit> cast_sphere(const Vector& from, const Vector& to, float radius) const;

  /// Metres from a point to the nearest place of the surface; below 0 inside the body. A point is inside if a line from it does not leave
  /// the body as often as it enters it. If parts reach into each other, or a body is crushed, the nearest place may lie inside the body.
  /// @pre the point is finite
  float distance(const Vector& point) const;

  /// The box around the surface, metres.
  const Bounds<kDimension>& bounds() const { return nodes_.front().box; }

 private:
  using Face = std::array<Vector, kDimension>;
  /// A box around `count` faces from `first` on; with a count of 0, around the nodes `first` and first + 1.
  struct Node {
    Bounds<kDimension> box;
    std::uint32_t first = 0, count = 0;
  };
  struct Nearest {
    float square = 0;     ///< of the distance, m^2
    float facing = -1;    ///< how squarely the face looks at the point, 0..1
    bool behind = false;  ///< the point is behind the face
    std::uint32_t face = 0;
    Vector position = Vector::Zero();
  };
  /// How often a line along an axis crosses the surface, 1 or -1 by the sense of each face: beyond a point, and in all.
  struct Turns {
    int ahead = 0, all = 0;
  };

  explicit SurfaceQuery(std::vector<Face> faces);
  /// Calls `work` with faces, beginning with those in the nearest boxes, while the cost of a box is no more than limit().
  template <typename Cost, typename Limit, typename Work>
  void visit(const Cost& cost, const Limit& limit, const Work& work) const;
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);
  Nearest nearest(const Vector& point) const;
  Turns turns_along(int axis, const Vector& point) const;
  bool is_inside(const Vector& point, const Nearest& nearest) const;
  Hit hit_of(std::uint32_t face, float share, const Vector& position) const;

  std::vector<Face> faces_;             ///< in the order of the tree
  std::vector<std::uint32_t> numbers_;  ///< for each of these: its number in the surface
  std::vector<bool> is_narrow_;         ///< for each of these: its normal is mere rounding
  std::vector<Node> nodes_;             ///< the root first
  float outwards_ = 1;                  ///< -1 if the surface's faces look inwards
};

extern template class SurfaceQuery<2>;
extern template class SurfaceQuery<3>;

}  // namespace softcell::ppu
