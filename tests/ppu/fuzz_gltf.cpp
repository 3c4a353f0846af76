// libFuzzer target: any bytes, as a .gltf or a .glb, give a valid mesh or a std::runtime_error. Every file that they name
// has the bytes behind a line "#file".

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "ppu/mesh_import/mesh_file_check.h"
#include "ppu/mesh_import/parse_mesh.h"

namespace {

using namespace softcell::ppu;

void require_here(bool condition) {
  if (!condition) std::abort();
}

void check_texture(const MeshTexture& texture) {
  if (!texture.picture) return;
  const MeshPicture& picture = *texture.picture;
  require_here(picture.width > 0 && picture.height > 0);
  require_here(picture.rgba.size() ==
               4 * static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
}

void check_gltf(const TriangleMesh& mesh) {
  require_here(!mesh.triangles.empty() && mesh.triangles.size() <= kMaxMeshTriangles);
  for (const Eigen::Vector3f& position : mesh.positions) require_here(position.allFinite());
  for (const Eigen::Vector3f& normal : mesh.normals) require_here(std::abs(normal.norm() - 1) < 1e-3f);
  validate(mesh);
  for (const Eigen::Vector2f& at : mesh.texture_coordinates) require_here(at.allFinite());
  for (const Eigen::Vector4f& colour : mesh.colours)
    require_here(colour.minCoeff() >= 0 && colour.maxCoeff() <= 1);
  for (const MeshMaterial& material : mesh.materials) {
    require_here(material.metallic >= 0 && material.metallic <= 1);
    require_here(material.roughness >= 0 && material.roughness <= 1);
    require_here(!material.base_colour ||
                 (material.base_colour->minCoeff() >= 0 && material.base_colour->maxCoeff() <= 1));
    check_texture(material.base_texture);
    check_texture(material.metallic_roughness_texture);
    check_texture(material.normal_texture);
    check_texture(material.emission_texture);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  constexpr std::string_view kFileBegins = "\n#file\n";
  const std::size_t file = bytes.find(kFileBegins);
  try {
    check_gltf(parse_mesh(bytes.substr(0, file), MeshFormat::kGltf,
                          [&](const std::string&, std::uint64_t most) -> std::optional<std::string> {
                            if (file == std::string_view::npos) return std::nullopt;
                            const std::string_view rest = bytes.substr(file + kFileBegins.size());
                            if (rest.size() > most) return std::nullopt;
                            return std::string(rest);
                          }));
  } catch (const std::runtime_error&) {
    // refused, as it may be
  }
  return 0;
}
