#include "painter_3d.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <initializer_list>
#include <stdexcept>
#include <string>

#include "mesh_store.h"
#include "render_targets.h"
#include "shaders.h"
#include "softcell/base/assert.h"

namespace softcell::render {
namespace {

static_assert(sizeof(Eigen::Vector3f) == 12, "spans of vectors are uploaded as they are");

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

/// One of the two ways in which shaders.h has sunlight.
const char* sunlight(const Painter3dSettings& settings) {
  return settings.soft_shadows ? kSoftSunlight : kQuickSunlight;
}

}  // namespace

/// A program and where its uniforms are; one that a program lacks is -1, which GL ignores.
struct Painter3d::Program {
  Program(const GladGLContext& gl, GLuint frame_binding, std::initializer_list<const char*> vertex_parts,
          std::initializer_list<const char*> fragment_parts)
      : object(make_program(gl, vertex_parts, fragment_parts)),
        model(gl.GetUniformLocation(object.name(), "model")),
        normal_matrix(gl.GetUniformLocation(object.name(), "normal_matrix")),
        colour(gl.GetUniformLocation(object.name(), "colour")),
        radius(gl.GetUniformLocation(object.name(), "radius")) {
    gl.UniformBlockBinding(object.name(), gl.GetUniformBlockIndex(object.name(), "Frame"), frame_binding);
  }

  GlObject object;
  GLint model;
  GLint normal_matrix;
  GLint colour;
  GLint radius;
};

struct Painter3d::Programs {
  /// @param sun  one of the two ways in which shaders.h has sunlight
  Programs(const GladGLContext& gl, const char* sun, GLuint frame_binding)
      : rigid(gl, frame_binding, {kShaderFrame, kPlacedVertex, kSurfaceVertex},
              {kShaderFrame, sun, kShaderLighting, kRigid, kSurfaceFragment}),
        soft(gl, frame_binding, {kShaderFrame, kPlacedVertex, kSurfaceVertex},
             {kShaderFrame, sun, kShaderLighting, kSoft, kSurfaceFragment}),
        textured(gl, frame_binding, {kShaderFrame, kPlacedVertex, kSurfaceVertex},
                 {kShaderFrame, sun, kShaderLighting, kSoft, kTexturedFragment}),
        tiles(gl, frame_binding, {kShaderFrame, kPlacedVertex, kSurfaceVertex},
              {kShaderFrame, sun, kShaderLighting, kTilesFragment}),
        shadow(gl, frame_binding, {kShaderFrame, kShadowVertex}, {kShaderFrame, kShadowFragment}),
        particle(gl, frame_binding, {kShaderFrame, kParticleVertex},
                 {kShaderFrame, sun, kShaderLighting, kParticleFragment}),
        particle_shadow(gl, frame_binding, {kShaderFrame, kParticleShadowVertex},
                        {kShaderFrame, kParticleShadowFragment}),
        link(gl, frame_binding, {kShaderFrame, kLinkVertex},
             {kShaderFrame, sun, kShaderLighting, kLinkFragment}),
        background(gl, frame_binding, {kShaderFrame, kBackgroundVertex},
                   {kShaderFrame, sun, kShaderLighting, kBackgroundFragment}) {}
  Program rigid, soft, textured, tiles, shadow, particle, particle_shadow, link, background;
};

Painter3d::Painter3d(const GladGLContext& gl, const RenderTargets& targets, const MeshStore& meshes,
                     const Painter3dSettings& settings)
    : gl_(gl),
      targets_(targets),
      meshes_(meshes),
      shadow_reach_(settings.soft_shadows ? kSoftReach : kQuickReach),
      coarse_pixels_(settings.coarse_pixels),
      frame_binding_(settings.frame_binding),
      programs_(std::make_unique<Programs>(gl, sunlight(settings), settings.frame_binding)),
      materials_(gl, sunlight(settings), settings.frame_binding),
      frame_buffer_(make_buffer(gl)),
      lattice_layout_(make_vertex_array(gl)),
      lattice_vertices_(make_buffer(gl)),
      lattice_indices_(make_buffer(gl)),
      empty_layout_(make_vertex_array(gl)) {
  const GLuint textured = programs_->textured.object.name();
  gl_.UseProgram(textured);
  gl_.Uniform1i(gl_.GetUniformLocation(textured, "picture"), kPictureUnitNumber);

  gl_.BindVertexArray(lattice_layout_.name());
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, lattice_indices_.name());
  gl_.BindBuffer(GL_ARRAY_BUFFER, lattice_vertices_.name());
  gl_.EnableVertexAttribArray(kPositionAttribute);
  gl_.VertexAttribPointer(kPositionAttribute, 3, GL_FLOAT, GL_FALSE, sizeof(Eigen::Vector3f), nullptr);
}

