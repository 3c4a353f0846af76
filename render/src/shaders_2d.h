#pragma once
// The GLSL programs of painter_2d.cpp. Colours are encoded as on the screen throughout. Only operations that IEEE
// arithmetic defines (and sqrt), as in shaders.h.

namespace softcell::render {

/// Two triangles' worth of a picture: gl_FragCoord says where.
inline constexpr char kWholePicture2d[] = R"glsl(#version 330 core
void main() {
  gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)glsl";

/// Blurs along one axis. The weights are those of the middle and of the texels on either side.
inline constexpr char kBlur2d[] = R"glsl(#version 330 core
uniform sampler2D source;
uniform vec2 texels_per_pixel;  // of the source, for a pixel of the result
uniform vec2 step_in_texels;    // along the axis
uniform int taps;               // on either side
uniform float weights[92];
out vec4 result;
void main() {
  vec2 size = vec2(textureSize(source, 0));
  vec2 at = gl_FragCoord.xy * texels_per_pixel;
  float sum = weights[0] * texture(source, at / size).r;
  for (int i = 1; i <= taps; ++i) {
    vec2 away = float(i) * step_in_texels;
    sum += weights[i] * (texture(source, (at - away) / size).r + texture(source, (at + away) / size).r);
  }
  result = vec4(sum);
}
)glsl";

inline constexpr char kPaper2d[] = R"glsl(#version 330 core
uniform sampler2D shadow;
uniform vec2 shadow_size;    // of the shadow's texture, in the picture's pixels
uniform vec2 middle;         // of the picture, pixels
uniform vec2 centre;         // what it shows there, metres
uniform float pixel;         // metres
uniform float squares;       // metres
uniform vec3 paper;
uniform vec3 line_colour;
uniform float strength;      // of the shadow
uniform float line_width;    // pixels
out vec4 result;

// Share of the pixel that is covered by lines of `width` pixels, `apart` metres from each other.
float lines(vec2 world, float apart, float width) {
  vec2 away = abs(fract(world / apart + 0.5) - 0.5) * apart / pixel;
  vec2 covered = clamp(0.5 * width + 0.5 - away, 0.0, 1.0);
  float fade = clamp(apart / pixel / width / 8.0 - 0.25, 0.0, 1.0);  // too narrow to be squares
  return fade * max(covered.x, covered.y);
}

void main() {
  vec2 world = centre + (gl_FragCoord.xy - middle) * pixel;
  float fine = 0.28 * lines(world, squares, line_width);
  float strong = 0.50 * lines(world, 4.0 * squares, line_width);
  vec3 colour = mix(paper, line_colour, max(fine, strong));
  float shade = strength * texture(shadow, gl_FragCoord.xy / shadow_size).r;
  result = vec4(colour * (1.0 - shade * vec3(1.0, 0.94, 0.84)), 1.0);  // what light there is, is a blue sky's
}
)glsl";

inline constexpr char kShape2dVertex[] = R"glsl(#version 330 core
layout(location = 0) in vec2 vertex_position;
layout(location = 1) in vec2 vertex_slope;
layout(location = 2) in vec2 vertex_texture;
uniform vec2 centre;    // metres
uniform vec2 to_clip;   // of a metre
out vec2 slope;
out vec2 texture_position;
void main() {
  slope = vertex_slope;
  texture_position = vertex_texture;
  gl_Position = vec4((vertex_position - centre) * to_clip, 0.0, 1.0);
}
)glsl";

inline constexpr char kShape2dFragment[] = R"glsl(#version 330 core
in vec2 slope;
uniform vec4 colour;
uniform float hatching;  // pixels between two lines; 0: none
out vec4 result;
void main() {
  // The light comes from the upper left.
  float facing = clamp(dot(slope, vec2(-0.9, 1.2)), -1.0, 1.0);
  float steep = min(dot(slope, slope), 1.0);
  vec3 lit = facing > 0.0 ? mix(colour.rgb, vec3(1.0), 0.38 * facing) : colour.rgb * (1.0 + 0.30 * facing);
  lit *= 1.0 - 0.12 * steep;
  if (hatching > 0.0) {
    float away = abs(fract((gl_FragCoord.x - gl_FragCoord.y) / hatching) - 0.5) * hatching * 0.70710678;
    float covered = clamp(0.09 * hatching + 0.5 - away, 0.0, 1.0);
    lit *= 1.0 - 0.16 * covered;
  }
  result = vec4(lit, colour.a);
}
)glsl";

inline constexpr char kTexturedShape2dFragment[] = R"glsl(#version 330 core
in vec2 texture_position;
uniform vec4 colour;
uniform sampler2D picture;
out vec4 result;
// Linear light to sRGB, as in shaders.h.
vec3 encode(vec3 x) {
  vec3 s1 = sqrt(x);
  vec3 s2 = sqrt(s1);
  vec3 s3 = sqrt(s2);
  return 0.662002687 * s1 + 0.684122060 * s2 - 0.323583601 * s3 - 0.0225411470 * x;
}
void main() {
  vec4 texel = texture(picture, texture_position);
  result = vec4(encode(texel.rgb), texel.a * colour.a);
}
)glsl";

/// What casts a shadow.
inline constexpr char kMask2dFragment[] = R"glsl(#version 330 core
out vec4 result;
void main() { result = vec4(1.0); }
)glsl";

inline constexpr char kTexturedMask2dFragment[] = R"glsl(#version 330 core
in vec2 texture_position;
uniform sampler2D picture;
out vec4 result;
void main() {
  if (texture(picture, texture_position).a < 0.5) discard;
  result = vec4(1.0);
}
)glsl";

/// Lines and dots: all that lies within a radius of a point or of a stretch.
inline constexpr char kStroke2dVertex[] = R"glsl(#version 330 core
layout(location = 0) in vec2 vertex_position;  // metres
layout(location = 1) in vec2 vertex_across;    // from the point or the stretch, pixels
layout(location = 2) in float vertex_radius;   // pixels
layout(location = 3) in vec4 vertex_colour;
uniform vec2 centre;
uniform vec2 to_clip;
out vec2 across;
out float radius;
out vec4 colour;
void main() {
  across = vertex_across;
  radius = vertex_radius;
  colour = vertex_colour;
  gl_Position = vec4((vertex_position - centre) * to_clip, 0.0, 1.0);
}
)glsl";

inline constexpr char kStroke2dFragment[] = R"glsl(#version 330 core
in vec2 across;
in float radius;
in vec4 colour;
out vec4 result;
void main() {
  float covered = clamp(radius + 0.5 - length(across), 0.0, 1.0);
  result = vec4(colour.rgb, colour.a * covered * min(2.0 * radius, 1.0));
}
)glsl";

}  // namespace softcell::render
