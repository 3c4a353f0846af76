#include "ppu/mesh_import/mesh_file_check.h"

#include "ppu/mesh_import/mesh_file_check_formats.h"
#include "ppu/mesh_import/mesh_file_text.h"

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

MeshFileContents check_mesh_file(std::string_view bytes, MeshFormat format) {
  MeshFileContents contents;
  switch (format) {
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
  return contents;
}

}  // namespace softcell::ppu
