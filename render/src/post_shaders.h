#pragma once
// The GLSL programs that make a picture of what was drawn: ambient occlusion, resolved samples, smooth edges. Each is kShaderFrame
// and the parts below; they draw the triangle of kPostVertex. Only operations that IEEE arithmetic defines, as in shaders.h.

namespace softcell::render {

inline constexpr char kPostVertex[] = R"glsl(
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)glsl";

/// What was drawn, with one sample a pixel or with kSamples of them, which is defined before.
inline constexpr char kOneSample[] = R"glsl(
#define DRAWN sampler2D
vec4 drawn(sampler2D from, ivec2 at) { return texelFetch(from, at, 0); }
)glsl";
inline constexpr char kManySamples[] = R"glsl(
#define DRAWN sampler2DMS
vec4 drawn(sampler2DMS from, ivec2 at) {
  vec4 sum = texelFetch(from, at, 0);
  for (int i = 1; i < kSamples; ++i) sum += texelFetch(from, at, i);
  return sum / float(kSamples);
}
)glsl";

/// Converts the depth buffer to metres along the line of sight, one texel for `pixels` by `pixels` pixels, and 1 where there is an edge.
inline constexpr char kDistanceFragment[] = R"glsl(
uniform DRAWN depth;
uniform int pixels;
out vec2 result;
float inverse_distance(ivec2 at) {
  float d = texelFetch(depth, clamp(at, ivec2(0), ivec2(picture_size.xy) - 1), 0).r;
  return inverse_depth.x - inverse_depth.y * d;
}
void main() {
  ivec2 at = ivec2(gl_FragCoord.xy) * pixels + pixels / 2;
  float middle = inverse_distance(at);
  result = vec2(1.0 / middle, 0.0);
#ifdef EDGES
  // One over the distance is linear in the picture on planes: what is not is an outline, a crease or strongly curved.
  int d = pixels / 2;
  float across = inverse_distance(at - ivec2(d, 0)) + inverse_distance(at + ivec2(d, 0)) - 2.0 * middle;
  float up = inverse_distance(at - ivec2(0, d)) + inverse_distance(at + ivec2(0, d)) - 2.0 * middle;
  result.g = max(abs(across), abs(up)) > 0.001 * middle ? 1.0 : 0.0;
#endif
}
)glsl";
inline constexpr char kWithEdges[] = "#define EDGES\n";

/// The share of the ambient light that surfaces nearby keep off, estimated from the distances in the picture: each tap is a point
/// of a surface, which takes the more the nearer it is and the steeper it stands over this one. Neighbouring texels turn
/// their taps by other angles; a blur over 4 x 4 texels, one of each angle, makes one smooth value of them.
inline constexpr char kOcclusionFragment[] = R"glsl(
const int kTaps = 8;
const float kGain = 2.2;    // chosen by eye: contacts are seen and creases are not black
uniform sampler2D distances;
uniform vec2 taps[kTaps];   // within the unit circle
uniform vec2 turns[16];     // cosines and sines
uniform float pixels;       // of the picture, in a texel
out vec2 result;            // occlusion and distance

vec3 point(ivec2 texel, float z) {
  vec2 at = (vec2(texel) + 0.5) * pixels * picture_size.zw * 2.0 - 1.0;
  return vec3(at * view_plane.xy, 1.0) * z;
}

void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(distances, 0) - 1;
  float z = texelFetch(distances, here, 0).r;
  result = vec2(0.0, z);
  float radius = occlusion.x;
  float reach = min(radius * pixels_per_tangent.x / (pixels * z), occlusion.z / pixels);  // texels
  if (z > occlusion.w || reach < 1.0) discard;

  // The normal, from the neighbour on either side whose distance is more like that of this texel.
  float left = texelFetch(distances, max(here - ivec2(1, 0), ivec2(0)), 0).r;
  float right = texelFetch(distances, min(here + ivec2(1, 0), last), 0).r;
  float below = texelFetch(distances, max(here - ivec2(0, 1), ivec2(0)), 0).r;
  float above = texelFetch(distances, min(here + ivec2(0, 1), last), 0).r;
  vec3 p = point(here, z);
  vec3 across = abs(left - z) < abs(right - z) ? p - point(here - ivec2(1, 0), left) : point(here + ivec2(1, 0), right) - p;
  vec3 up = abs(below - z) < abs(above - z) ? p - point(here - ivec2(0, 1), below) : point(here + ivec2(0, 1), above) - p;
  vec3 n = normalize(cross(up, across));  // towards the eye, which looks along z

  vec2 turn = turns[(here.x & 3) + 4 * (here.y & 3)];
  vec2 sum = vec2(0.0, 0.001);  // of occlusion, and of taps within the picture
  for (int i = 0; i < kTaps; ++i) {
    vec2 offset = reach * vec2(taps[i].x * turn.x - taps[i].y * turn.y, taps[i].x * turn.y + taps[i].y * turn.x);
    ivec2 texel = ivec2(floor(gl_FragCoord.xy + offset));
    ivec2 inside = clamp(texel, ivec2(0), last);
    vec3 v = point(inside, texelFetch(distances, inside, 0).r) - p;
    float squared = dot(v, v) + 1e-4 * radius * radius;
    float within = max(1.0 - squared / (radius * radius), 0.0);
    float above_it = max(dot(v, n) / sqrt(squared) - 0.08, 0.0);  // what is flat up to errors of the normal does not count
    sum += texel == inside ? vec2(within * above_it, 1.0) : vec2(0.0);
  }
  result = vec2(min(kGain * occlusion.y * sum.x / sum.y, 1.0), z);
}
)glsl";

