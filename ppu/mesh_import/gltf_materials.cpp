#include "ppu/mesh_import/gltf_materials.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "ppu/mesh_import/colour.h"
#include "ppu/mesh_import/mesh_file_check.h"
#include "ppu/mesh_import/mesh_file_text.h"

namespace softcell::ppu {
namespace {

constexpr std::uint32_t kRepeat = 10497, kMirror = 33648, kClamp = 33071;
constexpr std::uint32_t kMaxTextureSets = 16;
constexpr std::string_view kTransform = "KHR_texture_transform";

TextureWrap wrap_of(const GltfValue& sampler, const char* key) {
  switch (sampler.whole(key, 0xFFFF, kRepeat)) {
    case kRepeat:
      return TextureWrap::kRepeat;
    case kMirror:
      return TextureWrap::kMirror;
    case kClamp:
      return TextureWrap::kClamp;
    default:
      sampler.refuse("its " + std::string(key) + " is none of 10497, 33071 and 33648");
  }
}

/// A colour factor of 3 or 4 numbers from 0 to 1, in linear light, as MeshMaterial has it.
std::optional<Eigen::Vector4f> colour_of(const GltfValue& owner, const char* key) {
  std::array<double, 4> linear{};
  if (!owner.numbers(key, linear)) return std::nullopt;
  Eigen::Vector4f colour;
  for (int c = 0; c < 4; ++c)
    colour[c] = static_cast<float>(std::clamp(linear[static_cast<std::size_t>(c)], 0.0, 1.0));
  return srgb_encoded(colour);
}

}  // namespace

std::shared_ptr<const MeshPicture> GltfMaterials::picture(std::uint32_t image, std::string& file) {
  const GltfValue description = root_.item("images", image);
  if (const std::string* const uri = description.whole_text("uri");
      uri != nullptr && !uri->starts_with("data:")) {
    file = file_of_uri(*uri).substr(0, kMaxMeshNameBytes);
    if (file.empty()) {
      add_not_read("the picture " + name_in_quotes(*uri) + ", which is no file");
      return nullptr;
    }
    return pictures_.from_file(file_of_uri(*uri));
  }
  const auto known = embedded_.find(image);
  if (known != embedded_.end()) return known->second;
  const std::string name = description.place();
  if (const std::string* const uri = description.whole_text("uri"))
    return embedded_[image] = pictures_.from_bytes(decode_data_uri(*uri, name), name);
  const auto view = description.index("bufferView", "bufferViews", buffers_.views());
  if (!view) description.refuse("it has neither a uri nor a bufferView");
  return embedded_[image] = pictures_.from_bytes(buffers_.view(*view).bytes, name);
}

GltfCoordinates GltfMaterials::coordinates(const GltfValue& use) {
  GltfCoordinates found;
  found.set = static_cast<std::uint32_t>(use.whole("texCoord", kMaxTextureSets, 0));
  for (const std::string& extension : use.names("extensions")) {
    if (extension != kTransform) {
      add_not_read("the extension " + name_in_quotes(extension));
      continue;
    }
    const GltfValue transform = use.object("extensions").object(kTransform);
    std::array<double, 2> offset{0, 0}, scale{1, 1};
    transform.numbers("offset", offset);
    transform.numbers("scale", scale);
    const double turn = double{transform.number("rotation", -1000, 1000, 0)};
    const auto c = static_cast<float>(std::cos(turn)), s = static_cast<float>(std::sin(turn));
    const auto along_u = static_cast<float>(scale[0]), along_v = static_cast<float>(scale[1]);
    found.linear << c * along_u, s * along_v, -s * along_u, c * along_v;
    found.offset = {static_cast<float>(offset[0]), static_cast<float>(offset[1])};
    found.set = static_cast<std::uint32_t>(transform.whole("texCoord", kMaxTextureSets, found.set));
  }
  return found;
}

MeshTexture GltfMaterials::texture(const GltfValue& owner, const char* key,
                                   std::optional<GltfCoordinates>& shared) {
  MeshTexture texture;
  const auto use = owner.optional_object(key);
  if (!use) return texture;
  const GltfCoordinates own = coordinates(*use);
  if (shared.value_or(own) != own) {
    add_not_read("a texture with other texture coordinates than its material's base colour");
    return texture;
  }
  const auto number = use->index("index", "textures", root_.size("textures"));
  if (!number) use->refuse("it has no 'index'");
  const GltfValue description = root_.item("textures", *number);
  for (const std::string& extension : description.names("extensions"))
    add_not_read("the extension " + name_in_quotes(extension));
  if (const auto sampler_number = description.index("sampler", "samplers", root_.size("samplers"))) {
    const GltfValue sampler = root_.item("samplers", *sampler_number);
    texture.wrap_u = wrap_of(sampler, "wrapS");
    texture.wrap_v = wrap_of(sampler, "wrapT");
  }
  if (const auto image = description.index("source", "images", root_.size("images")))
    texture.picture = picture(*image, texture.file);
  if (texture.picture) shared = own;
  return texture;
}

GltfMaterial GltfMaterials::read(std::uint32_t number) {
  const GltfValue description = root_.item("materials", number);
  GltfMaterial material;
  MeshMaterial& look = material.look;
  look.name = description.text("name", kMaxMeshNameBytes);
  look.base_colour = Eigen::Vector4f::Ones();
  look.metallic = look.roughness = 1;  // glTF's defaults
  std::optional<GltfCoordinates> shared;
  if (const auto pbr = description.optional_object("pbrMetallicRoughness")) {
    if (const auto colour = colour_of(*pbr, "baseColorFactor")) look.base_colour = colour;
    look.base_texture = texture(*pbr, "baseColorTexture", shared);
    look.metallic = pbr->number("metallicFactor", 0, 1, 1);
    look.roughness = pbr->number("roughnessFactor", 0, 1, 1);
    look.metallic_roughness_texture = texture(*pbr, "metallicRoughnessTexture", shared);
  }
  const auto extensions = description.optional_object("extensions");
  for (const std::string& extension : description.names("extensions")) {
    constexpr std::string_view kOlder = "KHR_materials_pbrSpecularGlossiness";
    if (extension != kOlder || description.has("pbrMetallicRoughness")) {
      add_not_read("the extension " + name_in_quotes(extension));
      continue;
    }
    // The model before metallic-roughness: what both have in common.
    const GltfValue older = extensions->object(kOlder);
    if (const auto colour = colour_of(older, "diffuseFactor")) look.base_colour = colour;
    look.base_texture = texture(older, "diffuseTexture", shared);
    look.metallic = 0;
    look.roughness = 1 - older.number("glossinessFactor", 0, 1, 1);
    add_not_read("specular colours");
  }
  if (const auto normal = description.optional_object("normalTexture")) {
    constexpr double kMaxScale = 100;
    look.normal_texture = texture(description, "normalTexture", shared);
    look.normal_scale = normal->number("scale", -kMaxScale, kMaxScale, 1);
  }
  if (description.has("occlusionTexture")) add_not_read("occlusion textures");
  std::array<double, 3> emission{};
  description.numbers("emissiveFactor", emission);
  if (emission != std::array<double, 3>{}) {
    look.emission = srgb_encoded({static_cast<float>(std::clamp(emission[0], 0.0, 1.0)),
                                  static_cast<float>(std::clamp(emission[1], 0.0, 1.0)),
                                  static_cast<float>(std::clamp(emission[2], 0.0, 1.0)), 1})
                        .head<3>();
    look.emission_texture = texture(description, "emissiveTexture", shared);
  }
  const std::string alpha = description.text("alphaMode", 16);
  if (alpha == "MASK") {
    look.alpha = MeshAlpha::kMask;
  } else if (alpha == "BLEND") {
    look.alpha = MeshAlpha::kBlend;
  } else if (!alpha.empty() && alpha != "OPAQUE") {
    description.refuse("its alphaMode is " + in_quotes(alpha) + "; OPAQUE, MASK or BLEND was expected");
  }
  look.alpha_cutoff = description.number("alphaCutoff", 0, std::numeric_limits<float>::max(), 0.5f);
  look.two_sided = description.flag("doubleSided", false);
  material.coordinates = shared.value_or(GltfCoordinates());
  return material;
}

}  // namespace softcell::ppu
