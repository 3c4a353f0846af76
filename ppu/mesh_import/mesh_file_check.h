#pragma once
// Strict structural checks of mesh files. The importing library repairs or skips what is broken; here a
// broken file is refused before the library sees it, and what the file promises is known, to compare with
// what the library delivers.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace softcell::ppu {

enum class MeshFormat { kObj, kPly, kStl, kGltf };

inline constexpr std::size_t kMaxMeshTriangles = 4'000'000;
/// Cutting a polygon takes time that grows with the square of its corners, so that a file of a few megabytes
/// could take hours. PLY files count corners in a byte, hence the number.
inline constexpr std::size_t kMaxPolygonCorners = 255;
/// Each part has names of its own, which a file of a few bytes a part could make fill the memory.
inline constexpr std::size_t kMaxMeshParts = 65'536;
/// The longest name of an object, a material or a texture file; longer ones are cut.
inline constexpr std::size_t kMaxMeshNameBytes = 255;

/// Consecutive triangles of a file that belong to one object and have one material.
struct NamedPart {
  std::string object, material;  ///< names; empty: it has none
  std::uint32_t first_triangle = 0;
  std::uint32_t triangle_count = 0;
};

/// What a file holds, counted from its text or bytes.
struct MeshFileContents {
  std::size_t triangles = 0;  ///< after its polygons are cut: corners - 2 for each
  bool has_normals = false;   ///< one for every corner, to be used
  bool has_texture_coordinates = false;
  bool has_colours = false;           ///< of vertices or triangles
  std::vector<NamedPart> parts = {};  ///< over the triangles counted here; none: the file names none
  std::string material_library = {};  ///< the name of the last one that the file wants; empty: none
  /// What of the file the library is to see: no more than the geometry, where the library could be harmed by
  /// the rest. None: all of it.
  std::string geometry = {};
};

/// A name as a file has it: its words, one space between them, no longer than kMaxMeshNameBytes.
std::string mesh_part_name(std::span<const std::string_view> words);

/// Checks all of an OBJ, PLY or STL file: syntax, that nothing is missing at its end, finite numbers, indices in range, faces
/// of at least three corners, limits. Allocates nothing that a number in the file could inflate.
/// @throws std::runtime_error  a clause about the file without its name: where, what is wrong, what was
/// expected.
MeshFileContents check_mesh_file(std::string_view bytes, MeshFormat format);

}  // namespace softcell::ppu
