#pragma once
// Triangle meshes: what a soft body is made from.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace softcell::ppu {

/// An indexed triangle mesh in metres. `normals` has one unit vector per position.
struct TriangleMesh {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< counter-clockwise seen from outside

  bool operator==(const TriangleMesh&) const = default;
};

/// An axis-aligned box, metres.
template <int kDimension>
struct Bounds {
  Eigen::Vector<float, kDimension> low, high;
};

/// The mesh's axis-aligned box. @pre at least one position.
Bounds<3> bounds(const TriangleMesh& mesh);

/// Moves and scales the mesh so that its box is centred on 0 and its longest side has the given length in
/// metres.
void fit(TriangleMesh& mesh, float longest_side);

}  // namespace softcell::ppu
