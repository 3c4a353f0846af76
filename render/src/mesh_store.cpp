#include "mesh_store.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "mesh_levels.h"
#include "softcell/base/assert.h"

namespace softcell::render {
namespace {

static_assert(sizeof(Eigen::Vector3f) == 12, "spans of vectors are uploaded as they are");

GLint wrap_mode(Wrap wrap) {
  switch (wrap) {
    case Wrap::kRepeat:
      return GL_REPEAT;
    case Wrap::kMirror:
      return GL_MIRRORED_REPEAT;
    case Wrap::kClamp:
      return GL_CLAMP_TO_EDGE;
  }
  return GL_REPEAT;
}

}  // namespace

MeshBuffers MeshStore::make_mesh(const void* indices, std::size_t index_count) const {
  MeshBuffers buffers(gl_);
  SC_ASSERT(
      index_count % 3 == 0 && index_count <= static_cast<std::size_t>(std::numeric_limits<GLsizei>::max()),
      "{} indices", index_count);
  buffers.triangle_count = index_count / 3;
  gl_.BindVertexArray(buffers.layout.name());
  gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffers.indices.name());
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(bytes_of(index_count, sizeof(std::uint32_t))), indices,
                 GL_STATIC_DRAW);
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers.vertices.name());
  gl_.EnableVertexAttribArray(kPositionAttribute);
  gl_.EnableVertexAttribArray(kNormalAttribute);
  return buffers;
}

MeshBuffers MeshStore::make_skinned_mesh(std::span<const std::uint32_t> indices) const {
  if (indices.size() % 3 != 0) {
    throw std::invalid_argument(std::to_string(indices.size()) + " indices; triangles need a multiple of 3");
  }
  MeshBuffers buffers = make_mesh(indices.data(), indices.size());
  for (const std::uint32_t index : indices) {
    buffers.vertices_needed = std::max<std::size_t>(buffers.vertices_needed, std::size_t{index} + 1);
  }
  gl_.VertexAttribPointer(kPositionAttribute, 3, GL_HALF_FLOAT, GL_FALSE, kSkinnedVertexBytes,
                          buffer_offset(0));
  gl_.VertexAttribPointer(kNormalAttribute, 3, GL_HALF_FLOAT, GL_FALSE, kSkinnedVertexBytes,
                          buffer_offset(8));
  return buffers;
}

void MeshStore::add_levels(MeshBuffers& buffers, std::span<const Eigen::Vector3f> positions,
                           std::span<const Eigen::Vector3f> normals) const {
  if (!with_levels_ || buffers.triangle_count == 0) return;
  buffers.levels.clear();
  gl_.BindVertexArray(buffers.layout.name());
  std::vector<Triangle> triangles(buffers.triangle_count);
  gl_.GetBufferSubData(GL_ELEMENT_ARRAY_BUFFER, 0,
                       static_cast<GLsizeiptr>(bytes_of(triangles.size(), sizeof(Triangle))),
                       triangles.data());
  const std::vector<MeshLevel> levels = coarser_levels(positions, normals, triangles);
  for (const MeshLevel& level : levels) {
    buffers.levels.push_back({.spacing = level.spacing,
                              .error = level.error,
                              .triangles = {triangles.size(), level.triangles.size()}});
    triangles.insert(triangles.end(), level.triangles.begin(), level.triangles.end());
  }
  gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(bytes_of(triangles.size(), sizeof(Triangle))), triangles.data(),
                 GL_STATIC_DRAW);
}

void MeshStore::filled(MeshId id, std::size_t bytes) {
  mesh_to_change(id).filled = true;
  uploaded_bytes_ += bytes;
}

const MeshBuffers& MeshStore::mesh(MeshId id) const { return skinned_.at(id); }

const MeshBuffers& MeshStore::mesh(StaticMeshId id) const { return statics_.at(id); }

const GlObject& MeshStore::texture(TextureId id) const { return textures_.at(id); }

