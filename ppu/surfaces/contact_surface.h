#pragma once
// The parts of a soft body that collide: points of the drawn surface, and the distance field of its shape at rest.
//
// Contact detection looks up the points in the shapes of others. It looks up corners and edges of others, and the points of other soft
// bodies, in the field, through the inverse of the deformed cell that holds them.
// @source  [FL01] for deformed distance fields, [MZS+11] for contact of an embedded surface.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "softcell/soft_bodies/lattice.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

template <int kDimension>
struct Cracks;
class Solid;

/// A point of the surface and where it lies in its cell.
struct SurfacePointAtRest {
  std::uint32_t cell = 0;
  Eigen::Vector3f xi{0, 0, 0};    ///< 0..1 along each edge of the cell
  Eigen::Vector3f rest{0, 0, 0};  ///< metres, as Lattice::rest_position()
};

/// A particle that collides where the surface around it does not keep others out: particles outside of the surface lag behind it, and
/// particles inside may be all that is left between the two sides of a crushed body.
struct TouchingParticle {
  std::uint32_t particle = 0;
  /// How deep in others the particle may be, in cells, because it lies outside of the surface at rest.
  float allowance = 0;
};

/// A signed distance and the direction in which it grows fastest.
struct FieldValue {
  float distance = 0;                 ///< below 0 inside, in cells
  Eigen::Vector3f gradient{0, 0, 0};  ///< derivative by xi
};

/// The contact surface of a model. Immutable.
class ContactSurface {
 public:
  /// A field has 3 x 3 x 3 nodes in each cell; two neighbouring cells both store the nodes of their common face.
  static constexpr int kNodesPerEdge = 3;
  static constexpr std::size_t kNodes = 27;
  using CellField = std::array<float, kNodes>;
  /// The field is exact up to this distance, in cells; deeper inside, distances are counted in steps from node to node.
  static constexpr float kReach = 2;
  /// The node of a cell at its corner k = bx + 2 by + 4 bz.
  static constexpr std::size_t node_of_corner(std::size_t k) {
    return 2 * ((k >> 2) * kNodesPerEdge * kNodesPerEdge + (k >> 1 & 1u) * kNodesPerEdge + (k & 1u));
  }

  /// Where a node lies in its cell, 0..1 along each edge.
  static Eigen::Vector3f place_of_node(std::size_t node) {
    constexpr auto kEdge = static_cast<std::size_t>(kNodesPerEdge);
    return Eigen::Vector3f(static_cast<float>(node % kEdge), static_cast<float>(node / kEdge % kEdge),
                           static_cast<float>(node / (kEdge * kEdge))) /
           static_cast<float>(kNodesPerEdge - 1);
  }

  /// Parts of the mesh that lie within other parts of it do not count.
  /// @param mesh  closed, or nearly so; if it has no triangles, the lattice's own boundary is used
  ContactSurface(const TriangleMesh& mesh, const Lattice<3>& lattice);
  /// The surface of a piece of a body with a mesh: the same as in the whole, except where the piece is open. Takes time in proportion to
  /// the piece (piece_surface.cpp).
  /// @param mesh    of the piece   @param cracks  of the piece
  ContactSurface(const ContactSurface& whole, const Lattice<3>& piece, const TriangleMesh& mesh,
                 const Cracks<3>& cracks);
  /// Takes points and fields that the caller has computed; no particle collides by itself.
  /// @param points  ascending by cell   @param fields  of each cell, as nodes()
  ContactSurface(std::vector<SurfacePointAtRest> points, std::vector<CellField> fields)
      : points_(std::move(points)), fields_(std::move(fields)) {}

  /// Sorted by cell. Neighbouring points are less than half a cell apart where the surface is flat, and closer where it bends; there are
  /// points at each corner and along each sharp edge of the mesh.
  std::span<const SurfacePointAtRest> points() const { return points_; }
  /// All particles, or none.
  std::span<const TouchingParticle> particles() const { return particles_; }

  /// Distances at a cell's nodes, in cells, x fastest.
  const CellField& nodes(std::uint32_t cell) const { return fields_[cell]; }
  /// The distance from the surface in the shape at rest. @param xi  may lie somewhat outside of the cell
  FieldValue field(std::uint32_t cell, const Eigen::Vector3f& xi) const;

 private:
  void sample(const TriangleMesh& mesh, const Lattice<3>& lattice);
  void measure(const TriangleMesh& mesh, const Lattice<3>& lattice, const Solid* solid);
  void allow_particles(const Lattice<3>& lattice);

  std::vector<SurfacePointAtRest> points_;
  std::vector<TouchingParticle> particles_;
  std::vector<CellField> fields_;  // of each cell: distances at its nodes, in cells, x fastest
};

/// The boundary of a lattice as triangles.
TriangleMesh boundary_of(const Lattice<3>& lattice);

}  // namespace softcell::ppu