Painter3d::~Painter3d() = default;

void Painter3d::draw(const FrameDescription& frame, const PixelRect& part) {
  draw_shadow_map(frame);
  gl_.Enable(GL_SCISSOR_TEST);
  gl_.Scissor(part.left, targets_.height() - part.bottom, part.right - part.left, part.bottom - part.top);
  draw_opaque(frame);
  draw_background();
  draw_translucent(frame);
  gl_.Disable(GL_SCISSOR_TEST);
}

/// How far vertices may be moved that are `distance` metres from the eye, metres.
float Painter3d::metres_to_move(float distance) const {
  return coarse_pixels_ * std::max(distance, 0.0f) / pixels_per_tangent_;
}

TriangleRange Painter3d::triangles_to_draw(const SkinnedDraw& item) const {
  if (item.texture)
    return {0, meshes_.mesh(item.mesh).triangle_count};  // coarser ones do not know where pictures end
  return triangles_of(meshes_.mesh(item.mesh),
                      item.box ? metres_to_move(item.box->exteriorDistance(eye_)) : 0);
}

TriangleRange Painter3d::triangles_to_draw(const StaticDraw& item) const {
  const MeshBuffers& buffers = meshes_.mesh(item.mesh);
  const Eigen::Matrix3f stretch = item.pose.topLeftCorner<3, 3>();
  const float scale = stretch.colwise().norm().maxCoeff();
  const Eigen::Vector3f centre = (item.pose * buffers.centre.homogeneous()).head<3>();
  return triangles_of(buffers, metres_to_move((centre - eye_).norm() - scale * buffers.radius) / scale);
}

void Painter3d::check_parts(const MeshBuffers& buffers, std::span<const PartDraw> parts) const {
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
      meshes_.texture(*used);
      if (!buffers.texture_coordinates)
        throw std::invalid_argument("a part with a texture belongs to a mesh without texture coordinates");
    }
    if (material.vertex_colours && !buffers.colours)
      throw std::invalid_argument("a part with vertex colours belongs to a mesh that has none");
  }
}

void Painter3d::check(const FrameDescription& frame) const {
  for (const SkinnedDraw& item : frame.skinned) {
    const MeshBuffers& buffers = meshes_.mesh(item.mesh);
    check_parts(buffers, item.parts);
    if (!item.texture) continue;
    meshes_.texture(*item.texture);
    if (!buffers.texture_coordinates) {
      throw std::invalid_argument("mesh " + std::to_string(item.mesh.value) +
                                  " is to be drawn with a texture and has no texture coordinates");
    }
  }
  for (const StaticDraw& item : frame.statics) check_parts(meshes_.mesh(item.mesh), item.parts);
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

void Painter3d::begin(const FrameDescription& frame) {
  const Camera& camera = frame.camera;
  const Light& light = frame.light;
  SC_ASSERT(light.toward.squaredNorm() > 0, "light from nowhere: toward is ({} {} {})", light.toward.x(),
            light.toward.y(), light.toward.z());
  SC_ASSERT(light.shadow_radius > 0, "a shadow radius of {} m", light.shadow_radius);
  eye_ = camera.eye;
  const auto w = static_cast<float>(targets_.width()), h = static_cast<float>(targets_.height());
  pixels_per_tangent_ = h / (2 * camera.tan_half_fov_y);
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
  const float texels = static_cast<float>(targets_.shadow_map_size());
  block.shadow_texel = Eigen::Vector4f(1 / texels, shadow_reach_ * 2 * light.shadow_radius / texels, 0, 0);
  block.pixels_per_tangent = Eigen::Vector4f(pixels_per_tangent_, texels / (2 * light.shadow_radius), 0, 0);
  block.picture_size = Eigen::Vector4f(w, h, 1 / w, 1 / h);
  block.view_plane = Eigen::Vector4f(camera.tan_half_fov_y * w / h, camera.tan_half_fov_y, 0, 0);
  block.inverse_depth =
      Eigen::Vector4f(1 / camera.near_plane, 1 / camera.near_plane - 1 / camera.far_plane, 0, 0);
  block.occlusion = Eigen::Vector4f(kOcclusionShare * light.shadow_radius, light.occlusion,
                                    PostProcess::max_reach(targets_.height()), 0.99f * camera.far_plane);
  block.upwards = vec4(camera.up.normalized());
  gl_.BindBufferBase(GL_UNIFORM_BUFFER, frame_binding_, frame_buffer_.name());
  gl_.BufferData(GL_UNIFORM_BUFFER, sizeof block, &block, GL_STREAM_DRAW);
}

void Painter3d::upload_lattice(const LatticeDraw& lattice) {
  SC_ASSERT(lattice.radius >= 0, "{} particles with a radius of {} m", lattice.particles.size(),
            lattice.radius);
  gl_.BindVertexArray(lattice_layout_.name());
  gl_.BindBuffer(GL_ARRAY_BUFFER, lattice_vertices_.name());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(lattice.particles.size_bytes()),
                 lattice.particles.data(), GL_STREAM_DRAW);
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(lattice.links.size_bytes()),
                 lattice.links.data(), GL_STREAM_DRAW);
}

