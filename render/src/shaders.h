#pragma once
// The GLSL programs. Each shader is kShaderFrame followed by parts below. Only operations that IEEE
// arithmetic defines (and sqrt): pow, exp and the like are approximated differently by different processors'
// code generators.

namespace softcell::render {

/// First part of every shader: what is the same for the whole frame. Mirrored by FrameBlock in renderer.cpp.
inline constexpr char kShaderFrame[] = R"glsl(#version 330 core
layout(std140) uniform Frame {
  mat4 view_projection;
  mat4 light_projection;   // world to the shadow map's clip space
  mat4 view_to_world;      // rotation only
  vec4 eye;
  vec4 toward_light;       // unit length
  vec4 light_colour;
  vec4 sky;
  vec4 ground;
  vec4 background_top;
  vec4 background_bottom;
  vec4 shadow_texel;       // x: one texel in shadow map coordinates, y: metres to compare off a surface
  vec4 pixels_per_tangent; // x: picture, y: pixels per metre in the shadow map
  vec4 picture_size;       // pixels, and one over them
  vec4 view_plane;         // xy: half the picture's width and height at a distance of 1
  vec4 inverse_depth;      // x: one over the distance of the near plane, y: that less one over the far plane's
  vec4 occlusion;          // x: radius in metres, y: strength, z: radius in pixels at most, w: metres beyond which there is none
  vec4 upwards;            // unit length
};
)glsl";

/// Share of the sun that arrives, one of the two for every lit fragment. Eight taps, each an interpolation of
/// 2 x 2 comparisons, on a square and a rhombus around it, which together fall off evenly over 6 texels; or one. A
/// surface is compared so far off itself, along its normal, that no tap sees it: kSoftReach and kQuickReach texels.
inline constexpr char kSoftSunlight[] = R"glsl(
uniform sampler2DShadow shadow_map;
float sunlight(vec3 at) {
  at.z = min(at.z, 1.0);  // behind the map's depth the sun shines, as it does beside it
  float near = 0.9 * shadow_texel.x, far = 2.1 * shadow_texel.x;
  float inner = texture(shadow_map, at + vec3(-near, -near, 0.0)) + texture(shadow_map, at + vec3(near, -near, 0.0)) +
                texture(shadow_map, at + vec3(-near, near, 0.0)) + texture(shadow_map, at + vec3(near, near, 0.0));
  float outer = texture(shadow_map, at + vec3(-far, 0.0, 0.0)) + texture(shadow_map, at + vec3(far, 0.0, 0.0)) +
                texture(shadow_map, at + vec3(0.0, -far, 0.0)) + texture(shadow_map, at + vec3(0.0, far, 0.0));
  return 0.16 * inner + 0.09 * outer;
}
)glsl";
inline constexpr float kSoftReach = 3.1f, kQuickReach = 2;
inline constexpr char kQuickSunlight[] = R"glsl(
uniform sampler2DShadow shadow_map;
float sunlight(vec3 at) { return texture(shadow_map, vec3(at.xy, min(at.z, 1.0))); }
)glsl";

/// Light and tone, for every lit fragment, after one of the above.
inline constexpr char kShaderLighting[] = R"glsl(
// Linear light to sRGB, a fit in square roots within 0.002 of the curve.
vec3 encode(vec3 x) {
  vec3 s1 = sqrt(x);
  vec3 s2 = sqrt(s1);
  vec3 s3 = sqrt(s2);
  return 0.662002687 * s1 + 0.684122060 * s2 - 0.323583601 * s3 - 0.0225411470 * x;
}

// Leaves the lower two thirds as they are, so that colours stay those asked for, and bends what is above towards white.
vec3 tone(vec3 x) {
  vec3 above = max(x - 0.65, 0.0);
  return min(x, 0.65) + above / (1.0 + above / 0.35);
}

// What is behind everything, seen `upward` of the horizon: the sine of the angle. Haze lies on the horizon.
vec3 background(float upward) {
  float away = 1.0 - abs(upward);
  vec3 far = upward > 0.0 ? background_top.rgb : mix(background_bottom.rgb, background_top.rgb, 0.6);
  return mix(far, background_bottom.rgb, away * away * away);
}

