#include "post_process.h"

#include <algorithm>
#include <array>
#include <optional>
#include <stdexcept>
#include <string>

#include "post_shaders.h"
#include "shaders.h"
#include "softcell/base/assert.h"

namespace softcell::render {
namespace {

constexpr GLint kDrawnUnit = 0, kOccludedUnit = 1, kDistanceUnit = 2;
constexpr int kTaps = 8;
constexpr int kTile = 8;          // pixels a side, as in post_shaders.h
constexpr float kFarAway = 1e9f;  // metres, of what was not drawn

struct Size {
  int width, height;
};

/// A texture to draw into.
struct Target {
  GlObject framebuffer, texture;
};

Target make_target(const GladGLContext& gl, const Size& size, GLint format, GLenum channels, GLint filter) {
  Target target{make_framebuffer(gl), make_texture(gl)};
  gl.BindTexture(GL_TEXTURE_2D, target.texture.name());
  gl.TexImage2D(GL_TEXTURE_2D, 0, format, size.width, size.height, 0, channels, GL_FLOAT, nullptr);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, filter);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.name());
  gl.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.texture.name(), 0);
  return target;
}

GlObject make_pass(const GladGLContext& gl, GLuint frame_binding, const char* vertex,
                   std::initializer_list<const char*> fragment_parts) {
  GlObject program = make_program(gl, {kShaderFrame, vertex}, fragment_parts);
  const GLuint block = gl.GetUniformBlockIndex(program.name(), "Frame");
  if (block != GL_INVALID_INDEX) gl.UniformBlockBinding(program.name(), block, frame_binding);
  gl.UseProgram(program.name());
  const auto look_in = [&](const char* sampler, GLint unit) {
    gl.Uniform1i(gl.GetUniformLocation(program.name(), sampler), unit);
  };
  look_in("colours", kDrawnUnit);
  look_in("depth", kDrawnUnit);
  look_in("occluded", kOccludedUnit);
  look_in("distances", kDistanceUnit);
  return program;
}

/// Points that fill the unit circle evenly, turned from one to the next by the golden angle.
std::array<float, 2 * kTaps> spiral() {
  constexpr double kCosine = -0.7373688780783197, kSine = 0.6754902942615238;  // of the golden angle
  // Square roots of the points' shares of the area; written out as no libm is to enter pictures.
  constexpr std::array<double, kTaps> kRadii{0.25, 0.4330127019, 0.5590169944, 0.6614378278,
                                             0.75, 0.8291561976, 0.9013878189, 0.9682458366};
  std::array<float, 2 * kTaps> points{};
  double x = 1, y = 0;
  for (std::size_t i = 0; i < kRadii.size(); ++i) {
    points[2 * i] = static_cast<float>(kRadii[i] * x);
    points[2 * i + 1] = static_cast<float>(kRadii[i] * y);
    const double turned = x * kCosine - y * kSine;
    y = x * kSine + y * kCosine;
    x = turned;
  }
  return points;
}

/// Sixteen turns by multiples of 22.5 degrees, in an order in which neighbours in a square of 4 x 4 differ much.
std::array<float, 32> turns() {
  constexpr std::array<int, 16> kOrder{0, 8, 2, 10, 12, 4, 14, 6, 3, 11, 1, 9, 15, 7, 13, 5};
  constexpr std::array<float, 5> kCosines{1, 0.9238795325f, 0.7071067812f, 0.3826834324f, 0};
  const auto cosine = [&](int sixteenths) {  // of a whole turn
    const int s = ((sixteenths % 16) + 16) % 16;
    const int folded = s > 8 ? 16 - s : s;
    return folded > 4 ? -kCosines[static_cast<std::size_t>(8 - folded)]
                      : kCosines[static_cast<std::size_t>(folded)];
  };
  std::array<float, 32> result{};
  for (std::size_t i = 0; i < kOrder.size(); ++i) {
    result[2 * i] = cosine(kOrder[i]);
    result[2 * i + 1] = cosine(kOrder[i] - 4);
  }
  return result;
}

}  // namespace

