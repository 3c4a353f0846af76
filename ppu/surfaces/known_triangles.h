#pragma once
// The triangles of an obstacle near a body, known from one substep to the next.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/surfaces/corner_set.h"
#include "ppu/surfaces/edge_set.h"
#include "ppu/surfaces/obstacle.h"
#include "ppu/surfaces/triangle_boxes.h"

namespace softcell::ppu {

/// What follows from triangles alone, made when others come. A program may change a mesh at any time, so the triangles themselves are
/// compared, number by number, which takes a twentieth of making this anew. Allocates only when there are more of them than ever before.
class KnownTriangles {
 public:
  /// Makes it anew if these are not the triangles of the last call.
  /// @param obstacle  of triangles  @param longest  of edges that are short, metres
  void see(const Obstacle& obstacle, float longest);

  const TriangleBoxes& boxes() const { return boxes_; }

  /// Where a triangle faces.
  struct Face {
    Eigen::Vector3f cross;  ///< of its sides: square metres
    Eigen::Vector3f
        normal;  ///< of unit length, towards the side from which it is wound counterclockwise; not set without an area
    float area;      ///< twice the triangle's, square metres
    float rounding;  ///< cubic metres: over the area, how well floats know the nearest place of the triangle
  };
  const Face& face(std::size_t triangle) const { return faces_[triangle]; }

  // What lies within a plane is left out, as it stands out of nothing: a body's points meet the plane. (Within a body's distance field a
  // point of the plane near the rim of the body's flat side would be pushed out sideways.)

  /// The corners, in the obstacle's frame, each once although many triangles have it. In the order of the triangles.
  std::span<const CornerSet::Point> corners() const { return corners_; }
  /// Whether an edge, by its number in the obstacle, is too long for its ends to be all that is looked up.
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
  std::vector<ObstacleEdge> edges_;  // none: the triangles' sides
  float longest_ = 0;

  TriangleBoxes boxes_;
  std::vector<Face> faces_;
  CornerSet set_;
  EdgeSet sides_;
  std::vector<CornerSet::Point> corners_;
  std::vector<std::array<std::uint32_t, 3>> corners_of_;  // of each triangle with sides: in set_
  std::vector<bool> is_long_;                             // of each edge
  bool has_long_edges_ = false;
};

}  // namespace softcell::ppu
