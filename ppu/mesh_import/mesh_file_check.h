#pragma once
// Strict structural checks of mesh files. The importing library repairs or skips what is broken; here a
// broken file is refused before the library sees it, and what the file promises is known, to compare with
// what the library delivers.

#include <cstddef>
#include <string>
#include <string_view>

namespace softcell::ppu {

enum class MeshFormat { kObj, kPly, kStl };

inline constexpr std::size_t kMaxMeshTriangles = 4'000'000;
/// Cutting a polygon takes time that grows with the square of its corners, so that a file of a few megabytes
/// could take hours. PLY files count corners in a byte, hence the number.
inline constexpr std::size_t kMaxPolygonCorners = 255;

/// What a file holds, counted from its text or bytes.
struct MeshFileContents {
  std::size_t triangles = 0;  ///< after its polygons are cut: corners - 2 for each
  bool has_normals = false;   ///< one for every corner, to be used
  /// What of the file the library is to see: no more than the geometry, where the library could be harmed by
  /// the rest. None: all of it.
  std::string geometry = {};
};

/// Checks all of a file: syntax, that nothing is missing at its end, finite numbers, indices in range, faces
/// of at least three corners, limits. Allocates nothing that a number in the file could inflate.
/// @throws std::runtime_error  a clause about the file without its name: where, what is wrong, what was
/// expected.
MeshFileContents check_mesh_file(std::string_view bytes, MeshFormat format);

}  // namespace softcell::ppu
