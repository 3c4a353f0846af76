#pragma once
// The meshes and textures of a renderer on the GPU.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "cell_skinner.h"
#include "gl_objects.h"
#include "numbered.h"
#include "softcell/render/gl_context.h"
#include "softcell/render/renderer.h"

namespace softcell::render {

// Attributes of the vertices of all shaders, and the unit of the only picture of a mesh.
inline constexpr GLuint kPositionAttribute = 0;
inline constexpr GLuint kNormalAttribute = 1;
inline constexpr GLuint kTextureAttribute = 2;
inline constexpr GLuint kColourAttribute = 3;
inline constexpr GLenum kPictureUnit = GL_TEXTURE1;  // the shadow map has unit 0
inline constexpr GLint kPictureUnitNumber = 1;

inline std::size_t bytes_of(std::size_t count, std::size_t size) { return count * size; }

/// Some of the triangles of a mesh.
struct TriangleRange {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// Triangles on the GPU.
struct MeshBuffers {
  explicit MeshBuffers(const GladGLContext& gl)
      : layout(make_vertex_array(gl)), vertices(make_buffer(gl)), indices(make_buffer(gl)) {}

  GlObject layout;
  GlObject vertices;
  GlObject indices;
  std::size_t triangle_count = 0;  ///< of the whole mesh; in `indices` coarser ones follow
  struct Level {
    float spacing = 0, error = 0;  ///< as MeshLevel
    TriangleRange triangles;
  };
  std::vector<Level> levels;        ///< coarser and coarser
  Eigen::Vector3f centre{0, 0, 0};  ///< of a sphere around a mesh that does not change
  float radius = 0;                 ///< likewise, metres
  std::size_t vertices_needed = 0;  ///< the largest index and one
  bool filled = false;              ///< the vertices have been given
  std::optional<GlObject> texture_coordinates;
  std::optional<GlObject> colours;
  std::optional<CellMesh> cells;  ///< what the vertices are made from, unless they are given
};

/// Owns them and hands them out by handle. Its functions throw what Renderer's functions of the same names state, and make the context
/// current.
class MeshStore {
 public:
  /// Both must outlive it. @param gl  may be loaded later, before the first call
  /// @param with_levels  whether meshes get coarser triangles, see RendererSettings::coarse_pixels
  MeshStore(GlContext& context, const GladGLContext& gl, bool with_levels)
      : context_(context), gl_(gl), with_levels_(with_levels) {}

  MeshId add_mesh(std::span<const std::uint32_t> indices);
  void remove_mesh(MeshId id);
  void update_mesh(MeshId id, std::span<const std::byte> vertices);
  MeshId add_cell_mesh(std::span<const std::uint32_t> indices, std::span<const CellVertex> vertices,
                       std::size_t corner_count);
  void update_corners(MeshId id, std::span<const std::byte> corners, const Eigen::Vector3f& origin);
  void set_rest_shape(MeshId id, std::span<const Eigen::Vector3f> positions,
                      std::span<const Eigen::Vector3f> normals);
  void remove_static_mesh(StaticMeshId id);
  StaticMeshId add_static_mesh(std::span<const Eigen::Vector3f> positions,
                               std::span<const Eigen::Vector3f> normals, std::span<const Triangle> triangles);

  /// @tparam Id  MeshId or StaticMeshId
  template <class Id>
  void set_texture_coordinates(Id id, std::span<const Eigen::Vector2f> coordinates) {
    MeshBuffers& buffers = mesh_to_change(id);
    set_attribute(buffers, buffers.texture_coordinates, kTextureAttribute, coordinates,
                  "texture coordinates");
  }
  template <class Id>
  void set_vertex_colours(Id id, std::span<const Eigen::Vector4f> colours) {
    MeshBuffers& buffers = mesh_to_change(id);
    set_attribute(buffers, buffers.colours, kColourAttribute, colours, "vertex colours");
  }

  /// @param largest_side  that the context supports, pixels
  TextureId add_texture(const Image& picture, const TextureSettings& settings, int largest_side);
  void remove_texture(TextureId id);

  /// @throws std::invalid_argument  no such mesh or texture
  const MeshBuffers& mesh(MeshId id) const;
  const MeshBuffers& mesh(StaticMeshId id) const;
  const GlObject& texture(TextureId id) const;

  std::uint64_t uploaded_bytes() const { return uploaded_bytes_; }

 private:
  MeshBuffers make_mesh(const void* indices, std::size_t index_count) const;
  MeshBuffers make_skinned_mesh(std::span<const std::uint32_t> indices) const;
  void add_levels(MeshBuffers& buffers, std::span<const Eigen::Vector3f> positions,
                  std::span<const Eigen::Vector3f> normals) const;
  void filled(MeshId id, std::size_t bytes);
  MeshBuffers& mesh_to_change(MeshId id) { return skinned_.at(id); }
  MeshBuffers& mesh_to_change(StaticMeshId id) { return statics_.at(id); }
  template <class Value>
  void set_attribute(const MeshBuffers& buffers, std::optional<GlObject>& buffer, GLuint attribute,
                     std::span<const Value> values, const char* what) const;

  GlContext& context_;
  const GladGLContext& gl_;
  bool with_levels_;
  std::unique_ptr<CellSkinner> skinner_;  // made when it is first asked for
  Numbered<MeshId, MeshBuffers> skinned_{"mesh"};
  Numbered<StaticMeshId, MeshBuffers> statics_{"static mesh"};
  Numbered<TextureId, GlObject> textures_{"texture"};
  std::uint64_t uploaded_bytes_ = 0;
};

}  // namespace softcell::render
