#include "ppu/mesh_import/mesh_file_check.h"

#include <algorithm>

#include "ppu/mesh_import/mesh_file_check_formats.h"
#include "ppu/mesh_import/mesh_file_text.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

void add_polygon(MeshFileContents& contents, std::size_t corners, const std::string& where) {
  if (corners < 3) refuse(where + "a face has " + std::to_string(corners) + " corners; it needs at least 3");
  if (corners > kMaxPolygonCorners) {
    refuse(where + "a face has more than " + std::to_string(kMaxPolygonCorners) + " corners");
  }
  contents.triangles += corners - 2;
  if (contents.triangles > kMaxMeshTriangles) {
    refuse("it has more than " + std::to_string(kMaxMeshTriangles) + " triangles");
  }
}

std::string mesh_part_name(std::span<const std::string_view> words) {
  std::string name;
  for (const std::string_view word : words) {
    if (!name.empty()) name += ' ';
    name += word.substr(0, kMaxMeshNameBytes);
    if (name.size() >= kMaxMeshNameBytes) break;
  }
  name.resize(std::min(name.size(), kMaxMeshNameBytes));
  return name;
}

void extend_parts(MeshFileContents& contents, const std::string& object, const std::string& material) {
  SC_ASSERT(contents.triangles <= kMaxMeshTriangles, "a file of {} triangles", contents.triangles);
  std::vector<NamedPart>& parts = contents.parts;
  if (parts.empty() || parts.back().object != object || parts.back().material != material) {
    if (parts.size() == kMaxMeshParts) {
      refuse("its objects and materials change more than " + std::to_string(kMaxMeshParts) + " times");
    }
    const std::uint32_t first = parts.empty() ? 0 : parts.back().first_triangle + parts.back().triangle_count;
    parts.push_back({.object = object, .material = material, .first_triangle = first});
  }
  parts.back().triangle_count = static_cast<std::uint32_t>(contents.triangles) - parts.back().first_triangle;
}

MeshFileContents check_mesh_file(std::string_view bytes, MeshFormat format) {
  MeshFileContents contents;
  switch (format) {
    case MeshFormat::kGltf:
      SC_ASSERT(false, "glTF of {} bytes is read by parse_gltf()", bytes.size());
      break;
    case MeshFormat::kObj:
      contents = check_obj(bytes);
      break;
    case MeshFormat::kPly:
      contents = check_ply(bytes);
      break;
    case MeshFormat::kStl:
      contents = check_stl(bytes);
      break;
  }
  if (contents.triangles == 0)
    refuse("it has no faces, only points or lines; a mesh of triangles was expected");
  const auto has_no_name = [](const NamedPart& part) { return part.object.empty() && part.material.empty(); };
  if (std::all_of(contents.parts.begin(), contents.parts.end(), has_no_name)) contents.parts.clear();
  return contents;
}

}  // namespace softcell::ppu