struct PostProcess::State {
  State(const GladGLContext& context, const PostProcessSettings& wanted);

  void make_drawn();
  void make_occlusion_passes(const char* drawn_parts, const std::string& samples);
  void occlude(const PixelRect& part);
  void draw(const GlObject& program, const Target& target, const Size& size, const PixelRect& part,
            GLenum shapes = GL_TRIANGLES, GLsizei vertices = 3) const;
  void bind(GLint unit, GLenum kind, const GlObject& texture) const;

  const GladGLContext& gl;
  PostProcessSettings settings;
  GLenum drawn_kind;
  GlObject drawn_framebuffer, drawn_colours, drawn_depth, no_vertices;
  Target picture;
  GlObject compose, smooth;  ///< without occlusion: of several samples or of one
  struct Occlusion {
    Size size;
    Target distances, raw, halfway, blurred;
    GlObject distance, occlusion, blur, compose, smooth;
  };
  std::optional<Occlusion> occlusion;
};

PostProcess::State::State(const GladGLContext& context, const PostProcessSettings& wanted)
    : gl(context),
      settings(wanted),
      drawn_kind(wanted.samples > 1 ? GL_TEXTURE_2D_MULTISAMPLE : GL_TEXTURE_2D) {
  SC_ASSERT(
      settings.width > 0 && settings.height > 0 && settings.samples > 0 && settings.occlusion_pixels >= 0,
      "a picture of {} by {} pixels, {} samples, occlusion {}", settings.width, settings.height,
      settings.samples, settings.occlusion_pixels);
  make_drawn();
  no_vertices = make_vertex_array(gl);
  picture = make_target(gl, {settings.width, settings.height}, GL_RGBA8, GL_RGBA, GL_NEAREST);
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("no framebuffer for the finished picture");

  const std::string samples = "const int kSamples = " + std::to_string(settings.samples) + ";\n";
  const char* const drawn_parts = settings.samples > 1 ? kManySamples : kOneSample;
  if (settings.samples > 1) {
    compose = make_pass(gl, settings.frame_binding, kPostVertex,
                        {kShaderFrame, samples.c_str(), drawn_parts, kNoOcclusion, kComposeFragment});
  } else {
    smooth =
        make_pass(gl, settings.frame_binding, kPostVertex, {kShaderFrame, kNoOcclusion, kSmoothFragment});
  }
  if (settings.occlusion_pixels > 0) make_occlusion_passes(drawn_parts, samples);
  if (gl.GetError() != GL_NO_ERROR) throw std::runtime_error("no memory for a picture");
}

