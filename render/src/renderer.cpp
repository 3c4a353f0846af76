#include "softcell/render/renderer.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "gl_objects.h"
#include "material_painter.h"
#include "mesh_store.h"
#include "overlay_painter.h"
#include "painter_2d.h"
#include "render_targets.h"
#include "shaders.h"
#include "softcell/base/assert.h"

namespace softcell::render {
namespace {

static_assert(sizeof(Eigen::Vector3f) == 12, "spans of vectors are uploaded as they are");

constexpr GLuint kFrameBinding = 0;
constexpr float kAwayShare = 1.0f / 48;   // of RendererSettings::coarse_pixels, for MeshLevel::error
constexpr float kOcclusionShare = 0.06f;  // of the shadow radius: how far a surface keeps ambient light off

/// The uniform block `Frame` of shaders.h, std140. Eigen would align matrices to what the widest registers
/// of the build want.
struct FrameBlock {
  using Matrix = Eigen::Matrix<float, 4, 4, Eigen::DontAlign>;
  Matrix view_projection;
  Matrix light_projection;
  Matrix view_to_world;
  Eigen::Vector4f eye;
  Eigen::Vector4f toward_light;
  Eigen::Vector4f light_colour;
  Eigen::Vector4f sky;
  Eigen::Vector4f ground;
  Eigen::Vector4f background_top;
  Eigen::Vector4f background_bottom;
  Eigen::Vector4f shadow_texel;
  Eigen::Vector4f pixels_per_tangent;
  Eigen::Vector4f picture_size;
  Eigen::Vector4f view_plane;
  Eigen::Vector4f inverse_depth;
  Eigen::Vector4f occlusion;
  Eigen::Vector4f upwards;
};
static_assert(sizeof(FrameBlock) == 3 * 64 + 14 * 16, "std140 has no padding here");

Eigen::Vector4f vec4(const Eigen::Vector3f& v, float w = 0) { return {v.x(), v.y(), v.z(), w}; }

/// A program and where its uniforms are; one that a program lacks is -1, which GL ignores.
struct Program {
  Program(const GladGLContext& gl, std::initializer_list<const char*> vertex_parts,
          std::initializer_list<const char*> fragment_parts)
      : object(make_program(gl, vertex_parts, fragment_parts)),
        model(gl.GetUniformLocation(object.name(), "model")),
        normal_matrix(gl.GetUniformLocation(object.name(), "normal_matrix")),
        colour(gl.GetUniformLocation(object.name(), "colour")),
        radius(gl.GetUniformLocation(object.name(), "radius")) {
    gl.UniformBlockBinding(object.name(), gl.GetUniformBlockIndex(object.name(), "Frame"), kFrameBinding);
  }

  GlObject object;
  GLint model;
  GLint normal_matrix;
  GLint colour;
  GLint radius;
};

/// What to draw of a mesh where vertices may be moved by `most` metres.
TriangleRange triangles_of(const MeshBuffers& buffers, float most) {
  TriangleRange range{0, buffers.triangle_count};
  for (const MeshBuffers::Level& level : buffers.levels)
    if (level.spacing <= most && level.error <= kAwayShare * most) range = level.triangles;
  return range;
}

/// World to the shadow map's clip space: a box around the sphere that the light shines on, seen along the
/// light.
Eigen::Matrix4f light_projection(const Light& light) {
  const Eigen::Vector3f toward = light.toward.normalized();
  const Eigen::Vector3f up =
      toward.y() * toward.y() < 0.98f ? Eigen::Vector3f(0, 1, 0) : Eigen::Vector3f(0, 0, 1);
  const Eigen::Vector3f eye = light.shadow_centre + 2 * light.shadow_radius * toward;
  return orthographic(light.shadow_radius, light.shadow_radius, 3 * light.shadow_radius) *
         look_at(eye, light.shadow_centre, up);
}

/// What turns normals when `pose` turns and stretches positions: the cofactors, up to length the inverse
/// transpose.
Eigen::Matrix3f normal_matrix(const Eigen::Matrix4f& pose) {
  const Eigen::Vector3f x = pose.block<3, 1>(0, 0);
  const Eigen::Vector3f y = pose.block<3, 1>(0, 1);
  const Eigen::Vector3f z = pose.block<3, 1>(0, 2);
  Eigen::Matrix3f cofactors;
  cofactors << y.cross(z), z.cross(x), x.cross(y);
  return cofactors;
}

bool any_two_sided(std::span<const PartDraw> parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [](const PartDraw& part) { return part.material.two_sided; });
}

Eigen::Matrix4f translation(const Eigen::Vector3f& offset) {
  Eigen::Matrix4f pose = Eigen::Matrix4f::Identity();
  pose.block<3, 1>(0, 3) = offset;
  return pose;
}

}  // namespace

