#pragma once
// Rays, moved spheres and distances against the drawn surface of a soft body as it is now.
//
//     const SurfaceQuery surface(body);                       // after a step; valid until the next one
//     if (auto hit = surface.cast_ray(eye, eye + 100 * look)) mark(hit->position, hit->normal);
//
// All bodies of a world at once: BulletSoftBodies::cast_ray().

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "softcell/soft_bodies/lattice.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

/// Where something meets a surface.
struct SurfaceHit {
  float share = 0;                    ///< 0..1, of the way
  Eigen::Vector3f position{0, 0, 0};  ///< metres, on the surface
  Eigen::Vector3f normal{0, 1, 0};    ///< unit length, out of the body
  std::uint32_t triangle = 0;         ///< of the model's mesh
};

/// The triangles of a deformed body, in a tree of boxes. If the body's model has no mesh, the surface is the boundary of its lattice.
/// A query copies what it needs: it does not change with the body, and may outlive it. Immutable; any thread.
class SurfaceQuery {
 public:
  /// Takes some microseconds for a thousand triangles.
  /// @throws std::runtime_error  a particle is not finite.
  explicit SurfaceQuery(const SoftBody<3>& body);

  /// The first point at which the line from `from` to `to` (metres) meets the surface, from inside or outside. The normal points out of the
  /// body, not towards the ray. @pre both are finite
  std::optional<SurfaceHit> cast_ray(const Eigen::Vector3f& from, const Eigen::Vector3f& to) const;

  /// Where a sphere that moves from `from` to `to` (metres) first touches the surface from outside. If the sphere touches at `from`, the
  /// share is 0. The normal points from the surface to the sphere's centre. @param radius  metres, above 0
  std::optional<SurfaceHit> cast_sphere(const Eigen::Vector3f& from, const Eigen::Vector3f& to,
                                        float radius) const;

  /// Metres from a point to the surface; below 0 inside the body.
  float distance(const Eigen::Vector3f& point) const;

  /// The box around the surface, metres.
  const Bounds<3>& bounds() const { return nodes_.front().box; }

 private:
  using Triangle = std::array<Eigen::Vector3f, 3>;
  /// A box around `count` triangles from `first` on, or, with a count of 0, around the nodes `first` and first + 1.
  struct Node {
    Bounds<3> box;
    std::uint32_t first = 0, count = 0;
  };
  struct Nearest {
    float square;         ///< of the distance, m^2
    float facing = -1;    ///< how squarely the triangle looks at the point, 0..1
    bool behind = false;  ///< the point is behind the triangle
    std::uint32_t triangle = 0;
    Eigen::Vector3f position{0, 0, 0};

    float distance() const;  ///< metres, below 0 behind it
  };

  /// Calls `work` with triangles, the nearest boxes' first, while their boxes' cost is no more than limit().
  template <typename Cost, typename Limit, typename Work>
  void visit(const Cost& cost, const Limit& limit, const Work& work) const;
  void build(std::uint32_t node, std::uint32_t first, std::uint32_t count);
  Nearest nearest(const Eigen::Vector3f& point) const;
  SurfaceHit hit_of(std::uint32_t triangle, float share, const Eigen::Vector3f& position) const;

  std::vector<Triangle> triangles_;     ///< in the order of the tree
  std::vector<std::uint32_t> numbers_;  ///< of these in the mesh
  std::vector<Node> nodes_;             ///< the root first
  float outwards_ = 1;                  ///< -1 of a mesh whose triangles look inwards
};

}  // namespace softcell::ppu