vec3 shade(vec3 position, vec3 normal, vec3 shadow_position, vec3 albedo, float softness) {
  vec3 toward_eye = normalize(eye.xyz - position);
  vec3 half_way = normalize(toward_eye + toward_light.xyz);
  float facing = dot(normal, toward_light.xyz);
  float sun = facing > 0.0 ? facing * sunlight(shadow_position) : 0.0;

  float shine = max(dot(normal, half_way), 0.0);
  shine *= shine;  // to the 32nd power by squaring
  shine *= shine;
  shine *= shine;
  shine *= shine;
  shine *= shine;

  // Seen at a grazing angle every surface mirrors the sky a little: it draws the outline of round bodies.
  float grazing = 1.0 - max(dot(normal, toward_eye), 0.0);
  grazing *= grazing;
  grazing *= grazing;

  vec3 ambient = mix(ground.rgb, sky.rgb, 0.5 * normal.y + 0.5);
  vec3 light = albedo * (ambient + sun * light_colour.rgb);
  // Light that has entered a soft body leaves it about where the sun grazes it, in a deeper colour.
  light += (softness * max(1.0 - abs(facing + 0.15), 0.0)) * albedo * albedo * light_colour.rgb;
  light += ((0.3 * shine + softness * shine * shine * shine * shine) * sun) * light_colour.rgb + (0.25 * grazing) * sky.rgb;
  return encode(tone(light));
}
)glsl";

/// The part that vertex shaders of lit surfaces have in common.
inline constexpr char kPlacedVertex[] = R"glsl(
layout(location = 0) in vec3 vertex_position;
layout(location = 1) in vec3 vertex_normal;
layout(location = 2) in vec2 vertex_texture;
uniform mat4 model;
uniform mat3 normal_matrix;
out vec3 position;
out vec3 normal;
out vec3 shadow_position;
out vec2 texture_position;
void place_vertex() {
  vec4 world = model * vec4(vertex_position, 1.0);
  position = world.xyz;
  normal = normalize(normal_matrix * vertex_normal);
  texture_position = vertex_texture;
  // Compared a little off the surface, along the normal: a surface must not shadow itself (acne), and an offset along
  // the light would part shadows from the feet that cast them.
  vec3 lifted = position + normal * shadow_texel.y;
  shadow_position = 0.5 * (light_projection * vec4(lifted, 1.0)).xyz + 0.5;
  gl_Position = view_projection * world;
}
)glsl";

inline constexpr char kSurfaceVertex[] = R"glsl(
out vec2 pattern_position;
void main() {
  place_vertex();
  pattern_position = vertex_position.xz;
}
)glsl";

/// How much light goes through a surface, one of the two for kSurfaceFragment and kTexturedFragment.
inline constexpr char kRigid[] = "const float softness = 0.0;\n";
inline constexpr char kSoft[] = "const float softness = 0.22;\n";

inline constexpr char kSurfaceFragment[] = R"glsl(
in vec3 position;
in vec3 normal;
in vec3 shadow_position;
uniform vec4 colour;
out vec4 result;
void main() {
  vec3 n = normalize(gl_FrontFacing ? normal : -normal);
  result = vec4(shade(position, n, shadow_position, colour.rgb, softness), colour.a);
}
)glsl";

inline constexpr char kTexturedFragment[] = R"glsl(
in vec3 position;
in vec3 normal;
in vec3 shadow_position;
in vec2 texture_position;
uniform vec4 colour;
uniform sampler2D picture;
out vec4 result;
void main() {
  vec3 n = normalize(gl_FrontFacing ? normal : -normal);
  vec3 albedo = colour.rgb * texture(picture, texture_position).rgb;
  result = vec4(shade(position, n, shadow_position, albedo, softness), colour.a);
}
)glsl";

inline constexpr char kTilesFragment[] = R"glsl(
in vec3 position;
in vec3 normal;
in vec3 shadow_position;
in vec2 pattern_position;
uniform vec4 colour;
out vec4 result;

// A checkerboard of unit squares averaged over the pixel's footprint, so that it fades to grey far away and never flickers.
float checker(vec2 p, vec2 footprint) {
  vec2 i = 2.0 * (abs(fract((p - 0.5 * footprint) * 0.5) - 0.5) - abs(fract((p + 0.5 * footprint) * 0.5) - 0.5)) / footprint;
  return 0.5 - 0.5 * i.x * i.y;
}