struct Renderer::State {
  State(GlContext& gl_context, const RendererSettings& settings);
  ~State() { context.make_current(); }  // then the members' objects are deleted

  float metres_to_move(float distance) const;
  TriangleRange triangles_to_draw(const SkinnedDraw& item) const;
  TriangleRange triangles_to_draw(const StaticDraw& item) const;

  void check(const FrameDescription& frame) const;
  PixelRect part_to_draw(const std::optional<PixelRect>& changes, bool is_kept) const;
  void upload_frame(const FrameDescription& frame);
  void upload_lattice(const LatticeDraw& lattice);
  void draw_shadow_map(const FrameDescription& frame);
  void draw_opaque(const FrameDescription& frame);
  void draw_lattice(const LatticeDraw& lattice);
  void draw_background();
  void draw_translucent(const FrameDescription& frame);
  void check_parts(const MeshBuffers& buffers, std::span<const PartDraw> parts) const;
  void draw(const MeshBuffers& buffers, const TriangleRange& triangles) const;
  void draw_parts(const MeshBuffers& buffers, std::span<const PartDraw> parts, const Eigen::Matrix4f& pose,
                  float opacity, bool two_sided) const;
  void cull_back_faces(bool cull) const;
  void draw_surface(const SkinnedDraw& item) const;
  void draw_surface(const StaticDraw& item) const;
  void draw_surface(const Program& program, const MeshBuffers& buffers, const TriangleRange& triangles,
                    const Eigen::Matrix4f& pose, const Colour& colour, float opacity) const;
  void draw_shadow(const MeshBuffers& buffers, const Eigen::Matrix4f& pose, float texel) const;

  GlContext& context;
  GladGLContext gl;
  float shadow_reach;  ///< texels that a lit fragment looks around itself
  float coarse_pixels;
  Eigen::Vector3f eye{0, 0, 0};  ///< of the frame that is drawn
  float pixels_per_tangent = 1;  ///< likewise
  bool has_picture = false;      ///< of the last frame, before it is resolved
  bool has_picture_2d = false;   ///< likewise, of a frame in two dimensions

  struct Programs {
    /// @param sun  one of the two ways in which shaders.h has sunlight
    Programs(const GladGLContext& gl, const char* sun)
        : rigid(gl, {kShaderFrame, kPlacedVertex, kSurfaceVertex},
                {kShaderFrame, sun, kShaderLighting, kRigid, kSurfaceFragment}),
          soft(gl, {kShaderFrame, kPlacedVertex, kSurfaceVertex},
               {kShaderFrame, sun, kShaderLighting, kSoft, kSurfaceFragment}),
          textured(gl, {kShaderFrame, kPlacedVertex, kSurfaceVertex},
                   {kShaderFrame, sun, kShaderLighting, kSoft, kTexturedFragment}),
          tiles(gl, {kShaderFrame, kPlacedVertex, kSurfaceVertex},
                {kShaderFrame, sun, kShaderLighting, kTilesFragment}),
          shadow(gl, {kShaderFrame, kShadowVertex}, {kShaderFrame, kShadowFragment}),
          particle(gl, {kShaderFrame, kParticleVertex},
                   {kShaderFrame, sun, kShaderLighting, kParticleFragment}),
          particle_shadow(gl, {kShaderFrame, kParticleShadowVertex}, {kShaderFrame, kParticleShadowFragment}),
          link(gl, {kShaderFrame, kLinkVertex}, {kShaderFrame, sun, kShaderLighting, kLinkFragment}),
          background(gl, {kShaderFrame, kBackgroundVertex},
                     {kShaderFrame, sun, kShaderLighting, kBackgroundFragment}) {}
    Program rigid, soft, textured, tiles, shadow, particle, particle_shadow, link, background;
  };

