#include "softcell/render/renderer.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>

#include "gl_objects.h"
#include "mesh_store.h"
#include "overlay_painter.h"
#include "painter_2d.h"
#include "painter_3d.h"
#include "render_targets.h"
#include "softcell/base/assert.h"

namespace softcell::render {

namespace {

constexpr GLuint kFrameBinding = 0;  // of the uniform block that the programs for three dimensions share

}  // namespace

struct Renderer::State {
  State(GlContext& gl_context, const RendererSettings& settings);
  ~State() { context.make_current(); }  // then the members' objects are deleted

  PixelRect part_to_draw(const std::optional<PixelRect>& changes, bool is_kept) const;

  GlContext& context;
  GladGLContext gl;
  bool has_picture = false;     ///< of the last frame, before it is resolved
  bool has_picture_2d = false;  ///< likewise, of a frame in two dimensions

  std::optional<RenderTargets> targets;     ///< made when `gl` is loaded
  std::unique_ptr<Painter3d> painter_3d;    ///< likewise
  std::unique_ptr<OverlayPainter> overlay;  ///< made when it is first asked for
  std::unique_ptr<Painter2d> painter_2d;    ///< likewise
  MeshStore meshes;
};

Renderer::State::State(GlContext& gl_context, const RendererSettings& settings)
    : context(gl_context), meshes(gl_context, gl, settings.coarse_pixels != 0) {
  SC_ASSERT(settings.occlusion_pixels >= 0, "ambient occlusion for {} pixels at a time",
            settings.occlusion_pixels);
  SC_ASSERT(settings.coarse_pixels >= 0, "vertices moved by {} pixels", settings.coarse_pixels);
  context.make_current();
  const auto load = [](void* user, const char* name) {
    return static_cast<GlContext*>(user)->function(name);
  };
  if (gladLoadGLContextUserPtr(&gl, load, &context) < GLAD_MAKE_VERSION(3, 3)) {
    throw std::runtime_error(context.backend_name() + " offers less than OpenGL 3.3");
  }
  targets.emplace(gl, context.backend_name(),
                  RenderTargetSettings{.width = settings.width,
                                       .height = settings.height,
                                       .shadow_map_size = settings.shadow_map_size,
                                       .samples = settings.samples,
                                       .occlusion_pixels = settings.occlusion_pixels,
                                       .frame_binding = kFrameBinding});
  painter_3d = std::make_unique<Painter3d>(gl, *targets, meshes,
                                           Painter3dSettings{.soft_shadows = settings.soft_shadows,
                                                             .coarse_pixels = settings.coarse_pixels,
                                                             .frame_binding = kFrameBinding});

  gl.Enable(GL_PROGRAM_POINT_SIZE);
  gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);  // a picture has no holes
}

PixelRect Renderer::State::part_to_draw(const std::optional<PixelRect>& changes, bool is_kept) const {
  if (!changes || !is_kept) return {0, 0, targets->width(), targets->height()};
  return {std::max(changes->left, 0), std::max(changes->top, 0), std::min(changes->right, targets->width()),
          std::min(changes->bottom, targets->height())};
}

Renderer::Renderer(GlContext& context, const RendererSettings& settings)
    : state_(std::make_unique<State>(context, settings)) {}

Renderer::~Renderer() = default;

MeshId Renderer::add_mesh(std::span<const std::uint32_t> indices) { return state_->meshes.add_mesh(indices); }
void Renderer::remove_mesh(MeshId id) { state_->meshes.remove_mesh(id); }
void Renderer::update_mesh(MeshId id, std::span<const std::byte> vertices) {
  state_->meshes.update_mesh(id, vertices);
}
MeshId Renderer::add_cell_mesh(std::span<const std::uint32_t> indices, std::span<const CellVertex> vertices,
                               std::size_t corner_count) {
  return state_->meshes.add_cell_mesh(indices, vertices, corner_count);
}
void Renderer::update_corners(MeshId id, std::span<const std::byte> corners, const Eigen::Vector3f& origin) {
  state_->meshes.update_corners(id, corners, origin);
}
void Renderer::set_texture_coordinates(MeshId id, std::span<const Eigen::Vector2f> coordinates) {
  state_->meshes.set_texture_coordinates(id, coordinates);
}
void Renderer::set_texture_coordinates(StaticMeshId id, std::span<const Eigen::Vector2f> coordinates) {
  state_->meshes.set_texture_coordinates(id, coordinates);
}
void Renderer::set_vertex_colours(MeshId id, std::span<const Eigen::Vector4f> colours) {
  state_->meshes.set_vertex_colours(id, colours);
}
void Renderer::set_vertex_colours(StaticMeshId id, std::span<const Eigen::Vector4f> colours) {
  state_->meshes.set_vertex_colours(id, colours);
}
TextureId Renderer::add_texture(const Image& picture, const TextureSettings& settings) {
  return state_->meshes.add_texture(picture, settings, state_->targets->largest_side());
}
void Renderer::remove_texture(TextureId id) { state_->meshes.remove_texture(id); }
void Renderer::remove_static_mesh(StaticMeshId id) { state_->meshes.remove_static_mesh(id); }
void Renderer::set_rest_shape(MeshId id, std::span<const Eigen::Vector3f> positions,
                              std::span<const Eigen::Vector3f> normals) {
  state_->meshes.set_rest_shape(id, positions, normals);
}
std::uint64_t Renderer::uploaded_bytes() const { return state_->meshes.uploaded_bytes(); }
StaticMeshId Renderer::add_static_mesh(std::span<const Eigen::Vector3f> positions,
                                       std::span<const Eigen::Vector3f> normals,
                                       std::span<const Triangle> triangles) {
  return state_->meshes.add_static_mesh(positions, normals, triangles);
}

