#pragma once
// How the parts of a mesh look: colours, textures, and how they reflect light.

#include <Eigen/Core>
#include <cstdint>
#include <optional>

namespace softcell::render {

/// Handle to a texture of one Renderer.
struct TextureId {
  std::uint32_t value = 0;
  std::uint32_t generation = 0;  ///< 0: the handle names nothing
};

/// What a texture shows beyond its borders.
enum class Wrap : std::uint8_t { kRepeat, kMirror, kClamp };

/// How the pixels of a picture become a texture.
struct TextureSettings {
  bool linear = false;  ///< the channels are numbers, as in normal maps, not sRGB-encoded colours
  Wrap wrap_u = Wrap::kRepeat, wrap_v = Wrap::kRepeat;
};

/// How a material with an alpha below 1 is drawn.
enum class AlphaMode : std::uint8_t {
  kOpaque,  ///< everything is drawn; alpha is not used
  kMask,    ///< only places with an alpha of the cutoff or more
  kBlend,  ///< a share of each pixel's samples, in any order of parts; five steps with the usual four samples
};

/// The metallic-roughness model of glTF 2.0 under one sun, sky and ground. Each number is multiplied by the texture beside it.
struct Material {
  Eigen::Vector3f base_colour{1, 1, 1};  ///< in linear light, each channel 0..1
  float alpha = 1;                       ///< 0..1
  std::optional<TextureId> base_texture = {};
  /// Whether the base colour is multiplied by the colours of Renderer::set_vertex_colours().
  bool vertex_colours = false;
  float metallic = 0;                                        ///< 0..1
  float roughness = 0.6f;                                    ///< 0..1
  std::optional<TextureId> metallic_roughness_texture = {};  ///< linear: green is roughness, blue metallic
  std::optional<TextureId> normal_texture = {};  ///< linear: x along u, y along v, z along the normal
  float normal_scale = 1;                        ///< of x and y
  Eigen::Vector3f emission{0, 0, 0};             ///< emitted light, linear, each channel 0 or above
  std::optional<TextureId> emission_texture = {};
  AlphaMode alpha_mode = AlphaMode::kOpaque;
  float alpha_cutoff = 0.5f;  ///< above 0
  bool two_sided = false;     ///< draw inner sides, too
};

/// Consecutive triangles of a mesh with their own material.
struct PartDraw {
  std::uint32_t first_triangle = 0, triangle_count = 0;
  Material material = {};
};

}  // namespace softcell::render