void Painter3d::draw(const MeshBuffers& buffers, const TriangleRange& triangles) const {
  if (!buffers.filled) return;
  gl_.BindVertexArray(buffers.layout.name());
  gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * triangles.count), GL_UNSIGNED_INT,
                   buffer_offset(bytes_of(triangles.first, sizeof(Triangle))));
}

void Painter3d::draw_parts(const MeshBuffers& buffers, std::span<const PartDraw> parts,
                           const Eigen::Matrix4f& pose, float opacity, bool two_sided) {
  if (!buffers.filled) return;
  const Eigen::Matrix3f normals = normal_matrix(pose);
  gl_.BindVertexArray(buffers.layout.name());
  for (const PartDraw& part : parts) {
    materials_.use(part.material, meshes_, pose, normals, opacity);
    cull_back_faces(!two_sided && !part.material.two_sided);
    const bool by_alpha = opacity >= 1 && MaterialPainter::covers_by_alpha(part.material);
    if (by_alpha) gl_.Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);  // without blending, in any order
    gl_.DrawElements(GL_TRIANGLES, static_cast<GLsizei>(3 * part.triangle_count), GL_UNSIGNED_INT,
                     buffer_offset(bytes_of(part.first_triangle, sizeof(Triangle))));
    if (by_alpha) gl_.Disable(GL_SAMPLE_ALPHA_TO_COVERAGE);
  }
}

void Painter3d::cull_back_faces(bool cull) const {
  if (cull) {
    gl_.Enable(GL_CULL_FACE);
  } else {
    gl_.Disable(GL_CULL_FACE);
  }
}

/// @param texel  of the shadow map, metres
void Painter3d::draw_shadow(const MeshBuffers& buffers, const Eigen::Matrix4f& pose, float texel) const {
  gl_.UniformMatrix4fv(programs_->shadow.model, 1, GL_FALSE, pose.data());
  const float scale = pose.topLeftCorner<3, 3>().colwise().norm().maxCoeff();
  draw(buffers, triangles_of(buffers, coarse_pixels_ * texel / scale));
}

void Painter3d::draw_shadow_map(const FrameDescription& frame) {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_.shadow_framebuffer());
  gl_.Viewport(0, 0, targets_.shadow_map_size(), targets_.shadow_map_size());
  gl_.Clear(GL_DEPTH_BUFFER_BIT);
  gl_.UseProgram(programs_->shadow.object.name());
  const float texel = 2 * frame.light.shadow_radius / static_cast<float>(targets_.shadow_map_size());
  for (const SkinnedDraw& item : frame.skinned) {
    if (item.opacity < 1) continue;
    cull_back_faces(!item.two_sided && !any_two_sided(item.parts));
    draw_shadow(meshes_.mesh(item.mesh), translation(item.origin), texel);
  }
  for (const StaticDraw& item : frame.statics) {
    if (item.opacity < 1 && !item.always_shadow) continue;
    cull_back_faces(!any_two_sided(item.parts));
    draw_shadow(meshes_.mesh(item.mesh), item.pose, texel);
  }
  cull_back_faces(true);
  gl_.UseProgram(programs_->particle_shadow.object.name());
  for (const LatticeDraw& lattice : frame.lattices) {
    upload_lattice(lattice);
    gl_.Uniform1f(programs_->particle_shadow.radius, lattice.radius);
    gl_.DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(lattice.particles.size()));
  }
}

