#pragma once
// Draws meshes into a picture. It works on vertex buffers and knows nothing about physics.

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "softcell/render/frame.h"
#include "softcell/render/frame_2d.h"
#include "softcell/render/gl_context.h"
#include "softcell/render/image.h"
#include "softcell/render/overlay_mesh.h"

namespace softcell::render {

using Triangle = std::array<std::uint32_t, 3>;  ///< counter-clockwise seen from outside

/// Bytes of one skinned vertex: four half floats of position (x y z, the fourth unused) and four of normal.
inline constexpr std::size_t kSkinnedVertexBytes = 16;

/// A vertex inside a cell of eight corners. Its position is interpolated trilinearly from the corners, and
/// its normal follows.
struct CellVertex {
  /// Indices of the mesh's corners; corner k of the cell is at k = bx + 2 by + 4 bz.
  std::array<std::uint32_t, 8> corner{};
  Eigen::Vector3f place{0, 0, 0};   ///< 0..1 from corner 0 towards corners 1, 2 and 4
  Eigen::Vector3f normal{0, 0, 1};  ///< unit normal while the cell is a cube along the axes
};
static_assert(sizeof(CellVertex) == 56, "uploaded as it is");

/// Bytes of one corner: four floats, x y z in metres and one that is ignored.
inline constexpr std::size_t kCellCornerBytes = 16;

/// Options of a Renderer. Every field has a default; width and height are in pixels.
struct RendererSettings {
  int width = 960;
  int height = 540;
  int samples = 4;             ///< for multisampling, limited to what the context supports; 1: none
  int shadow_map_size = 1536;  ///< texels per side
  /// A side of the squares for which ambient occlusion is computed together; 0: not at all. @pre not below 0
  int occlusion_pixels = 2;
  bool soft_shadows = true;  ///< with wider edges; without a GPU a lit pixel takes twice the time
  /// Meshes that are small or far away are drawn with fewer triangles, whose vertices have moved by at most this many pixels, mostly along
  /// the surface; in the shadow map by as many texels. 12 is hardly visible. 0: all triangles are drawn.
  /// @pre not below 0
  float coarse_pixels = 0;
};

/// Meshes, pictures and shapes live until the program removes them or the renderer. The handle of one that was removed is never given to
/// another: all functions refuse it. They cannot notice a handle of another renderer.
///
/// Draws with one sun that casts soft-edged shadows, light from sky and ground with ambient occlusion, tone mapping and sRGB encoding, with
/// four samples per pixel. With one sample it smooths edges in the finished picture. It draws into its own framebuffer and has no global
/// state. Use it on the context's thread; the context must outlive it. After the first frames, render() and pixels() allocate no memory
/// themselves (the GL library may).
class Renderer {
 public:
  /// @throws std::runtime_error  the context has no OpenGL 3.3, or refuses the sizes.
  Renderer(GlContext& context, const RendererSettings& settings);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// Adds a mesh with changing vertices. It is not drawn before the first update_mesh().
  /// @param indices  three vertices per triangle, counter-clockwise seen from outside.
  /// @throws std::invalid_argument  the number of indices is not a multiple of three.
  MeshId add_mesh(std::span<const std::uint32_t> indices);

  /// Frees the memory of a mesh of add_mesh() or add_cell_mesh().
  /// @throws std::invalid_argument  no such mesh.
  void remove_mesh(MeshId mesh);

  /// Replaces the vertices of a mesh.
  /// @param vertices  kSkinnedVertexBytes each, in the host's byte order; copied.
  /// @throws std::invalid_argument  an index has no vertex, the last vertex is incomplete, there is no such
  /// mesh, or it is a mesh of cells.
  void update_mesh(MeshId mesh, std::span<const std::byte> vertices);

  /// Adds a mesh whose vertices the GPU computes from the corners of cells. It is not drawn before the first update_corners(). It is drawn
  /// like a mesh of add_mesh().
  /// @param indices  as for add_mesh(), into `vertices`
  /// @throws std::invalid_argument  the number of indices is not a multiple of three, an index or a corner is out of range, or there are
  /// more corners than the GPU supports (OpenGL 3.3 promises 65,536).
  MeshId add_cell_mesh(std::span<const std::uint32_t> indices, std::span<const CellVertex> vertices,
                       std::size_t corner_count);

  /// Replaces the corners of a mesh of cells and computes its vertices. Vertices are rounded to half floats
  /// relative to `origin`: give the mesh's SkinnedDraw the same origin.
  /// @param corners  kCellCornerBytes each, in the host's byte order; copied.
  /// @throws std::invalid_argument  the number of corners differs, or there is no such mesh of cells.
  void update_corners(MeshId mesh, std::span<const std::byte> corners, const Eigen::Vector3f& origin);

