#pragma once
// A small scene that has everything the renderer draws: tiled floor, translucent walls, a box, two skinned
// bodies in half floats (a torus and a sphere), and a particle lattice.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "softcell/render/renderer.h"

namespace softcell::render::test {

/// A mesh in the skinned format.
struct SkinnedMesh {
  std::vector<std::uint16_t> vertices;  ///< eight binary16 numbers a vertex
  std::vector<std::uint32_t> indices;

  std::span<const std::byte> bytes() const { return std::as_bytes(std::span(vertices)); }
  void add_vertex(const Eigen::Vector3f& position, const Eigen::Vector3f& normal);
};

/// Radii 0.6 and 0.25, about the y axis; 2 * ring_segments * tube_segments triangles.
SkinnedMesh make_torus(int ring_segments, int tube_segments);

/// Radius 0.55; 12 * subdivisions^2 triangles.
SkinnedMesh make_sphere(int subdivisions);

/// A box of edge length 1, centred on 0, with sharp edges.
StaticMeshId add_unit_box(Renderer& renderer);

/// Moves and stretches the unit box.
Eigen::Matrix4f box_pose(const Eigen::Vector3f& centre, const Eigen::Vector3f& size);

/// Owns what the scene's FrameDescription points at.
class TestScene {
 public:
  /// @param detail  multiplies the bodies' segments; 1 makes about 1,500 triangles, 9 about 120,000.
  TestScene(Renderer& renderer, int detail);

  FrameDescription frame() const;

 private:
  std::vector<SkinnedDraw> skinned_;
  std::vector<StaticDraw> statics_;
  std::vector<Eigen::Vector3f> particles_;
  std::vector<std::array<std::uint32_t, 2>> links_;
  std::vector<LatticeDraw> lattices_;
};

}  // namespace softcell::render::test
