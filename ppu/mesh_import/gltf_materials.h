#pragma once
// The materials of a glTF file, each read when a part of the mesh first has it.

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ppu/mesh_import/gltf_accessors.h"
#include "ppu/mesh_import/gltf_json.h"
#include "ppu/mesh_import/model_pictures.h"
#include "softcell/soft_bodies/mesh_material.h"

namespace softcell::ppu {

/// Which texture coordinates a texture has: those of a set, moved, turned and scaled (KHR_texture_transform). v grows
/// downwards.
struct GltfCoordinates {
  std::uint32_t set = 0;  ///< TEXCOORD_n
  Eigen::Matrix2f linear = Eigen::Matrix2f::Identity();
  Eigen::Vector2f offset{0, 0};

  bool operator==(const GltfCoordinates&) const = default;
};

struct GltfMaterial {
  MeshMaterial look;
  GltfCoordinates coordinates;  ///< of all its textures
};

class GltfMaterials {
 public:
  /// All outlive this.
  GltfMaterials(const GltfValue& root, GltfBuffers& buffers, const ReadNeighbour& read_neighbour,
                std::vector<std::string>& not_read)
      : root_(root), buffers_(buffers), not_read_(not_read), pictures_(read_neighbour, not_read) {}

  /// @param number  in the document's array. @throws std::runtime_error  a clause.
  GltfMaterial read(std::uint32_t number);

 private:
  /// @param shared  the coordinates of the material's other textures; none: this is the first
  MeshTexture texture(const GltfValue& owner, const char* key, std::optional<GltfCoordinates>& shared);
  GltfCoordinates coordinates(const GltfValue& use);
  std::shared_ptr<const MeshPicture> picture(std::uint32_t image, std::string& file);
  void add_not_read(const std::string& phrase) { ppu::add_not_read(not_read_, phrase); }

  const GltfValue& root_;
  GltfBuffers& buffers_;
  std::vector<std::string>& not_read_;
  ModelPictures pictures_;
  std::map<std::uint32_t, std::shared_ptr<const MeshPicture>> embedded_;
};

}  // namespace softcell::ppu