  std::optional<RenderTargets> targets;  ///< made when `gl` is loaded
  GlObject frame_buffer;                 ///< the uniform block
  GlObject lattice_layout, lattice_vertices, lattice_indices;
  GlObject empty_layout;  ///< for the background, which has no vertices
  std::unique_ptr<Programs> programs;
  std::unique_ptr<MaterialPainter> materials;
  std::unique_ptr<OverlayPainter> overlay;  ///< made when it is first asked for
  std::unique_ptr<Painter2d> painter_2d;    ///< likewise
  MeshStore meshes;
};

Renderer::State::State(GlContext& gl_context, const RendererSettings& settings)
    : context(gl_context),
      shadow_reach(settings.soft_shadows ? kSoftReach : kQuickReach),
      coarse_pixels(settings.coarse_pixels),
      meshes(gl_context, gl, coarse_pixels != 0) {
  SC_ASSERT(settings.occlusion_pixels >= 0, "ambient occlusion for {} pixels at a time",
            settings.occlusion_pixels);
  SC_ASSERT(coarse_pixels >= 0, "vertices moved by {} pixels", coarse_pixels);
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
  const char* const sun = settings.soft_shadows ? kSoftSunlight : kQuickSunlight;
  programs = std::make_unique<Programs>(gl, sun);
  materials = std::make_unique<MaterialPainter>(gl, sun, kFrameBinding);
  gl.UseProgram(programs->textured.object.name());
  gl.Uniform1i(gl.GetUniformLocation(programs->textured.object.name(), "picture"), kPictureUnitNumber);
  frame_buffer = make_buffer(gl);
  empty_layout = make_vertex_array(gl);

  lattice_layout = make_vertex_array(gl);
  lattice_vertices = make_buffer(gl);
  lattice_indices = make_buffer(gl);
  gl.BindVertexArray(lattice_layout.name());
  gl.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, lattice_indices.name());
  gl.BindBuffer(GL_ARRAY_BUFFER, lattice_vertices.name());
  gl.EnableVertexAttribArray(kPositionAttribute);
  gl.VertexAttribPointer(kPositionAttribute, 3, GL_FLOAT, GL_FALSE, sizeof(Eigen::Vector3f), nullptr);

  gl.Enable(GL_PROGRAM_POINT_SIZE);
  gl.BlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);  // a picture has no holes
}

/// How far vertices may be moved that are `distance` metres from the eye, metres.
float Renderer::State::metres_to_move(float distance) const {
  return coarse_pixels * std::max(distance, 0.0f) / pixels_per_tangent;
}

TriangleRange Renderer::State::triangles_to_draw(const SkinnedDraw& item) const {
  if (item.texture)
    return {0, meshes.mesh(item.mesh).triangle_count};  // coarser ones do not know where pictures end
  return triangles_of(meshes.mesh(item.mesh), item.box ? metres_to_move(item.box->exteriorDistance(eye)) : 0);
}

TriangleRange Renderer::State::triangles_to_draw(const StaticDraw& item) const {
  const MeshBuffers& buffers = meshes.mesh(item.mesh);
  const Eigen::Matrix3f stretch = item.pose.topLeftCorner<3, 3>();
  const float scale = stretch.colwise().norm().maxCoeff();
  const Eigen::Vector3f centre = (item.pose * buffers.centre.homogeneous()).head<3>();
  return triangles_of(buffers, metres_to_move((centre - eye).norm() - scale * buffers.radius) / scale);
}

void Renderer::State::check_parts(const MeshBuffers& buffers, std::span<const PartDraw> parts) const {
  const std::uint64_t triangles = buffers.triangle_count;
  for (const PartDraw& part : parts) {
    if (std::uint64_t{part.first_triangle} + part.triangle_count > triangles) {
      throw std::invalid_argument("a part of " + std::to_string(part.triangle_count) + " triangles from " +
                                  std::to_string(part.first_triangle) + " on is drawn of a mesh that has " +
                                  std::to_string(triangles));
    }
    const Material& material = part.material;
    for (const auto& used : {material.base_texture, material.metallic_roughness_texture,
                             material.normal_texture, material.emission_texture}) {
      if (!used) continue;
      meshes.texture(*used);
      if (!buffers.texture_coordinates)
        throw std::invalid_argument("a part with a texture belongs to a mesh without texture coordinates");
    }
    if (material.vertex_colours && !buffers.colours)
      throw std::invalid_argument("a part with vertex colours belongs to a mesh that has none");
  }
}