  /// Sets the texture coordinates of a mesh's vertices, in their order. They stay when the vertices are replaced.
  /// @param coordinates  at least one for each vertex that the indices name: (0, 0) is the picture's lower left corner,
  /// (1, 1) the upper right one.
  /// @throws std::invalid_argument  too few, or no such mesh.
  void set_texture_coordinates(MeshId mesh, std::span<const Eigen::Vector2f> coordinates);
  /// The same for a mesh that does not change.
  void set_texture_coordinates(StaticMeshId mesh, std::span<const Eigen::Vector2f> coordinates);

  /// Sets the colours of a mesh's vertices, in their order: red, green, blue in linear light, and alpha, each 0..1. They stay when the
  /// vertices are replaced. @throws std::invalid_argument  too few, or no such mesh.
  void set_vertex_colours(MeshId mesh, std::span<const Eigen::Vector4f> colours);
  /// The same for a mesh that does not change.
  void set_vertex_colours(StaticMeshId mesh, std::span<const Eigen::Vector4f> colours);

  /// Adds a picture to draw meshes with. Copies the pixels before it returns.
  /// @throws std::invalid_argument  a picture without pixels, or larger than the context supports.
  TextureId add_texture(const Image& picture, const TextureSettings& settings = {});
  /// Frees the memory of a picture. @throws std::invalid_argument  no such texture.
  void remove_texture(TextureId texture);

  /// Sets the rest shape of a mesh whose vertices change. RendererSettings::coarse_pixels needs it to leave out triangles.
  /// @param positions,normals  of the vertices in any one shape, metres; at least one of each for each vertex that the indices name
  /// @throws std::invalid_argument  too few, or no such mesh.
  void set_rest_shape(MeshId mesh, std::span<const Eigen::Vector3f> positions,
                      std::span<const Eigen::Vector3f> normals);

  /// Bytes uploaded by update_mesh() and update_corners() since construction.
  std::uint64_t uploaded_bytes() const;

  /// Adds a mesh that does not change, with one unit normal per position.
  /// @throws std::invalid_argument  the numbers of normals and positions differ, or an index is out of range.
  StaticMeshId add_static_mesh(std::span<const Eigen::Vector3f> positions,
                               std::span<const Eigen::Vector3f> normals, std::span<const Triangle> triangles);
  /// Frees the memory of a mesh of add_static_mesh(). @throws std::invalid_argument  no such mesh.
  void remove_static_mesh(StaticMeshId mesh);

  /// Draws one frame: first opaque meshes, then meshes with an opacity below 1 in the given order, static ones last.
  /// @pre  opacities are 0..1; poses have a determinant above 0; shadow radii are above 0, those of particles 0 or above
  /// @throws std::invalid_argument  a handle names nothing, a link is out of range, a mesh with a
  /// texture has no texture coordinates, one with vertex colours has none, or a part is outside of its mesh.
  void render(const FrameDescription& frame);

  /// Adds the triangles of a shape in two dimensions. Each frame provides their vertices.
  /// @throws std::invalid_argument  more triangles than OpenGL can count.
  Shape2dId add_shape(std::span<const Triangle> triangles);
  /// Frees the memory of a shape. @throws std::invalid_argument  no such shape.
  void remove_shape(Shape2dId shape);

  /// Draws one frame in two dimensions.
  /// @pre  its height and its squares are above 0; opacities are 0..1
  /// @throws std::invalid_argument  a handle names nothing, a shape has too few vertices, a line too few
  /// points or another number of normals, or a link is out of range.
  void render(const Frame2d& frame);

  /// Draws text and widgets over the last frame.
  /// @param sheet  the picture that Overlay::sheet() stands for; it must stay unchanged as long as the renderer lives. Null: none is
  ///               shown.
  void draw_overlay(const OverlayFont& font, const OverlayMesh& mesh, const Image* sheet = nullptr);

  /// Copies the last frame to the context's own framebuffer, which a window shows. Stretches it to width by
  /// height pixels, which are not negative.
  void present(int width, int height);

  /// Changes the size of the next pictures. @throws std::runtime_error  as the constructor.
  void resize(int width, int height);
  int width() const;   ///< of the pictures, pixels
  int height() const;  ///< of the pictures, pixels

  /// Reads the last frame back. The reference stays valid as long as the renderer; the next call overwrites
  /// the picture.
  const Image& pixels();

  /// Backend, device and samples for a log: "OSMesa, llvmpipe (LLVM 15.0.6, 128 bits), 4 samples".
  const char* description() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::render