template <class Value>
void MeshStore::set_attribute(const MeshBuffers& buffers, std::optional<GlObject>& buffer, GLuint attribute,
                              std::span<const Value> values, const char* what) const {
  if (values.size() < buffers.vertices_needed) {
    throw std::invalid_argument(std::to_string(values.size()) + " " + what + " for a mesh of " +
                                std::to_string(buffers.vertices_needed) + " vertices");
  }
  context_.make_current();
  if (!buffer) buffer = make_buffer(gl_);
  gl_.BindVertexArray(buffers.layout.name());
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffer->name());
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(values.size_bytes()), values.data(),
                 GL_STATIC_DRAW);
  gl_.EnableVertexAttribArray(attribute);
  gl_.VertexAttribPointer(attribute, sizeof(Value) / sizeof(float), GL_FLOAT, GL_FALSE, sizeof(Value),
                          nullptr);
}

template void MeshStore::set_attribute(const MeshBuffers&, std::optional<GlObject>&, GLuint,
                                       std::span<const Eigen::Vector2f>, const char*) const;
template void MeshStore::set_attribute(const MeshBuffers&, std::optional<GlObject>&, GLuint,
                                       std::span<const Eigen::Vector4f>, const char*) const;

MeshId MeshStore::add_mesh(std::span<const std::uint32_t> indices) {
  context_.make_current();
  return skinned_.add(make_skinned_mesh(indices));
}

void MeshStore::remove_mesh(MeshId id) {
  context_.make_current();
  skinned_.remove(id);
}

void MeshStore::remove_static_mesh(StaticMeshId id) {
  context_.make_current();
  statics_.remove(id);
}

void MeshStore::remove_texture(TextureId id) {
  context_.make_current();
  textures_.remove(id);
}

void MeshStore::update_mesh(MeshId id, std::span<const std::byte> vertices) {
  const MeshBuffers& buffers = mesh(id);
  if (buffers.cells)
    throw std::invalid_argument("mesh " + std::to_string(id.value) +
                                " is a mesh of cells: call update_corners()");
  if (vertices.size() % kSkinnedVertexBytes != 0 ||
      vertices.size() / kSkinnedVertexBytes < buffers.vertices_needed) {
    throw std::invalid_argument(std::to_string(vertices.size()) + " bytes of vertices for a mesh of " +
                                std::to_string(buffers.vertices_needed) + " vertices of 16 bytes");
  }
  context_.make_current();
  const auto size = static_cast<GLsizeiptr>(vertices.size());
  gl_.BindBuffer(GL_ARRAY_BUFFER, buffers.vertices.name());
  // New storage in place of the old, which a frame in progress may still read.
  gl_.BufferData(GL_ARRAY_BUFFER, size, nullptr, GL_STREAM_DRAW);
  gl_.BufferSubData(GL_ARRAY_BUFFER, 0, size, vertices.data());
  filled(id, vertices.size());
}

MeshId MeshStore::add_cell_mesh(std::span<const std::uint32_t> indices, std::span<const CellVertex> vertices,
                                std::size_t corner_count) {
  context_.make_current();
  MeshBuffers buffers = make_skinned_mesh(indices);
  if (buffers.vertices_needed > vertices.size()) {
    throw std::invalid_argument("index " + std::to_string(buffers.vertices_needed - 1) + " of a mesh with " +
                                std::to_string(vertices.size()) + " vertices");
  }
  if (skinner_ == nullptr) skinner_ = std::make_unique<CellSkinner>(gl_);
  // Its own storage for as long as it lives: the GPU reads what it has written itself, in order.
  gl_.BufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(bytes_of(vertices.size(), kSkinnedVertexBytes)),
                 nullptr, GL_STREAM_COPY);
  buffers.cells.emplace(gl_, vertices, corner_count);
  return skinned_.add(std::move(buffers));
}

void MeshStore::update_corners(MeshId id, std::span<const std::byte> corners, const Eigen::Vector3f& origin) {
  const MeshBuffers& buffers = mesh(id);
  if (!buffers.cells) throw std::invalid_argument("mesh " + std::to_string(id.value) + " has no cells");
  if (corners.size() != bytes_of(buffers.cells->corner_count, kCellCornerBytes)) {
    throw std::invalid_argument(std::to_string(corners.size()) + " bytes of corners for a mesh of " +
                                std::to_string(buffers.cells->corner_count) + " corners of 16 bytes");
  }
  context_.make_current();
  skinner_->skin(*buffers.cells, corners, origin, buffers.vertices);
  filled(id, corners.size());
}