void Renderer::State::check(const FrameDescription& frame) const {
  for (const SkinnedDraw& item : frame.skinned) {
    const MeshBuffers& buffers = meshes.mesh(item.mesh);
    check_parts(buffers, item.parts);
    if (!item.texture) continue;
    meshes.texture(*item.texture);
    if (!buffers.texture_coordinates) {
      throw std::invalid_argument("mesh " + std::to_string(item.mesh.value) +
                                  " is to be drawn with a texture and has no texture coordinates");
    }
  }
  for (const StaticDraw& item : frame.statics) check_parts(meshes.mesh(item.mesh), item.parts);
  for (const LatticeDraw& lattice : frame.lattices) {
    for (const auto& link : lattice.links) {
      if (link[0] >= lattice.particles.size() || link[1] >= lattice.particles.size()) {
        throw std::invalid_argument("a link joins particles " + std::to_string(link[0]) + " and " +
                                    std::to_string(link[1]) + "; the lattice has " +
                                    std::to_string(lattice.particles.size()));
      }
    }
  }
}

PixelRect Renderer::State::part_to_draw(const std::optional<PixelRect>& changes, bool is_kept) const {
  if (!changes || !is_kept) return {0, 0, targets->width(), targets->height()};
  return {std::max(changes->left, 0), std::max(changes->top, 0), std::min(changes->right, targets->width()),
          std::min(changes->bottom, targets->height())};
}

void Renderer::State::upload_frame(const FrameDescription& frame) {
  const Camera& camera = frame.camera;
  const Light& light = frame.light;
  SC_ASSERT(light.toward.squaredNorm() > 0, "light from nowhere: toward is ({} {} {})", light.toward.x(),
            light.toward.y(), light.toward.z());
  SC_ASSERT(light.shadow_radius > 0, "a shadow radius of {} m", light.shadow_radius);
  eye = camera.eye;
  const auto w = static_cast<float>(targets->width()), h = static_cast<float>(targets->height());
  pixels_per_tangent = h / (2 * camera.tan_half_fov_y);
  FrameBlock block;
  block.view_projection = view_projection(camera, w / h);
  block.light_projection = light_projection(light);
  block.view_to_world = look_at(camera.eye, camera.target, camera.up).transpose();
  block.eye = vec4(camera.eye);
  block.toward_light = vec4(light.toward.normalized());
  block.light_colour = vec4(light.colour);
  block.sky = vec4(light.sky);
  block.ground = vec4(light.ground);
  block.background_top = vec4(frame.background_top);
  block.background_bottom = vec4(frame.background_bottom);
  const float texels = static_cast<float>(targets->shadow_map_size());
  block.shadow_texel = Eigen::Vector4f(1 / texels, shadow_reach * 2 * light.shadow_radius / texels, 0, 0);
  block.pixels_per_tangent = Eigen::Vector4f(pixels_per_tangent, texels / (2 * light.shadow_radius), 0, 0);
  block.picture_size = Eigen::Vector4f(w, h, 1 / w, 1 / h);
  block.view_plane = Eigen::Vector4f(camera.tan_half_fov_y * w / h, camera.tan_half_fov_y, 0, 0);
  block.inverse_depth =
      Eigen::Vector4f(1 / camera.near_plane, 1 / camera.near_plane - 1 / camera.far_plane, 0, 0);
  block.occlusion = Eigen::Vector4f(kOcclusionShare * light.shadow_radius, light.occlusion,
                                    PostProcess::max_reach(targets->height()), 0.99f * camera.far_plane);
  block.upwards = vec4(camera.up.normalized());
  gl.BindBufferBase(GL_UNIFORM_BUFFER, kFrameBinding, frame_buffer.name());
  gl.BufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STREAM_DRAW);
}

void Renderer::State::upload_lattice(const LatticeDraw& lattice) {
  SC_ASSERT(lattice.radius >= 0, "{} particles with a radius of {} m", lattice.particles.size(),
            lattice.radius);
  gl.BindVertexArray(lattice_layout.name());
  gl.BindBuffer(GL_ARRAY_BUFFER, lattice_vertices.name());
  gl.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(lattice.particles.size_bytes()),
                lattice.particles.data(), GL_STREAM_DRAW);
  gl.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(lattice.links.size_bytes()),
                lattice.links.data(), GL_STREAM_DRAW);
}

