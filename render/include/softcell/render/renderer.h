#pragma once
// Draws frames of meshes into a picture. Knows vertex buffers and nothing of physics.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "softcell/render/frame.h"
#include "softcell/render/gl_context.h"
#include "softcell/render/image.h"
#include "softcell/render/overlay_mesh.h"

namespace softcell::render {

using Triangle = std::array<std::uint32_t, 3>;  ///< counter-clockwise seen from outside

/// Bytes of one skinned vertex: four binary16 of position (x y z, the fourth unused) and four of normal.
inline constexpr std::size_t kSkinnedVertexBytes = 16;

/// A vertex that hangs in a cell of eight corners: where the corners go, it follows trilinearly, and its
/// normal with it.
struct CellVertex {
  std::array<std::uint32_t, 8>
      corner{};                     ///< which of the mesh's corners; the cell's corner k = bx + 2 by + 4 bz
  Eigen::Vector3f place{0, 0, 0};   ///< in the cell, 0..1 from corner 0 towards corners 1, 2 and 4
  Eigen::Vector3f normal{0, 0, 1};  ///< while the cell is a cube along the axes; unit length
};
static_assert(sizeof(CellVertex) == 56, "uploaded as it is");

/// Bytes of one corner of cells: four floats, x y z in metres and one that is not read.
inline constexpr std::size_t kCellCornerBytes = 16;

struct RendererSettings {
  int width = 960;
  int height = 540;
  int samples = 4;             ///< of multisampling; taken down to what the context can do; 1 is none
  int shadow_map_size = 1536;  ///< texels a side
  bool soft_shadows = true;    ///< with wider edges; without a GPU a lit pixel takes twice as long
};

/// One sun with soft-edged shadows, light from sky and ground, tone mapping and sRGB encoding, four samples a
/// pixel. Draws into its own framebuffer; holds no global state. Use it on the context's thread; the context
/// outlives it. After the first frames render() and pixels() allocate nothing themselves (the GL library does
/// as it likes).
class Renderer {
 public:
  /// @throws std::runtime_error  the context has no OpenGL 3.3, or refuses the sizes.
  Renderer(GlContext& context, const RendererSettings& settings);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// A mesh whose vertices are given anew by update_mesh(); until then it draws nothing.
  /// @param indices  three vertices a triangle, counter-clockwise seen from outside.
  /// @throws std::invalid_argument  a count that is no multiple of three.
  MeshId add_mesh(std::span<const std::uint32_t> indices);

  /// Replaces the vertices, kSkinnedVertexBytes each, in the host's byte order. The bytes are copied before
  /// it returns.
  /// @throws std::invalid_argument  fewer vertices than the indices speak of, or a broken last one, or no
  /// such mesh, or one of cells.
  void update_mesh(MeshId mesh, std::span<const std::byte> vertices);

  /// A mesh whose vertices the GPU makes from the corners of cells, given anew by update_corners(); until
  /// then it draws nothing. Drawn like one of add_mesh().
  /// @param indices  as for add_mesh(), into `vertices`
  /// @throws std::invalid_argument  a count of indices that is no multiple of three, an index or a corner out
  /// of range, or more corners than the GPU takes (OpenGL 3.3 promises 65,536).
  MeshId add_cell_mesh(std::span<const std::uint32_t> indices, std::span<const CellVertex> vertices,
                       std::size_t corner_count);

  /// Replaces the corners, kCellCornerBytes each, in the host's byte order, and makes the vertices. The bytes
  /// are copied before it returns. Vertices are rounded to binary16 relative to `origin`, which the mesh's
  /// SkinnedDraw is to have as its origin.
  /// @throws std::invalid_argument  another number of corners, or no such mesh of cells.
  void update_corners(MeshId mesh, std::span<const std::byte> corners, const Eigen::Vector3f& origin);

  /// The texture coordinates of a mesh's vertices, in their order. They stay when the vertices are given anew.
  /// @param coordinates  one for each vertex that the indices speak of, or more: (0, 0) is the picture's lower
  /// left corner, (1, 1) the upper right one; beyond them the picture is repeated.
  /// @throws std::invalid_argument  too few, or no such mesh.
  void set_texture_coordinates(MeshId mesh, std::span<const Eigen::Vector2f> coordinates);

  /// A picture to draw meshes with. Its alpha channel is not used. The pixels are copied before it returns.
  /// @throws std::invalid_argument  a picture without pixels, or larger than the context takes.
  TextureId add_texture(const Image& picture);

  /// Bytes that update_mesh() and update_corners() have been given since the beginning.
  std::uint64_t uploaded_bytes() const;

  /// A mesh that stays as it is, with one unit normal per position.
  /// @throws std::invalid_argument  another number of normals than positions, or an index out of range.
  StaticMeshId add_static_mesh(std::span<const Eigen::Vector3f> positions,
                               std::span<const Eigen::Vector3f> normals, std::span<const Triangle> triangles);

  /// Draws one frame. Opaque things first, then those with an opacity below 1 in the given order, static ones
  /// last.
  /// @throws std::invalid_argument  a handle of another renderer, a link out of range, or a texture on a mesh
  /// without texture coordinates.
  void render(const FrameDescription& frame);

  /// Draws text and widgets over the last frame.
  void draw_overlay(const OverlayFont& font, const OverlayMesh& mesh);

  /// Copies the last frame to the context's own framebuffer, which a window shows, stretched to its size.
  void present(int width, int height);

  /// Changes the size of the pictures from here on. @throws std::runtime_error  as the constructor.
  void resize(int width, int height);
  int width() const;
  int height() const;

  /// The last frame, read back. The reference stays valid; the next call overwrites the picture.
  const Image& pixels();

  /// For the log: "OSMesa, llvmpipe (LLVM 15.0.6, 128 bits), 4 samples".
  const char* description() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::render
