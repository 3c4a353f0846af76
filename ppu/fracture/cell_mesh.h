#pragma once
// The mesh of a body cut at all faces of its cells, of which the meshes of its pieces are put together.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "softcell/soft_bodies/lattice.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// What of a closed mesh lies in each cell, and where the solid meets the faces between cells. All pieces of a body share it. Immutable.
///
/// The surface in a cell and the caps of its six faces are together closed, and so are any cells with the caps of the faces at which they
/// end: what is cut is cut exactly (cut_triangle.h). Where the mesh itself is open, caps are missing.
class CellMesh {
 public:
  /// @param lattice  covers the mesh, as voxelize() makes it
  CellMesh(const TriangleMesh& mesh, const Lattice<3>& lattice);

  struct Triangle {
    std::array<std::uint32_t, 3> vertex;
    std::uint32_t part = 0;  ///< of the mesh; 0 where it has none
  };
  /// Where a vertex may lie: in a cell, on a face or on an edge of cells.
  struct Point {
    Eigen::Vector3f position{0, 0, 0};   ///< metres, of vertices with the same point the same bits
    std::uint8_t planes = 0;             ///< 0: within a cell; 1: on a face; 2: on an edge
    std::array<std::uint8_t, 2> axis{};  ///< across the planes, ascending
    std::array<int, 2> plane{};          ///< grid index along them
  };
  /// What closes the low cell of a face: the high one has the same, turned over.
  struct Cap {
    std::vector<Eigen::Vector3f> positions;  ///< metres
    std::vector<std::array<std::uint32_t, 3>> triangles;
  };

  /// The mesh's attributes at all vertices, those at cuts included; without triangles.
  const TriangleMesh& vertices() const { return vertices_; }
  const Point& point_of(std::uint32_t vertex) const { return points_[point_of_vertex_[vertex]]; }
  std::span<const Triangle> triangles_of(std::uint32_t cell) const {
    return std::span(triangles_)
        .subspan(first_triangle_[cell], first_triangle_[cell + 1] - first_triangle_[cell]);
  }
  /// Whether nothing of the solid lies in the cell: it was only touched.
  bool is_empty(std::uint32_t cell) const;
  /// Of the face of `cell` towards the next cell along `axis`.
  Cap cap(std::uint32_t cell, std::uint32_t axis) const;

  const Lattice<3>& lattice() const { return lattice_; }
  const TriangleMesh& mesh() const { return mesh_; }  ///< uncut

 private:
  class Maker;
  /// Where a line of the lattice meets the mesh.
  struct Crossing {
    std::uint32_t point = 0;
    double along = 0;  ///< cells
    int enters = 0;    ///< 1: the solid begins there, along the axis; -1: it ends
  };
  /// Of the cut of a face: from one point to the next, the solid on its left seen along the axis from outside of the low cell.
  struct Segment {
    std::uint32_t face = 0;  ///< 3 cell + axis
    std::uint32_t from = 0, to = 0;
  };
  using Corner = Eigen::Vector3i;

  std::span<const Segment> segments_of(std::uint32_t face) const;
  std::span<const Crossing> crossings_of(const Corner& corner, std::uint32_t axis) const;

  Lattice<3> lattice_;
  TriangleMesh mesh_, vertices_;
  std::vector<Point> points_;
  std::vector<std::uint32_t> point_of_vertex_;
  std::vector<Triangle> triangles_;            // by cells
  std::vector<std::uint32_t> first_triangle_;  // of each cell
  std::vector<Segment> segments_;              // by faces
  std::unordered_map<std::uint64_t, std::vector<Crossing>>
      crossings_;             // of the edge of a cell from a corner along an axis
  std::vector<int> winding_;  // of each particle: how often the mesh goes around it
};

}  // namespace softcell::ppu