/// One direction of the blur, over four texels that differ in distance by less than the radius of occlusion. The second one
/// adds where there is an edge.
inline constexpr char kOcclusionBlurFragment[] = R"glsl(
uniform sampler2D occluded;
uniform sampler2D distances;
uniform ivec2 along;
out vec2 result;
void main() {
  ivec2 here = ivec2(gl_FragCoord.xy);
  ivec2 last = textureSize(occluded, 0) - 1;
  vec2 middle = texelFetch(occluded, here, 0).rg;
  vec2 sum = vec2(middle.r, 1.0);
  for (int i = 1; i < 4; ++i) {
    vec2 other = texelFetch(occluded, clamp(here + (i < 3 ? i - 3 : 1) * along, ivec2(0), last), 0).rg;
    sum += max(1.0 - abs(other.g - middle.g) / occlusion.x, 0.0) * vec2(other.r, 1.0);
  }
  float blurred = sum.r / sum.g;
  // What is hardly seen is left out: where nothing changes, nothing is drawn.
  result = along.x > 0 ? vec2(blurred, middle.g) : vec2(max(blurred - 0.012, 0.0), texelFetch(distances, here, 0).g);
}
)glsl";

/// What occlusion leaves of the light of a pixel, and whether an edge may be near.
inline constexpr char kNoOcclusion[] = R"glsl(
vec2 occlusion_here() { return vec2(0.0, 1.0); }
)glsl";
inline constexpr char kWithOcclusion[] = R"glsl(
uniform sampler2D occluded;
uniform vec2 texels;  // of `occluded`, in a pixel of the picture
vec2 occlusion_here() { return texture(occluded, gl_FragCoord.xy * texels).rg; }
)glsl";

inline constexpr char kComposeFragment[] = R"glsl(
uniform DRAWN colours;
out vec4 result;
void main() { result = vec4((1.0 - occlusion_here().r) * drawn(colours, ivec2(gl_FragCoord.xy)).rgb, 1.0); }
)glsl";

/// A point for each tile of kTile by kTile pixels that has an edge or occlusion, in place of the triangle of kPostVertex: software
/// runs a whole shader for what is discarded as well.
inline constexpr char kTileVertex[] = R"glsl(
const int kTile = 8;
uniform sampler2D occluded;
uniform int pixels;  // of the picture, in a texel of `occluded`
void main() {
  ivec2 size = ivec2(picture_size.xy);
  int columns = (size.x + kTile - 1) / kTile;
  ivec2 corner = kTile * ivec2(gl_VertexID % columns, gl_VertexID / columns);
  ivec2 low = max(corner / pixels - 1, ivec2(0)), high = min((corner + kTile) / pixels, textureSize(occluded, 0) - 1);
  vec2 most = vec2(0.0);
  for (int y = low.y; y <= high.y; ++y) {
    for (int x = low.x; x <= high.x; ++x) most = max(most, texelFetch(occluded, ivec2(x, y), 0).rg);
  }
  // A point is not drawn if its middle is outside of the picture.
  vec2 middle = min(vec2(corner + kTile / 2), picture_size.xy - 0.5 * min(picture_size.xy, vec2(kTile)));
  gl_Position = vec4(2.0 * middle * picture_size.zw - 1.0, max(most.x, most.y) > 0.0 ? 0.0 : 2.0, 1.0);
  gl_PointSize = float(kTile);
}
)glsl";

/// Smooth edges where there is one sample a pixel, after T. Lottes' FXAA: where the four diagonal neighbours differ, the colour is
/// averaged along the edge that they show. Green stands for luminance.
inline constexpr char kSmoothFragment[] = R"glsl(
uniform sampler2D colours;
out vec4 result;
void main() {
  vec2 occlusion_and_edge = occlusion_here();
  ivec2 here = ivec2(gl_FragCoord.xy);
  ivec2 last = ivec2(picture_size.xy) - 1;
  ivec2 low = max(here - 1, ivec2(0)), high = min(here + 1, last);
  float a = texelFetch(colours, low, 0).g, b = texelFetch(colours, ivec2(high.x, low.y), 0).g;
  float c = texelFetch(colours, ivec2(low.x, high.y), 0).g, d = texelFetch(colours, high, 0).g;
  vec3 middle = texelFetch(colours, here, 0).rgb;
  float least = min(min(min(a, b), min(c, d)), middle.g), most = max(max(max(a, b), max(c, d)), middle.g);

  vec2 along = vec2((c + d) - (a + b), (a + c) - (b + d));
  float shorter = min(abs(along.x), abs(along.y)) + max(0.03125 * (a + b + c + d), 0.0078125);
  along = clamp(along / shorter, vec2(-6.0), vec2(6.0)) * picture_size.zw;
  vec2 at = gl_FragCoord.xy * picture_size.zw;
  vec3 near = 0.5 * (texture(colours, at - along / 6.0).rgb + texture(colours, at + along / 6.0).rgb);
  vec3 far = 0.5 * near + 0.25 * (texture(colours, at - along / 2.0).rgb + texture(colours, at + along / 2.0).rgb);
  vec3 smooth_colour = far.g < least || far.g > most ? near : far;
  bool is_edge = occlusion_and_edge.g > 0.0 && most - least > max(0.04, 0.1 * most);
  result = vec4((1.0 - occlusion_and_edge.r) * (is_edge ? smooth_colour : middle), 1.0);
}
)glsl";

}  // namespace softcell::render