void PostProcess::State::make_drawn() {
  drawn_framebuffer = make_framebuffer(gl);
  drawn_colours = make_texture(gl);
  drawn_depth = make_texture(gl);
  gl.BindFramebuffer(GL_FRAMEBUFFER, drawn_framebuffer.name());
  const auto add = [&](const GlObject& texture, GLenum format, GLenum channels, GLenum type,
                       GLenum attachment) {
    gl.BindTexture(drawn_kind, texture.name());
    if (settings.samples > 1) {
      gl.TexImage2DMultisample(drawn_kind, settings.samples, format, settings.width, settings.height,
                               GL_TRUE);
    } else {
      gl.TexImage2D(drawn_kind, 0, static_cast<GLint>(format), settings.width, settings.height, 0, channels,
                    type, nullptr);
      // Smoothing along edges reads between colours. Depths are read at texels only.
      const GLint filter = attachment == GL_COLOR_ATTACHMENT0 ? GL_LINEAR : GL_NEAREST;
      gl.TexParameteri(drawn_kind, GL_TEXTURE_MIN_FILTER, filter);
      gl.TexParameteri(drawn_kind, GL_TEXTURE_MAG_FILTER, filter);
      gl.TexParameteri(drawn_kind, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
      gl.TexParameteri(drawn_kind, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    }
    gl.FramebufferTexture2D(GL_FRAMEBUFFER, attachment, drawn_kind, texture.name(), 0);
    gl.BindTexture(drawn_kind, 0);
  };
  add(drawn_colours, GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, GL_COLOR_ATTACHMENT0);
  add(drawn_depth, GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, GL_DEPTH_ATTACHMENT);
  if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
    throw std::runtime_error("no framebuffer with " + std::to_string(settings.samples) + " samples a pixel");
}

void PostProcess::State::make_occlusion_passes(const char* drawn_parts, const std::string& samples) {
  const int pixels = settings.occlusion_pixels;
  const Size size{(settings.width + pixels - 1) / pixels, (settings.height + pixels - 1) / pixels};
  const auto pass = [&](std::initializer_list<const char*> parts) {
    return make_pass(gl, settings.frame_binding, kPostVertex, parts);
  };
  occlusion.emplace(
      Occlusion{.size = size,
                .distances = make_target(gl, size, GL_RG32F, GL_RG, GL_NEAREST),
                .raw = make_target(gl, size, GL_RG32F, GL_RG, GL_NEAREST),
                .halfway = make_target(gl, size, GL_RG32F, GL_RG, GL_NEAREST),
                .blurred = make_target(gl, size, GL_RG8, GL_RG, GL_LINEAR),
                .distance = pass({kShaderFrame, samples.c_str(), drawn_parts,
                                  settings.samples == 1 ? kWithEdges : "\n", kDistanceFragment}),
                .occlusion = pass({kShaderFrame, kOcclusionFragment}),
                .blur = pass({kShaderFrame, kOcclusionBlurFragment}),
                .compose = {},
                .smooth = {}});
  Occlusion& o = *occlusion;
  if (settings.samples > 1) {
    o.compose = pass({kShaderFrame, samples.c_str(), drawn_parts, kWithOcclusion, kComposeFragment});
  } else {
    o.smooth =
        make_pass(gl, settings.frame_binding, kTileVertex, {kShaderFrame, kWithOcclusion, kSmoothFragment});
  }
  for (const Target* const target : {&o.distances, &o.raw, &o.halfway, &o.blurred}) {
    gl.BindFramebuffer(GL_FRAMEBUFFER, target->framebuffer.name());
    if (gl.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      throw std::runtime_error("no framebuffer for ambient occlusion");
  }
  const auto uniform = [&](const GlObject& program, const char* name) {
    gl.UseProgram(program.name());
    return gl.GetUniformLocation(program.name(), name);
  };
  gl.Uniform1i(uniform(o.distance, "pixels"), pixels);
  gl.Uniform1f(uniform(o.occlusion, "pixels"), static_cast<float>(pixels));
  gl.Uniform2fv(uniform(o.occlusion, "taps"), kTaps, spiral().data());
  gl.Uniform2fv(uniform(o.occlusion, "turns"), 16, turns().data());
  for (const GlObject* const program : {&o.compose, &o.smooth}) {
    if (program->name() == 0) continue;
    gl.Uniform1i(uniform(*program, "pixels"), pixels);
    gl.Uniform2f(uniform(*program, "texels"), 1.0f / static_cast<float>(pixels * size.width),
                 1.0f / static_cast<float>(pixels * size.height));
  }
}

void PostProcess::State::bind(GLint unit, GLenum kind, const GlObject& texture) const {
  gl.ActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
  gl.BindTexture(kind, texture.name());
  gl.ActiveTexture(GL_TEXTURE0);
}

/// @param part  of the target, rows counted from the bottom
void PostProcess::State::draw(const GlObject& program, const Target& target, const Size& size,
                              const PixelRect& part, GLenum shapes, GLsizei vertices) const {
  gl.BindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.name());
  gl.Viewport(0, 0, size.width, size.height);
  gl.Scissor(part.left, part.top, part.right - part.left, part.bottom - part.top);
  gl.UseProgram(program.name());
  gl.DrawArrays(shapes, 0, vertices);
}

void PostProcess::State::occlude(const PixelRect& part) {
  Occlusion& o = *occlusion;
  const int pixels = settings.occlusion_pixels;
  const PixelRect texels{part.left / pixels, part.top / pixels, (part.right + pixels - 1) / pixels,
                         (part.bottom + pixels - 1) / pixels};
  bind(kDrawnUnit, drawn_kind, drawn_depth);
  draw(o.distance, o.distances, o.size, texels);
  gl.BindTexture(drawn_kind, 0);
  bind(kDistanceUnit, GL_TEXTURE_2D, o.distances.texture);
  // What is not drawn keeps the value that it is cleared to.
  gl.BindFramebuffer(GL_FRAMEBUFFER, o.raw.framebuffer.name());
  gl.ClearColor(0, kFarAway, 0, 0);
  gl.Scissor(texels.left, texels.top, texels.right - texels.left, texels.bottom - texels.top);
  gl.Clear(GL_COLOR_BUFFER_BIT);
  gl.ClearColor(0, 0, 0, 0);
  draw(o.occlusion, o.raw, o.size, texels);
  gl.UseProgram(o.blur.name());
  const GLint along = gl.GetUniformLocation(o.blur.name(), "along");
  gl.Uniform2i(along, 1, 0);
  bind(kOccludedUnit, GL_TEXTURE_2D, o.raw.texture);
  draw(o.blur, o.halfway, o.size, texels);
  gl.Uniform2i(along, 0, 1);
  bind(kOccludedUnit, GL_TEXTURE_2D, o.halfway.texture);
  draw(o.blur, o.blurred, o.size, texels);
  bind(kOccludedUnit, GL_TEXTURE_2D, o.blurred.texture);
}

PostProcess::PostProcess(const GladGLContext& gl, const PostProcessSettings& settings)
    : state_(std::make_unique<State>(gl, settings)) {}
PostProcess::~PostProcess() = default;

GLuint PostProcess::drawn() const { return state_->drawn_framebuffer.name(); }
GLuint PostProcess::picture() const { return state_->picture.framebuffer.name(); }

void PostProcess::run(const PixelRect& part, bool with_occlusion) {
  State& state = *state_;
  const GladGLContext& gl = state.gl;
  const PostProcessSettings& settings = state.settings;
  SC_ASSERT(part.left >= 0 && part.top >= 0 && part.right <= settings.width && part.bottom <= settings.height,
            "columns {} to {} and rows {} to {} of a picture of {} by {} pixels", part.left, part.right,
            part.top, part.bottom, settings.width, settings.height);
  with_occlusion = with_occlusion && state.occlusion;
  // Occlusion and its blur look as far, edges and rasterizers a pixel or two.
  const int around =
      with_occlusion ? static_cast<int>(max_reach(settings.height)) + 4 * settings.occlusion_pixels : 3;
  const PixelRect grown{std::max(part.left - around, 0), std::max(settings.height - part.bottom - around, 0),
                        std::min(part.right + around, settings.width),
                        std::min(settings.height - part.top + around, settings.height)};  // from the bottom
  gl.Disable(GL_DEPTH_TEST);
  gl.Enable(GL_SCISSOR_TEST);
  gl.BindVertexArray(state.no_vertices.name());
  if (with_occlusion) state.occlude(grown);
  const Size size{settings.width, settings.height};
  state.bind(kDrawnUnit, state.drawn_kind, state.drawn_colours);
  if (settings.samples > 1) {
    state.draw(with_occlusion ? state.occlusion->compose : state.compose, state.picture, size, grown);
  } else {
    gl.BindFramebuffer(GL_READ_FRAMEBUFFER, state.drawn_framebuffer.name());
    gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, state.picture.framebuffer.name());
    gl.Disable(GL_SCISSOR_TEST);
    gl.BlitFramebuffer(grown.left, grown.top, grown.right, grown.bottom, grown.left, grown.top, grown.right,
                       grown.bottom, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    gl.Enable(GL_SCISSOR_TEST);
    if (with_occlusion) {
      const int columns = (size.width + kTile - 1) / kTile, rows = (size.height + kTile - 1) / kTile;
      state.draw(state.occlusion->smooth, state.picture, size, grown, GL_POINTS, columns * rows);
    } else {
      state.draw(state.smooth, state.picture, size, grown);
    }
  }
  gl.BindTexture(state.drawn_kind, 0);
  gl.Disable(GL_SCISSOR_TEST);
}

}  // namespace softcell::render
