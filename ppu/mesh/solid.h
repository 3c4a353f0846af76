#pragma once
// What is inside of a mesh.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

/// The union of a mesh's closed parts. Parts may reach into each other, as those of most models that were made by hand do (a wing
/// that begins within the body), and a part may reach into itself.
///
/// A point is inside when a straight line from it leaves the parts more or less often than it enters them (the nonzero winding rule).
/// Immutable; any thread may read it.
class Solid {
 public:
  /// Equal positions are one corner, whatever their normals.
  explicit Solid(const TriangleMesh& mesh);

  /// Whether the mesh is closed, but for parts with less than a twentieth of its surface. What an open mesh contains means little.
  bool is_whole() const { return is_whole_; }

  /// @param point  metres, finite
  bool contains(const Eigen::Vector3f& point) const;

 private:
  void add_closed_parts(const TriangleMesh& mesh);
  void sort_into_columns();
  Eigen::Array2i column_of(const Eigen::Vector3d& point) const;
  std::size_t slot(const Eigen::Array2i& column) const;

  /// Triangles by where they lie across the x axis: a line along it meets those of one column only.
  std::vector<std::array<Eigen::Vector3d, 3>> triangles_;
  bool is_whole_ = false;
  Bounds<3> box_{};
  Eigen::Array2d column_low_{0, 0}, columns_per_metre_{0, 0};
  Eigen::Array2i columns_{0, 0};
  std::vector<std::uint32_t> begin_, items_;  // of each column: its triangles
};

}  // namespace softcell::ppu