void Renderer::State::draw(const MeshBuffers& buffers, const TriangleRange& triangles) const {
  if (!buffers.filled) return;
  gl.BindVertexArray(buffers.layout.name());
  gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * triangles.count), GL_UNSIGNED_INT,
                  buffer_offset(bytes_of(triangles.first, sizeof(Triangle))));
}

void Renderer::State::draw_parts(const MeshBuffers& buffers, std::span<const PartDraw> parts,
                                 const Eigen::Matrix4f& pose, float opacity, bool two_sided) const {
  if (!buffers.filled) return;
  const Eigen::Matrix3f normals = normal_matrix(pose);
  gl.BindVertexArray(buffers.layout.name());
  for (const PartDraw& part : parts) {
    materials->use(part.material, meshes, pose, normals, opacity);
    cull_back_faces(!two_sided && !part.material.two_sided);
    const bool by_alpha = opacity >= 1 && MaterialPainter::covers_by_alpha(part.material);
    if (by_alpha) gl.Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);  // without blending, in any order
    gl.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * part.triangle_count), GL_UNSIGNED_INT,
                    buffer_offset(bytes_of(part.first_triangle, sizeof(Triangle))));
    if (by_alpha) gl.Disable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  }
}

void Renderer::State::cull_back_faces(bool cull) const {
  if (cull) {
    gl.Enable(GL_CULL_FACE);
  } else {
    gl.Disable(GL_CULL_FACE);
  }
}

/// @param texel  of the shadow map, metres
void Renderer::State::draw_shadow(const MeshBuffers& buffers, const Eigen::Matrix4f& pose,
                                  float texel) const {
  gl.UniformMatrix4fv(programs->shadow.model, 1, GL_FALSE, pose.data());
  const float scale = pose.topLeftCorner<3, 3>().colwise().norm().maxCoeff();
  draw(buffers, triangles_of(buffers, coarse_pixels * texel / scale));
}

void Renderer::State::draw_shadow_map(const FrameDescription& frame) {
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets->shadow_framebuffer());
  gl.Viewport(0, 0, targets->shadow_map_size(), targets->shadow_map_size());
  gl.Clear(GL_DEPTH_BUFFER_BIT);
  gl.UseProgram(programs->shadow.object.name());
  const float texel = 2 * frame.light.shadow_radius / static_cast<float>(targets->shadow_map_size());
  for (const SkinnedDraw& item : frame.skinned) {
    if (item.opacity < 1) continue;
    cull_back_faces(!item.two_sided && !any_two_sided(item.parts));
    draw_shadow(meshes.mesh(item.mesh), translation(item.origin), texel);
  }
  for (const StaticDraw& item : frame.statics) {
    if (item.opacity < 1 && !item.always_shadow) continue;
    cull_back_faces(!any_two_sided(item.parts));
    draw_shadow(meshes.mesh(item.mesh), item.pose, texel);
  }
  cull_back_faces(true);
  gl.UseProgram(programs->particle_shadow.object.name());
  for (const LatticeDraw& lattice : frame.lattices) {
    upload_lattice(lattice);
    gl.Uniform1f(programs->particle_shadow.radius, lattice.radius);
    gl.DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(lattice.particles.size()));
  }
}

void Renderer::State::draw_surface(const Program& program, const MeshBuffers& buffers,
                                   const TriangleRange& triangles, const Eigen::Matrix4f& pose,
                                   const Colour& colour, float opacity) const {
  SC_ASSERT(opacity >= 0 && opacity <= 1, "an opacity of {}", opacity);
  const float determinant = pose.topLeftCorner(3, 3).determinant();
  SC_ASSERT(determinant > 0, "a pose with determinant {} turns its mesh inside out or flattens it",
            determinant);
  gl.UseProgram(program.object.name());
  gl.UniformMatrix4fv(program.model, 1, GL_FALSE, pose.data());
  gl.UniformMatrix3fv(program.normal_matrix, 1, GL_FALSE, normal_matrix(pose).eval().data());
  gl.Uniform4f(program.colour, colour.x(), colour.y(), colour.z(), opacity);
  draw(buffers, triangles);
}

