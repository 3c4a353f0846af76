// libFuzzer target: any bytes, as each of the three formats (chosen by the first byte), give a valid mesh or
// a std::runtime_error. Behind a line "#mtl" an OBJ file's bytes are its material library.

#include <cstdint>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "ppu/mesh_import/parse_mesh.h"

namespace {

using namespace softcell::ppu;

void require(bool condition) {
  if (!condition) std::abort();
}

void check(const TriangleMesh& mesh) {
  require(!mesh.triangles.empty() && mesh.triangles.size() <= kMaxMeshTriangles);
  require(mesh.normals.size() == mesh.positions.size());
  for (const Eigen::Vector3f& position : mesh.positions) require(position.allFinite());
  for (const Eigen::Vector3f& normal : mesh.normals) require(std::abs(normal.norm() - 1) < 1e-3f);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t vertex : triangle) require(vertex < mesh.positions.size());
  }
  validate(mesh);
  for (const Eigen::Vector2f& at : mesh.texture_coordinates) require(at.allFinite());
  for (const Eigen::Vector4f& colour : mesh.colours)
    require(colour.minCoeff() >= 0 && colour.maxCoeff() <= 1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size == 0) return 0;
  const MeshFormat formats[] = {MeshFormat::kObj, MeshFormat::kPly, MeshFormat::kStl};
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  constexpr std::string_view kLibraryBegins = "\n#mtl\n";
  const std::size_t library = bytes.find(kLibraryBegins);
  try {
    check(parse_mesh(bytes.substr(0, library), formats[data[0] % 3],
                     [&](const std::string&, std::uint64_t) -> std::optional<std::string> {
                       if (library == std::string_view::npos) return std::nullopt;
                       return std::string(bytes.substr(library + kLibraryBegins.size()));
                     }));
  } catch (const std::runtime_error&) {
    // refused, as it may be
  }
  return 0;
}
