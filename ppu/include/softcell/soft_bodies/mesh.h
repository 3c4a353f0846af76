#pragma once
// Triangle meshes, from which soft bodies are made and with which they are drawn.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "softcell/soft_bodies/mesh_material.h"

namespace softcell::ppu {

/// Consecutive triangles of a mesh that belong to one object and have one material.
struct MeshPart {
  std::string object;                     ///< the object's or group's name; empty: it has none
  std::optional<std::uint32_t> material;  ///< its number in TriangleMesh::materials; none: it has none
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;

  bool operator==(const MeshPart&) const = default;
};

/// An indexed triangle mesh in metres. `normals` has one unit vector per position. Each attribute below
/// `triangles` is either empty or complete; softcell carries attributes along and does not interpret them.
struct TriangleMesh {
  /// Metres. A position that belongs to no triangle is skinned with the others, and refused if it lies outside of the lattice.
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside

  std::vector<Eigen::Vector2f> texture_coordinates = {};  ///< one per position; v grows upwards
  /// One per position: red, green, blue, alpha, 0..1, sRGB-encoded. Multiplied with the material's base colour.
  std::vector<Eigen::Vector4f> colours = {};
  /// Ascending; together they have all triangles. The meshes of pieces of a broken body have a part "cut" behind these (fracture.h).
  std::vector<MeshPart> parts = {};
  std::vector<MeshMaterial> materials = {};  ///< of the parts

  bool operator==(const TriangleMesh&) const = default;
};

/// A mesh from positions and triangles alone, for example those of a collision shape, with the normals that it needs: smooth across an edge
/// at which the surface bends by 60 degrees or less, else sharp. Equal positions count as one; a position at a sharp edge becomes several
/// vertices. Triangles without area and positions without a triangle are left out, so vertices have numbers of their own. Deterministic.
/// Any thread.
/// @param positions  metres
/// @param triangles  numbers of positions, counter-clockwise seen from outside
/// @throws std::runtime_error     a position is not finite
/// @throws std::invalid_argument  a triangle names a position that does not exist
TriangleMesh make_mesh(std::span<const Eigen::Vector3f> positions,
                       std::span<const std::array<std::uint32_t, 3>> triangles);

/// An axis-aligned box, metres. A default one is the point 0.
template <int kDimension>
struct Bounds {
  using Vector = Eigen::Vector<float, kDimension>;
  Vector low = Vector::Zero(), high = Vector::Zero();
};

/// The mesh's axis-aligned box. @pre at least one position.
Bounds<3> bounds(const TriangleMesh& mesh);

/// Moves and scales the mesh so that its box is centred on 0 and its longest side has the given length in metres. @pre at least one
/// position; longest_side is positive and finite.
void fit(TriangleMesh& mesh, float longest_side);

/// Turns the mesh about its origin. @pre `rotation` is orthogonal, with determinant 1.
void rotate(TriangleMesh& mesh, const Eigen::Matrix3f& rotation);

/// Turns a mesh whose z axis points upwards so that its y axis points upwards: (x, y, z) becomes (x, z, -y), exactly.
void turn_z_up(TriangleMesh& mesh);

/// Multiplies all lengths. @pre the factor is positive and finite.
void scale(TriangleMesh& mesh, float factor);

/// Checks that the mesh's arrays fit each other.
/// @throws std::invalid_argument  the number of normals or of an attribute is not that of positions, an index is out of range, a normal has
/// no length or is not finite, or parts leave triangles out or name a material that does not exist; the message says which.
void validate(const TriangleMesh& mesh);

}  // namespace softcell::ppu