// Share of the pixel's footprint that lies on the lines between the squares.
float lines(vec2 p, vec2 footprint) {
  const float half_width = 0.012;
  vec2 away = abs(fract(p + 0.5) - 0.5);  // from the nearest line
  vec2 covered = clamp((half_width + 0.5 * footprint - away) / footprint, 0.0, 1.0) * min(2.0 * half_width / footprint, 1.0);
  return max(covered.x, covered.y);
}

void main() {
  vec2 footprint = max(fwidth(pattern_position), 1e-4);
  vec3 albedo = colour.rgb * (1.0 - 0.16 * checker(pattern_position, footprint)) * (1.0 - 0.35 * lines(pattern_position, footprint));
  vec3 n = normalize(gl_FrontFacing ? normal : -normal);
  result = vec4(shade(position, n, shadow_position, albedo, 0.0), colour.a);
}
)glsl";

/// Depth only, for the shadow map.
inline constexpr char kShadowVertex[] = R"glsl(
layout(location = 0) in vec3 vertex_position;
uniform mat4 model;
void main() { gl_Position = light_projection * (model * vec4(vertex_position, 1.0)); }
)glsl";

inline constexpr char kShadowFragment[] = R"glsl(
void main() {}
)glsl";

/// Particles: discs that face the eye, shaded as the front half of a sphere.
inline constexpr char kParticleVertex[] = R"glsl(
layout(location = 0) in vec3 vertex_position;
uniform float radius;
out vec3 centre;
out vec3 shadow_position;
void main() {
  centre = vertex_position;
  vec3 lifted = vertex_position + toward_light.xyz * radius;
  shadow_position = 0.5 * (light_projection * vec4(lifted, 1.0)).xyz + 0.5;
  gl_Position = view_projection * vec4(vertex_position, 1.0);
  gl_PointSize = 2.0 * radius * pixels_per_tangent.x / gl_Position.w;
}
)glsl";

inline constexpr char kParticleFragment[] = R"glsl(
in vec3 centre;
in vec3 shadow_position;
uniform vec4 colour;
uniform float radius;
out vec4 result;
void main() {
  vec2 at = vec2(2.0, -2.0) * gl_PointCoord + vec2(-1.0, 1.0);
  float squared = dot(at, at);
  float distance = sqrt(squared);
  float coverage = clamp((1.0 - distance) / max(fwidth(distance), 1e-4) + 0.5, 0.0, 1.0);
  if (coverage == 0.0) discard;  // a single sample a pixel has no coverage to take it from
  vec3 n = mat3(view_to_world) * vec3(at, sqrt(max(1.0 - squared, 0.0)));
  result = vec4(shade(centre + radius * n, n, shadow_position, colour.rgb, 0.0), coverage);
}
)glsl";

inline constexpr char kParticleShadowVertex[] = R"glsl(
layout(location = 0) in vec3 vertex_position;
uniform float radius;
void main() {
  gl_Position = light_projection * vec4(vertex_position, 1.0);
  gl_PointSize = 2.0 * radius * pixels_per_tangent.y;
}
)glsl";

inline constexpr char kParticleShadowFragment[] = R"glsl(
void main() {
  vec2 at = 2.0 * gl_PointCoord - 1.0;
  if (dot(at, at) > 1.0) discard;
}
)glsl";

inline constexpr char kLinkVertex[] = R"glsl(
layout(location = 0) in vec3 vertex_position;
void main() { gl_Position = view_projection * vec4(vertex_position, 1.0); }
)glsl";

inline constexpr char kLinkFragment[] = R"glsl(
uniform vec4 colour;
out vec4 result;
void main() { result = vec4(encode(tone(colour.rgb)), 1.0); }
)glsl";

/// A triangle that covers the picture at the far plane.
inline constexpr char kBackgroundVertex[] = R"glsl(
out vec3 ray;  // x, y: across the line of sight, z: upwards
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
  vec2 across = corner * view_plane.xy;
  ray = vec3(across, dot(mat3(view_to_world) * vec3(across, -1.0), upwards.xyz));
  gl_Position = vec4(corner, 1.0, 1.0);
}
)glsl";

inline constexpr char kBackgroundFragment[] = R"glsl(
in vec3 ray;
out vec4 result;
void main() { result = vec4(encode(background(ray.z / sqrt(1.0 + dot(ray.xy, ray.xy)))), 1.0); }
)glsl";

}  // namespace softcell::render