void Renderer::State::draw_surface(const SkinnedDraw& item) const {
  if (!item.parts.empty()) {
    return draw_parts(meshes.mesh(item.mesh), item.parts, translation(item.origin), item.opacity,
                      item.two_sided);
  }
  cull_back_faces(!item.two_sided);
  if (item.texture) {
    gl.ActiveTexture(kPictureUnit);
    gl.BindTexture(GL_TEXTURE_2D, meshes.texture(*item.texture).name());
    gl.ActiveTexture(GL_TEXTURE0);
  }
  draw_surface(item.texture ? programs->textured : programs->soft, meshes.mesh(item.mesh),
               triangles_to_draw(item), translation(item.origin), item.colour, item.opacity);
}

void Renderer::State::draw_surface(const StaticDraw& item) const {
  if (!item.parts.empty())
    return draw_parts(meshes.mesh(item.mesh), item.parts, item.pose, item.opacity, false);
  cull_back_faces(true);
  const Program& program = item.pattern == Pattern::kTiles ? programs->tiles : programs->rigid;
  draw_surface(program, meshes.mesh(item.mesh), triangles_to_draw(item), item.pose, item.colour,
               item.opacity);
}

void Renderer::State::draw_opaque(const FrameDescription& frame) {
  gl.BindFramebuffer(GL_FRAMEBUFFER, targets->frame().drawn());
  gl.Viewport(0, 0, targets->width(), targets->height());
  gl.Clear(GL_DEPTH_BUFFER_BIT);  // the background covers what nothing else does
  for (const SkinnedDraw& item : frame.skinned) {
    if (item.opacity >= 1) draw_surface(item);
  }
  for (const StaticDraw& item : frame.statics) {
    if (item.opacity >= 1) draw_surface(item);
  }
  for (const LatticeDraw& lattice : frame.lattices) draw_lattice(lattice);
}

void Renderer::State::draw_lattice(const LatticeDraw& lattice) {
  upload_lattice(lattice);
  const Colour& colour = lattice.colour;
  const Program& link = programs->link;
  gl.UseProgram(link.object.name());
  gl.Uniform4f(link.colour, colour.x(), colour.y(), colour.z(), 1);
  gl.DrawElements(GL_LINES, static_cast<GLsizei>(2 * lattice.links.size()), GL_UNSIGNED_INT, nullptr);

  const Program& particle = programs->particle;
  gl.Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);  // round discs without blending, in any order
  gl.UseProgram(particle.object.name());
  gl.Uniform4f(particle.colour, colour.x(), colour.y(), colour.z(), 1);
  gl.Uniform1f(particle.radius, lattice.radius);
  gl.DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(lattice.particles.size()));
  gl.Disable(GL_SAMPLE_ALPHA_TO_COVERAGE);
}

void Renderer::State::draw_background() {
  gl.DepthFunc(GL_LEQUAL);  // it lies exactly on the far plane
  gl.UseProgram(programs->background.object.name());
  gl.BindVertexArray(empty_layout.name());
  gl.DrawArrays(GL_TRIANGLES, 0, 3);
  gl.DepthFunc(GL_LESS);
}

void Renderer::State::draw_translucent(const FrameDescription& frame) {
  gl.Enable(GL_BLEND);
  gl.DepthMask(GL_FALSE);
  for (const SkinnedDraw& item : frame.skinned) {
    if (item.opacity < 1) draw_surface(item);
  }
  for (const StaticDraw& item : frame.statics) {
    if (item.opacity < 1) draw_surface(item);
  }
  gl.DepthMask(GL_TRUE);
  gl.Disable(GL_BLEND);
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
  state.check(frame);
  state.context.make_current();
  const GladGLContext& gl = state.gl;
  state.upload_frame(frame);
  gl.Enable(GL_DEPTH_TEST);
  gl.BindTexture(GL_TEXTURE_2D, state.targets->shadow_map());
  const PixelRect part = state.part_to_draw(frame.changes, state.has_picture);
  if (part.left < part.right && part.top < part.bottom) {
    state.draw_shadow_map(frame);
    gl.Enable(GL_SCISSOR_TEST);
    gl.Scissor(part.left, state.targets->height() - part.bottom, part.right - part.left,
               part.bottom - part.top);
    state.draw_opaque(frame);
    state.draw_background();
    state.draw_translucent(frame);
    gl.Disable(GL_SCISSOR_TEST);
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