void Painter3d::draw_surface(const Program& program, const MeshBuffers& buffers,
                             const TriangleRange& triangles, const Eigen::Matrix4f& pose,
                             const Colour& colour, float opacity) const {
  SC_ASSERT(opacity >= 0 && opacity <= 1, "an opacity of {}", opacity);
  const float determinant = pose.topLeftCorner(3, 3).determinant();
  SC_ASSERT(determinant > 0, "a pose with determinant {} turns its mesh inside out or flattens it",
            determinant);
  gl_.UseProgram(program.object.name());
  gl_.UniformMatrix4fv(program.model, 1, GL_FALSE, pose.data());
  gl_.UniformMatrix3fv(program.normal_matrix, 1, GL_FALSE, normal_matrix(pose).eval().data());
  gl_.Uniform4f(program.colour, colour.x(), colour.y(), colour.z(), opacity);
  draw(buffers, triangles);
}

void Painter3d::draw_surface(const SkinnedDraw& item) {
  if (!item.parts.empty()) {
    return draw_parts(meshes_.mesh(item.mesh), item.parts, translation(item.origin), item.opacity,
                      item.two_sided);
  }
  cull_back_faces(!item.two_sided);
  if (item.texture) {
    gl_.ActiveTexture(kPictureUnit);
    gl_.BindTexture(GL_TEXTURE_2D, meshes_.texture(*item.texture).name());
    gl_.ActiveTexture(GL_TEXTURE0);
  }
  draw_surface(item.texture ? programs_->textured : programs_->soft, meshes_.mesh(item.mesh),
               triangles_to_draw(item), translation(item.origin), item.colour, item.opacity);
}

void Painter3d::draw_surface(const StaticDraw& item) {
  if (!item.parts.empty())
    return draw_parts(meshes_.mesh(item.mesh), item.parts, item.pose, item.opacity, false);
  cull_back_faces(true);
  const Program& program = item.pattern == Pattern::kTiles ? programs_->tiles : programs_->rigid;
  draw_surface(program, meshes_.mesh(item.mesh), triangles_to_draw(item), item.pose, item.colour,
               item.opacity);
}

void Painter3d::draw_opaque(const FrameDescription& frame) {
  gl_.BindFramebuffer(GL_FRAMEBUFFER, targets_.frame().drawn());
  gl_.Viewport(0, 0, targets_.width(), targets_.height());
  gl_.Clear(GL_DEPTH_BUFFER_BIT);  // the background covers what nothing else does
  for (const SkinnedDraw& item : frame.skinned) {
    if (item.opacity >= 1) draw_surface(item);
  }
  for (const StaticDraw& item : frame.statics) {
    if (item.opacity >= 1) draw_surface(item);
  }
  for (const LatticeDraw& lattice : frame.lattices) draw_lattice(lattice);
}

void Painter3d::draw_lattice(const LatticeDraw& lattice) {
  upload_lattice(lattice);
  const Colour& colour = lattice.colour;
  const Program& link = programs_->link;
  gl_.UseProgram(link.object.name());
  gl_.Uniform4f(link.colour, colour.x(), colour.y(), colour.z(), 1);
  gl_.DrawElements(GL_LINES, static_cast<GLsizei>(2 * lattice.links.size()), GL_UNSIGNED_INT, nullptr);

  const Program& particle = programs_->particle;
  gl_.Enable(GL_SAMPLE_ALPHA_TO_COVERAGE);  // round discs without blending, in any order
  gl_.UseProgram(particle.object.name());
  gl_.Uniform4f(particle.colour, colour.x(), colour.y(), colour.z(), 1);
  gl_.Uniform1f(particle.radius, lattice.radius);
  gl_.DrawArrays(GL_POINTS, 0, static_cast<GLsizei>(lattice.particles.size()));
  gl_.Disable(GL_SAMPLE_ALPHA_TO_COVERAGE);
}

void Painter3d::draw_background() {
  gl_.DepthFunc(GL_LEQUAL);  // it lies exactly on the far plane
  gl_.UseProgram(programs_->background.object.name());
  gl_.BindVertexArray(empty_layout_.name());
  gl_.DrawArrays(GL_TRIANGLES, 0, 3);
  gl_.DepthFunc(GL_LESS);
}

void Painter3d::draw_translucent(const FrameDescription& frame) {
  gl_.Enable(GL_BLEND);
  gl_.DepthMask(GL_FALSE);
  for (const SkinnedDraw& item : frame.skinned) {
    if (item.opacity < 1) draw_surface(item);
  }
  for (const StaticDraw& item : frame.statics) {
    if (item.opacity < 1) draw_surface(item);
  }
  gl_.DepthMask(GL_TRUE);
  gl_.Disable(GL_BLEND);
}

}  // namespace softcell::render