TextureId MeshStore::add_texture(const Image& picture, const TextureSettings& settings, int largest_side) {
  if (picture.width < 1 || picture.height < 1 || picture.width > largest_side ||
      picture.height > largest_side) {
    throw std::invalid_argument("a texture of " + std::to_string(picture.width) + " by " +
                                std::to_string(picture.height) + " pixels; 1 to " +
                                std::to_string(largest_side) + " a side are possible");
  }
  // OpenGL counts rows from the bottom.
  Image flipped(picture.width, picture.height);
  const std::ptrdiff_t row_bytes = std::ptrdiff_t{4} * picture.width;
  for (int y = 0; y < picture.height; ++y) {
    const std::uint8_t* const row = picture.pixel(0, y);
    std::copy(row, row + row_bytes, flipped.pixel(0, picture.height - 1 - y));
  }
  context_.make_current();
  GlObject texture = make_texture(gl_);
  gl_.ActiveTexture(kPictureUnit);
  gl_.BindTexture(GL_TEXTURE_2D, texture.name());
  gl_.TexImage2D(GL_TEXTURE_2D, 0, settings.linear ? GL_RGBA8 : GL_SRGB8_ALPHA8, picture.width,
                 picture.height, 0, GL_RGBA, GL_UNSIGNED_BYTE, flipped.rgba.data());
  gl_.GenerateMipmap(GL_TEXTURE_2D);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, wrap_mode(settings.wrap_u));
  gl_.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, wrap_mode(settings.wrap_v));
  gl_.ActiveTexture(GL_TEXTURE0);
  return textures_.add(std::move(texture));
}

void MeshStore::set_rest_shape(MeshId id, std::span<const Eigen::Vector3f> positions,
                               std::span<const Eigen::Vector3f> normals) {
  const std::size_t needed = mesh(id).vertices_needed;
  if (positions.size() < needed || normals.size() != positions.size()) {
    throw std::invalid_argument("a shape of " + std::to_string(positions.size()) + " positions and " +
                                std::to_string(normals.size()) + " normals for a mesh of " +
                                std::to_string(needed) + " vertices");
  }
  context_.make_current();
  add_levels(mesh_to_change(id), positions, normals);
}

StaticMeshId MeshStore::add_static_mesh(std::span<const Eigen::Vector3f> positions,
                                        std::span<const Eigen::Vector3f> normals,
                                        std::span<const Triangle> triangles) {
  if (positions.size() != normals.size()) {
    throw std::invalid_argument(std::to_string(positions.size()) + " positions with " +
                                std::to_string(normals.size()) + " normals");
  }
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t index : triangle) {
      if (index >= positions.size()) {
        throw std::invalid_argument("index " + std::to_string(index) + " of a mesh with " +
                                    std::to_string(positions.size()) + " vertices");
      }
    }
  }
  context_.make_current();
  MeshBuffers buffers = make_mesh(triangles.data(), 3 * triangles.size());
  // All positions, then all normals.
  const auto half = static_cast<GLsizeiptr>(positions.size_bytes());
  gl_.BufferData(GL_ARRAY_BUFFER, 2 * half, nullptr, GL_STATIC_DRAW);
  gl_.BufferSubData(GL_ARRAY_BUFFER, 0, half, positions.data());
  gl_.BufferSubData(GL_ARRAY_BUFFER, half, half, normals.data());
  gl_.VertexAttribPointer(kPositionAttribute, 3, GL_FLOAT, GL_FALSE, sizeof(Eigen::Vector3f),
                          buffer_offset(0));
  gl_.VertexAttribPointer(kNormalAttribute, 3, GL_FLOAT, GL_FALSE, sizeof(Eigen::Vector3f),
                          buffer_offset(positions.size_bytes()));
  buffers.vertices_needed = positions.size();
  buffers.filled = true;
  if (!positions.empty()) {
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& position : positions) box.extend(position);
    buffers.centre = box.center();
    buffers.radius = 0.5f * box.diagonal().norm();
    add_levels(buffers, positions, normals);
  }
  return statics_.add(std::move(buffers));
}

}  // namespace softcell::render
