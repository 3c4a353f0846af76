#pragma once
// Corners and triangles as a file has them, and the mesh that they become.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// Corners and triangles, checked: finite numbers, indices in range, no triangle without area.
struct MeshSoup {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;              ///< none, or one of any length per position
  std::vector<Eigen::Vector2f> texture_coordinates;  ///< none, or one per position
  std::vector<Eigen::Vector4f> colours;              ///< none, or one per position
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint32_t> number_in_file;  ///< of each triangle, ascending; those without area are counted
  std::vector<MeshPart> parts;                ///< over the triangles of the file, those without area included
};

/// Adds the triangle unless it has no area. @param number  of the triangle in the file
void add_triangle(MeshSoup& soup, const std::array<std::uint32_t, 3>& corners, std::uint32_t number);

/// Joins equal positions, gives each vertex a normal (the file's, or a smooth one), splits vertices whose corners
/// differ in an attribute, and counts parts in the triangles that are left. Materials stay with the caller.
/// @pre  one triangle at least
TriangleMesh mesh_of(MeshSoup soup);

}  // namespace softcell::ppu
