// libFuzzer target: any bytes, as each of the three formats (chosen by the first byte), give a valid mesh or
// a std::runtime_error.

#include <cstdlib>
#include <stdexcept>
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
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size == 0) return 0;
  const MeshFormat formats[] = {MeshFormat::kObj, MeshFormat::kPly, MeshFormat::kStl};
  try {
    check(parse_mesh({reinterpret_cast<const char*>(data) + 1, size - 1}, formats[data[0] % 3]));
  } catch (const std::runtime_error&) {
    // refused, as it may be
  }
  return 0;
}