void Renderer::render(const FrameDescription& frame) {
  State& state = *state_;
  state.painter_3d->check(frame);
  state.context.make_current();
  const GladGLContext& gl = state.gl;
  state.painter_3d->begin(frame);
  gl.Enable(GL_DEPTH_TEST);
  gl.BindTexture(GL_TEXTURE_2D, state.targets->shadow_map());
  const PixelRect part = state.part_to_draw(frame.changes, state.has_picture);
  if (part.left < part.right && part.top < part.bottom) {
    state.painter_3d->draw(frame, part);
    state.targets->frame().run(part, frame.light.occlusion > 0);
    state.has_picture = true;
  }

  state.targets->show(state.targets->frame().picture());
}

Shape2dId Renderer::add_shape(std::span<const Triangle> triangles) {
  State& state = *state_;
  state.context.make_current();
  if (state.painter_2d == nullptr) state.painter_2d = std::make_unique<Painter2d>(state.gl);
  return state.painter_2d->add_shape(triangles);
}

void Renderer::remove_shape(Shape2dId shape) {
  State& state = *state_;
  if (state.painter_2d == nullptr) throw std::invalid_argument("no shape " + std::to_string(shape.value));
  state.context.make_current();
  state.painter_2d->remove_shape(shape);
}

void Renderer::render(const Frame2d& frame) {
  State& state = *state_;
  state.context.make_current();
  if (state.painter_2d == nullptr) state.painter_2d = std::make_unique<Painter2d>(state.gl);
  state.painter_2d->check(frame);
  for (const Shape2d& shape : frame.shapes) {
    if (shape.texture) state.meshes.texture(*shape.texture);
  }
  const PixelRect part = state.part_to_draw(frame.changes, state.has_picture_2d);
  if (part.left < part.right && part.top < part.bottom) {
    state.painter_2d->draw(frame,
                           {.width = state.targets->width(), .height = state.targets->height(), .part = part},
                           [&](TextureId id) { return state.meshes.texture(id).name(); });
    state.has_picture_2d = true;
  }
  state.targets->show(state.painter_2d->framebuffer());
}

const Image& Renderer::pixels() {
  state_->context.make_current();
  return state_->targets->pixels();
}

void Renderer::draw_overlay(const OverlayFont& font, const OverlayMesh& mesh, const Image* sheet) {
  State& state = *state_;
  state.context.make_current();
  if (state.overlay == nullptr) state.overlay = std::make_unique<OverlayPainter>(state.gl);
  state.gl.BindFramebuffer(GL_FRAMEBUFFER, state.targets->shown_framebuffer());
  state.overlay->draw(font, sheet, mesh, state.targets->width(), state.targets->height());
}

void Renderer::present(int width, int height) {
  SC_ASSERT(width >= 0 && height >= 0, "a window of {} by {} pixels", width, height);
  State& state = *state_;
  state.context.make_current();
  const GladGLContext& gl = state.gl;
  gl.BindFramebuffer(GL_READ_FRAMEBUFFER, state.targets->shown_framebuffer());
  gl.BindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
  const bool same = width == state.targets->width() && height == state.targets->height();
  gl.BlitFramebuffer(0, 0, state.targets->width(), state.targets->height(), 0, 0, width, height,
                     GL_COLOR_BUFFER_BIT, same ? GL_NEAREST : GL_LINEAR);
}

void Renderer::resize(int width, int height) {
  State& state = *state_;
  if (width == state.targets->width() && height == state.targets->height()) return;
  for (const int side : {width, height}) state.targets->require_drawable(side);
  state.context.make_current();
  state.targets->resize(width, height);
  state.has_picture = state.has_picture_2d = false;
}

int Renderer::width() const { return state_->targets->width(); }
int Renderer::height() const { return state_->targets->height(); }

const char* Renderer::description() const { return state_->targets->description().c_str(); }

}  // namespace softcell::render
