#include "material_painter.h"

#include <cstddef>
#include <memory>
#include <optional>

#include "mesh_store.h"
#include "shaders.h"
#include "softcell/base/assert.h"

namespace softcell::render {
namespace {

constexpr GLint kBaseUnit = 1, kMetallicRoughnessUnit = 2, kNormalUnit = 3,
                kEmissionUnit = 4;  // the shadow map has unit 0

constexpr char kMaterialVertex[] = R"glsl(
layout(location = 3) in vec4 vertex_colour;
out vec4 tint;
void main() {
  place_vertex();
  tint = vertex_colour;
}
)glsl";

// The sun by the microfacet model with the distribution GGX, its visibility and Schlick's Fresnel term; sky and ground
// for the rest, blurred by roughness. Colours of light are those that a white matte surface would show, so 1/pi is part
// of them.
constexpr char kMaterialFragment[] = R"glsl(
in vec3 position;
in vec3 normal;
in vec3 shadow_position;
in vec2 texture_position;
in vec4 tint;
uniform vec4 colour;
uniform vec2 metallic_roughness;
uniform float normal_scale;
uniform vec3 emission;
uniform float alpha_cutoff;
uniform float opacity;
uniform sampler2D base_texture;
uniform sampler2D metallic_roughness_texture;
uniform sampler2D normal_texture;
uniform sampler2D emission_texture;
out vec4 result;

// The texture's directions on the surface as it is deformed now, from the change of position and texture coordinates
// across the pixel. So vertices need no tangents, and skinning need not compute them.
vec3 mapped_normal(vec3 n) {
  vec3 across = dFdx(position), down = dFdy(position);
  vec2 texture_across = dFdx(texture_position), texture_down = dFdy(texture_position);
  vec3 p = cross(down, n), q = cross(n, across);
  vec3 along_u = p * texture_across.x + q * texture_down.x;
  vec3 along_v = p * texture_across.y + q * texture_down.y;
  float longest = max(dot(along_u, along_u), dot(along_v, along_v));
  if (!(longest > 0.0)) return n;
  vec3 map = texture(normal_texture, texture_position).xyz * (255.0 / 127.0) - 128.0 / 127.0;
  map.xy *= normal_scale;
  return normalize((along_u * map.x + along_v * map.y) / sqrt(longest) + n * max(map.z, 0.05));
}

vec3 environment(vec3 toward, float roughness) {
  vec3 matte = mix(ground.rgb, sky.rgb, 0.5 * toward.y + 0.5);
  vec3 above = background(max(toward.y, 0.0));
  float horizon = clamp(0.5 + toward.y * (8.0 - 7.0 * roughness), 0.0, 1.0);
  return mix(mix(ground.rgb, above, horizon), matte, roughness);
}

float fifth(float x) { return x * x * x * x * x; }

vec3 shade_material(vec3 n, vec3 base, float metallic, float roughness, vec3 own_light) {
  vec3 toward_eye = normalize(eye.xyz - position);
  vec3 half_way = normalize(toward_eye + toward_light.xyz);
  float facing_eye = max(dot(n, toward_eye), 0.002);
  float facing_sun = dot(n, toward_light.xyz);
  float facing_half = clamp(dot(n, half_way), 0.0, 1.0);
  float width = max(roughness * roughness, 0.01);
  float squared = width * width;
  vec3 matte = base * (1.0 - metallic);
  vec3 mirror = mix(vec3(0.04), base, metallic);

  float sun = facing_sun > 0.0 ? facing_sun * sunlight(shadow_position) : 0.0;
  float slope = facing_half * facing_half * (squared - 1.0) + 1.0;
  float lit = max(facing_sun, 0.002);
  float visible = 0.5 / (lit * sqrt(facing_eye * facing_eye * (1.0 - squared) + squared) +
                         facing_eye * sqrt(lit * lit * (1.0 - squared) + squared));
  vec3 fresnel = mirror + (1.0 - mirror) * fifth(1.0 - max(dot(toward_eye, half_way), 0.0));
  vec3 light = sun * light_colour.rgb * (matte * (1.0 - fresnel) + fresnel * (squared / (slope * slope) * visible));

  // What is mirrored of the surroundings, summed over the microfacets: a fit by B. Karis, with a power of five for an
  // exponential.
  vec4 fit = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
  float grazing = min(fit.x * fit.x, fifth(1.0 - facing_eye)) * fit.x + fit.y;
  vec2 share = vec2(-1.04, 1.04) * grazing + fit.zw;
  vec3 reflected = max(mirror * share.x + share.y, 0.0);
  light += matte * mix(ground.rgb, sky.rgb, 0.5 * n.y + 0.5);
  light += reflected * environment(reflect(-toward_eye, n), roughness);
  return encode(tone(light + own_light));
}

void main() {
  vec3 n = normalize(gl_FrontFacing ? normal : -normal);
  vec4 base = colour;
  float metallic = metallic_roughness.x, roughness = metallic_roughness.y;
#ifdef VERTEX_COLOURS
  base *= tint;
#endif
#ifdef BASE_TEXTURE
  base *= texture(base_texture, texture_position);
#endif
#ifdef METALLIC_ROUGHNESS_TEXTURE
  vec4 numbers = texture(metallic_roughness_texture, texture_position);
  metallic *= numbers.b;
  roughness *= numbers.g;
#endif
#ifdef NORMAL_TEXTURE
  n = mapped_normal(n);
#endif
  vec3 own_light = emission;
#ifdef EMISSION_TEXTURE
  own_light *= texture(emission_texture, texture_position).rgb;
#endif
  float alpha = 1.0;
#ifdef MASK
  alpha = clamp((base.a - alpha_cutoff) / max(fwidth(base.a), 1e-4) + 0.5, 0.0, 1.0);
  if (alpha == 0.0) discard;
#endif
#ifdef BLEND
  alpha = base.a;
  if (alpha == 0.0) discard;
#endif
  result = vec4(shade_material(n, base.rgb, metallic, roughness, own_light), alpha * opacity);
}
)glsl";

