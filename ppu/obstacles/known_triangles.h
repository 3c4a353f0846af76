#pragma once
// Keeps what is known of an obstacle's triangles near a body from one substep to the next.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/obstacles/corner_set.h"
#include "ppu/obstacles/edge_set.h"
#include "ppu/obstacles/obstacle.h"
#include "ppu/obstacles/triangle_boxes.h"

namespace softcell::ppu {

/// Caches what follows from triangles alone, and computes it anew when they change. A program may change a mesh at any time, so the
/// triangles are compared number by number, which takes a twentieth of the time of computing anew. Allocates only when there are more of
/// them than ever before.
class KnownTriangles {
 public:
  /// Computes everything anew unless these are the triangles of the last call.
  /// @param obstacle  of triangles  @param longest  up to this length, in metres, edges are short
  void see(const Obstacle& obstacle, float longest);

  const TriangleBoxes& boxes() const { return boxes_; }

  /// The normal and the size of a triangle.
  struct Face {
    Eigen::Vector3f cross;  ///< cross product of two sides, square metres
    Eigen::Vector3f
        normal;  ///< of unit length, towards the side from which it is wound counterclockwise; not set without an area
    float area;      ///< twice the triangle's, square metres
    float rounding;  ///< cubic metres; by the area: how exactly floats give the triangle's nearest point
  };
  const Face& face(std::size_t triangle) const { return faces_[triangle]; }

  // Corners and edges within a plane of triangles are left out, as they do not stand out: a body's points already meet the plane. (Within a
  // body's distance field, a point of the plane near the rim of the body's flat side would be pushed out sideways.)

  /// The corners, in the obstacle's frame, each once although many triangles share it. In the order of the triangles.
  std::span<const CornerSet::Point> corners() const { return corners_; }
  /// Whether an edge, by its number in the obstacle, is so long that points between its ends must be looked up, too.
  bool is_long(std::size_t edge) const { return is_long_[edge]; }
  /// Whether any edge is.
  bool has_long_edges() const { return has_long_edges_; }

 private:
  void find_faces();
  void find_corners();
  void find_long_edges(const Obstacle& obstacle);
  bool may_stand_out(std::size_t t, std::size_t side) const;
  bool has_sides() const { return edges_.empty(); }

  std::vector<std::array<Eigen::Vector3f, 3>> triangles_;
  std::vector<ObstacleEdge> edges_;  // empty: the triangles' sides
  float longest_ = 0;

  TriangleBoxes boxes_;
  std::vector<Face> faces_;
  CornerSet set_;
  EdgeSet sides_;
  std::vector<CornerSet::Point> corners_;
  std::vector<std::array<std::uint32_t, 3>> corners_of_;  // of each triangle with sides: indices in set_
  std::vector<bool> is_long_;                             // of each edge
  bool has_long_edges_ = false;
};

}  // namespace softcell::ppu
