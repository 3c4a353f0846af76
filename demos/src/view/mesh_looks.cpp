#include "mesh_looks.h"

#include <algorithm>
#include <numeric>

#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

/// Like render::srgb().
float linear_of(float encoded) {
  return encoded * (encoded * (encoded * 0.305306011f + 0.682171111f) + 0.012522878f);
}
render::Colour linear_of(const Eigen::Vector3f& encoded) {
  return {linear_of(encoded.x()), linear_of(encoded.y()), linear_of(encoded.z())};
}

render::Wrap wrap_of(ppu::TextureWrap wrap) {
  switch (wrap) {
    case ppu::TextureWrap::kRepeat:
      return render::Wrap::kRepeat;
    case ppu::TextureWrap::kMirror:
      return render::Wrap::kMirror;
    case ppu::TextureWrap::kClamp:
      return render::Wrap::kClamp;
  }
  return render::Wrap::kRepeat;
}

template <class To>
void upload_attributes(render::Renderer& renderer, const ppu::TriangleMesh& mesh,
                       std::span<const std::uint32_t> vertices, To to) {
  if (!mesh.texture_coordinates.empty()) {
    std::vector<Eigen::Vector2f> coordinates;
    for (const std::uint32_t vertex : vertices) coordinates.push_back(mesh.texture_coordinates[vertex]);
    renderer.set_texture_coordinates(to, coordinates);
  }
  if (!mesh.colours.empty()) {
    std::vector<Eigen::Vector4f> colours;
    for (const std::uint32_t vertex : vertices) {
      Eigen::Vector4f& colour = colours.emplace_back(mesh.colours[vertex]);
      colour.head<3>() = linear_of(Eigen::Vector3f(colour.head<3>()));
    }
    renderer.set_vertex_colours(to, colours);
  }
}

}  // namespace

bool MeshLooks::has_looks(const ppu::TriangleMesh& mesh) {
  return !mesh.colours.empty() || std::ranges::any_of(mesh.materials, &ppu::MeshMaterial::has_looks);
}

std::optional<render::TextureId> MeshLooks::texture(const ppu::MeshTexture& texture, bool linear) {
  if (!texture.picture) return std::nullopt;
  const Key key{texture.picture.get(), linear, texture.wrap_u, texture.wrap_v};
  const auto known = textures_.find(key);
  if (known != textures_.end()) return known->second;
  render::Image image;
  image.width = texture.picture->width;
  image.height = texture.picture->height;
  image.rgba = texture.picture->rgba;
  const render::TextureId id = renderer_.add_texture(
      image, {.linear = linear, .wrap_u = wrap_of(texture.wrap_u), .wrap_v = wrap_of(texture.wrap_v)});
  return textures_[key] = id;
}

render::Material MeshLooks::material(const ppu::MeshMaterial& look, bool has_colours, bool has_coordinates,
                                     const render::Colour& otherwise) {
  render::Material material{.vertex_colours = has_colours,
                            .metallic = look.metallic,
                            .roughness = look.roughness,
                            .normal_scale = look.normal_scale,
                            .emission = linear_of(look.emission),
                            .alpha_mode = static_cast<render::AlphaMode>(look.alpha),
                            .alpha_cutoff = look.alpha_cutoff,
                            .two_sided = look.two_sided};
  if (has_coordinates) {
    material.base_texture = texture(look.base_texture, false);
    material.metallic_roughness_texture = texture(look.metallic_roughness_texture, true);
    material.normal_texture = texture(look.normal_texture, true);
    material.emission_texture = texture(look.emission_texture, false);
  }
  if (look.base_colour) {
    material.base_colour = linear_of(Eigen::Vector3f(look.base_colour->head<3>()));
    material.alpha = look.base_colour->w();
  } else if (!has_colours && !material.base_texture) {
    material.base_colour = otherwise;
  }
  return material;
}

std::vector<render::PartDraw> MeshLooks::parts(const ppu::TriangleMesh& mesh,
                                               const render::Colour& otherwise) {
  static_assert(static_cast<int>(ppu::MeshAlpha::kMask) == static_cast<int>(render::AlphaMode::kMask) &&
                static_cast<int>(ppu::MeshAlpha::kBlend) == static_cast<int>(render::AlphaMode::kBlend));
  const bool has_colours = !mesh.colours.empty(), has_coordinates = !mesh.texture_coordinates.empty();
  const auto made = [&](const ppu::MeshMaterial& look) {
    return material(look, has_colours, has_coordinates, otherwise);
  };
  std::vector<render::PartDraw> parts;
  if (mesh.parts.empty())
    parts.push_back({0, static_cast<std::uint32_t>(mesh.triangles.size()), made(ppu::MeshMaterial())});
  for (const ppu::MeshPart& part : mesh.parts) {
    SC_ASSERT(!part.material || *part.material < mesh.materials.size(), "material {} of {}",
              part.material.value_or(0), mesh.materials.size());
    parts.push_back({part.first_triangle, part.triangle_count,
                     made(part.material ? mesh.materials[*part.material] : ppu::MeshMaterial())});
  }
  return parts;
}

std::vector<render::PartDraw> MeshLooks::upload(const ppu::TriangleMesh& mesh,
                                                std::span<const std::uint32_t> vertices,
                                                const render::Colour& otherwise, render::MeshId to) {
  upload_attributes(renderer_, mesh, vertices, to);
  return parts(mesh, otherwise);
}

std::vector<render::PartDraw> MeshLooks::upload(const ppu::TriangleMesh& mesh,
                                                const render::Colour& otherwise, render::StaticMeshId to) {
  std::vector<std::uint32_t> vertices(mesh.positions.size());
  std::iota(vertices.begin(), vertices.end(), 0u);
  upload_attributes(renderer_, mesh, vertices, to);
  return parts(mesh, otherwise);
}

}  // namespace softcell::demos