/// 0 to MaterialPainter's kKinds - 1.
std::size_t kind_of(const Material& material) {
  return (material.base_texture ? 1u : 0u) + (material.vertex_colours ? 2u : 0u) +
         (material.metallic_roughness_texture ? 4u : 0u) + (material.normal_texture ? 8u : 0u) +
         (material.emission_texture ? 16u : 0u) + 32u * static_cast<std::size_t>(material.alpha_mode);
}

const char* if_defined(bool wanted, const char* definition) { return wanted ? definition : "\n"; }

}  // namespace

struct MaterialPainter::Program {
  Program(const GladGLContext& gl, const Material& material, const char* sun, GLuint frame_binding)
      : object(make_program(
            gl, {kShaderFrame, kPlacedVertex, kMaterialVertex},
            {kShaderFrame, if_defined(material.base_texture.has_value(), "#define BASE_TEXTURE\n"),
             if_defined(material.vertex_colours, "#define VERTEX_COLOURS\n"),
             if_defined(material.metallic_roughness_texture.has_value(),
                        "#define METALLIC_ROUGHNESS_TEXTURE\n"),
             if_defined(material.normal_texture.has_value(), "#define NORMAL_TEXTURE\n"),
             if_defined(material.emission_texture.has_value(), "#define EMISSION_TEXTURE\n"),
             if_defined(material.alpha_mode == AlphaMode::kMask, "#define MASK\n"),
             if_defined(material.alpha_mode == AlphaMode::kBlend, "#define BLEND\n"), sun, kShaderLighting,
             kMaterialFragment})) {
    const auto uniform = [&](const char* name) { return gl.GetUniformLocation(object.name(), name); };
    model = uniform("model");
    normal_matrix = uniform("normal_matrix");
    colour = uniform("colour");
    metallic_roughness = uniform("metallic_roughness");
    normal_scale = uniform("normal_scale");
    emission = uniform("emission");
    alpha_cutoff = uniform("alpha_cutoff");
    opacity = uniform("opacity");
    gl.UniformBlockBinding(object.name(), gl.GetUniformBlockIndex(object.name(), "Frame"), frame_binding);
    gl.UseProgram(object.name());
    gl.Uniform1i(uniform("base_texture"), kBaseUnit);
    gl.Uniform1i(uniform("metallic_roughness_texture"), kMetallicRoughnessUnit);
    gl.Uniform1i(uniform("normal_texture"), kNormalUnit);
    gl.Uniform1i(uniform("emission_texture"), kEmissionUnit);
  }

  GlObject object;
  GLint model, normal_matrix, colour, metallic_roughness, normal_scale, emission, alpha_cutoff, opacity;
};

MaterialPainter::Program& MaterialPainter::program(const Material& material) {
  const std::size_t kind = kind_of(material);
  SC_ASSERT(kind < kKinds, "a material of kind {} of {}", kind, kKinds);
  if (programs_[kind] == nullptr)
    programs_[kind] = std::make_shared<Program>(gl_, material, sun_, frame_binding_);
  return *programs_[kind];
}

void MaterialPainter::use(const Material& material, const MeshStore& meshes, const Eigen::Matrix4f& pose,
                          const Eigen::Matrix3f& normal_matrix, float opacity) {
  SC_ASSERT(opacity >= 0 && opacity <= 1, "an opacity of {}", opacity);
  const Program& with = program(material);
  const auto bind = [&](const std::optional<TextureId>& texture, GLint unit) {
    if (!texture) return;
    gl_.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    gl_.BindTexture(GL_TEXTURE_2D, meshes.texture(*texture).name());
  };
  bind(material.base_texture, kBaseUnit);
  bind(material.metallic_roughness_texture, kMetallicRoughnessUnit);
  bind(material.normal_texture, kNormalUnit);
  bind(material.emission_texture, kEmissionUnit);
  gl_.ActiveTexture(GL_TEXTURE0);
  gl_.UseProgram(with.object.name());
  gl_.UniformMatrix4fv(with.model, 1, GL_FALSE, pose.data());
  gl_.UniformMatrix3fv(with.normal_matrix, 1, GL_FALSE, normal_matrix.data());
  const Eigen::Vector3f& base = material.base_colour;
  gl_.Uniform4f(with.colour, base.x(), base.y(), base.z(), material.alpha);
  gl_.Uniform2f(with.metallic_roughness, material.metallic, material.roughness);
  gl_.Uniform1f(with.normal_scale, material.normal_scale);
  gl_.Uniform3fv(with.emission, 1, material.emission.data());
  gl_.Uniform1f(with.alpha_cutoff, material.alpha_cutoff);
  gl_.Uniform1f(with.opacity, opacity);
}

}  // namespace softcell::render
