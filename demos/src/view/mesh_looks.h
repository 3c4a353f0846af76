#pragma once
// Gives the renderer what the author of a mesh painted: textures, vertex colours, and parts with their materials.

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "softcell/render/renderer.h"
#include "softcell/soft_bodies/mesh.h"

namespace softcell::demos {

class MeshLooks {
 public:
  /// @param renderer  must outlive this object, as must the meshes' pictures; each picture is uploaded once.
  explicit MeshLooks(render::Renderer& renderer) : renderer_(renderer) {}

  /// Whether a mesh has more to draw than its shape.
  static bool has_looks(const ppu::TriangleMesh& mesh);

  /// Uploads the attributes of a mesh's vertices and the pictures of its materials.
  /// @param vertices  for each vertex of `to` the number of the mesh's vertex
  /// @param otherwise  the colour of parts whose materials state none
  /// @return the parts to draw, over the mesh's triangles
  std::vector<render::PartDraw> upload(const ppu::TriangleMesh& mesh, std::span<const std::uint32_t> vertices,
                                       const render::Colour& otherwise, render::MeshId to);
  /// The same for a mesh whose vertices are in the mesh's own order.
  std::vector<render::PartDraw> upload(const ppu::TriangleMesh& mesh, const render::Colour& otherwise,
                                       render::StaticMeshId to);

 private:
  std::optional<render::TextureId> texture(const ppu::MeshTexture& texture, bool linear);
  std::vector<render::PartDraw> parts(const ppu::TriangleMesh& mesh, const render::Colour& otherwise);
  render::Material material(const ppu::MeshMaterial& look, bool has_colours, bool has_coordinates,
                            const render::Colour& otherwise);

  render::Renderer& renderer_;
  using Key = std::tuple<const ppu::MeshPicture*, bool, ppu::TextureWrap, ppu::TextureWrap>;
  std::map<Key, render::TextureId> textures_;
};

}  // namespace softcell::demos
