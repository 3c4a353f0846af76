#pragma once
// How parts of a mesh look: colours and pictures for a renderer. (A soft body's physical material is in its SoftBodySettings.) softcell
// carries mesh materials along; they do not affect the simulation.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace softcell::ppu {

/// A picture in memory: four bytes per pixel, red, green, blue and alpha, rows from top to bottom without padding.
struct MeshPicture {
  int width = 0, height = 0;       ///< pixels
  std::vector<std::uint8_t> rgba;  ///< 4 width height bytes

  bool operator==(const MeshPicture&) const = default;
};

/// What a texture shows beyond the borders of its picture.
enum class TextureWrap : std::uint8_t {
  kRepeat,  ///< the picture again
  kMirror,  ///< the picture again, every second time mirrored
  kClamp,   ///< the colour of the border
};

/// A picture on a mesh. Texture coordinates (0, 0) are the picture's lower left corner, (1, 1) the upper right one.
struct MeshTexture {
  /// The picture's file, as the model's file names it; empty: the picture is embedded, or there is none.
  std::string file;
  std::shared_ptr<const MeshPicture> picture;  ///< null: there is none, or it was not read
  TextureWrap wrap_u = TextureWrap::kRepeat, wrap_v = TextureWrap::kRepeat;

  /// Compares pictures by their content: two readings of one file are equal.
  bool operator==(const MeshTexture& other) const;
};

/// How a part is drawn that is not opaque everywhere.
enum class MeshAlpha : std::uint8_t {
  kOpaque,  ///< alpha is not used
  kMask,    ///< places with an alpha below the cutoff are left out
  kBlend,   ///< the background shines through
};

/// The metallic-roughness model of glTF 2.0. Colours are sRGB-encoded, as in pictures and painting programs: decode them before
/// multiplying. A pixel of a texture is multiplied by the number beside it.
struct MeshMaterial {
  std::string name;  ///< empty: it has none
  /// Red, green, blue, alpha, each 0..1; none: the file gives no colour.
  std::optional<Eigen::Vector4f> base_colour = {};
  MeshTexture base_texture = {};

  float metallic = 0;                           ///< 0..1
  float roughness = 0.6f;                       ///< 0..1, of the microfacets: 0 is a mirror
  MeshTexture metallic_roughness_texture = {};  ///< linear: green is roughness, blue is metallic

  /// Linear: red, green and blue from 0 to 255 are -1 to 1 along the directions in which u grows, v grows, and
  /// the normal.
  MeshTexture normal_texture = {};
  float normal_scale = 1;  ///< of the first two

  Eigen::Vector3f emission{0, 0, 0};  ///< emitted light: red, green, blue, 0..1, sRGB-encoded
  MeshTexture emission_texture = {};  ///< sRGB-encoded

  MeshAlpha alpha = MeshAlpha::kOpaque;
  float alpha_cutoff = 0.5f;  ///< 0..1
  bool two_sided = false;     ///< inner sides are drawn, too

  /// Whether the file gives more than a name; if not, a renderer may choose a colour.
  bool has_looks() const;

  bool operator==(const MeshMaterial&) const = default;
};

}  // namespace softcell::ppu
