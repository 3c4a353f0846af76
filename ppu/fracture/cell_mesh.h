#pragma once
// The mesh of a body, cut at all faces of its cells. Meshes of pieces are put together from it.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "softcell/soft_bodies/lattice.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// The part of a closed mesh in each cell, and the lines along which the solid's surface meets the faces between cells. All pieces of a
/// body share it. Immutable.
///
/// The surface in a cell and the caps of its six faces form a closed surface. So do several cells with the caps of the faces at which they
/// end, because all cuts are exact (cut_triangle.h). Where the mesh itself is open, caps are missing.
class CellMesh {
 public:
  /// @param lattice  covers the mesh, as voxelize() makes it
  CellMesh(const TriangleMesh& mesh, const Lattice<3>& lattice);

  struct Triangle {
    std::array<std::uint32_t, 3> vertex;
    std::uint32_t part = 0;  ///< of the mesh; 0 if the mesh has no parts
  };
  /// The place of a vertex: inside a cell, on a face or on an edge of cells.
  struct Point {
    Eigen::Vector3f position{0, 0, 0};   ///< metres; vertices with the same point have the same bits
    std::uint8_t planes = 0;             ///< 0: inside a cell; 1: on a face; 2: on an edge
    std::array<std::uint8_t, 2> axis{};  ///< axes across the planes, ascending
    std::array<int, 2> plane{};          ///< grid indices of the planes along these axes
  };
  /// Triangles that close the low cell of a face; the high cell has the same, turned over.
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
  /// Whether the cell contains nothing of the solid: the surface only touches it.
  bool is_empty(std::uint32_t cell) const;
  /// The cap of the face of `cell` towards the next cell along `axis`.
  Cap cap(std::uint32_t cell, std::uint32_t axis) const;

  const Lattice<3>& lattice() const { return lattice_; }
  const TriangleMesh& mesh() const { return mesh_; }  ///< uncut

 private:
  class Maker;
  class CapMaker;
  /// A point where a line of the lattice meets the mesh.
  struct Crossing {
    std::uint32_t point = 0;
    double along = 0;  ///< cells
    int enters = 0;    ///< 1: the solid begins there, along the axis; -1: it ends
  };
  /// A part of the line along which the mesh cuts a face: from one point to the next, with the solid on its left when seen along the axis
  /// from outside of the low cell.
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
  std::vector<Triangle> triangles_;            // sorted by cells
  std::vector<std::uint32_t> first_triangle_;  // of each cell
  std::vector<Segment> segments_;              // sorted by faces
  // Of each edge of a cell, by its corner and axis.
  std::unordered_map<std::uint64_t, std::vector<Crossing>> crossings_;
  std::vector<int> winding_;  // of each particle: how many times the mesh winds around it
};

}  // namespace softcell::ppu
