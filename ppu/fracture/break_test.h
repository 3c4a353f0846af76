#pragma once
// Finds the faces of a body that break, from the positions of its particles after each substep.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/fracture/cracks.h"
#include "softcell/soft_bodies/soft_body_settings.h"

namespace softcell::ppu {

/// A face breaks when the distance between the middles of its cells exceeds 1 + stretch times that at rest, or when one cell is rotated
/// against the other by more than `turn`; each limit is multiplied by the face's strength. A cell's rotation is the rotation nearest to its
/// mean deformation. (For a cell pressed to less than half in a direction, the rotation may be underestimated.)
///
/// Computes in double precision, in the order of cells: the same bits for every solver. Used by one thread; keeps its allocated memory.
/// @source  [LSM07], where links between particles break by the same two measures.
template <int kDimension>
class BreakTest {
 public:
  using Vector = Eigen::Vector<float, kDimension>;

  /// @param positions  metres, of each particle
  /// @param rest       the same at rest, for a body with its own rest shape; empty: the lattice's rest positions
  /// @return numbers of faces that were not broken before, ascending; valid until the next call
  std::span<const std::uint32_t> find(const Lattice<kDimension>& lattice, const BreakableFaces& cracks,
                                      std::span<const Vector> positions, std::span<const Vector> rest,
                                      const Fracture& fracture);

 private:
  using Exact = Eigen::Vector<double, kDimension>;
  using Matrix = Eigen::Matrix<double, kDimension, kDimension>;
  struct Cell {
    Exact middle = Exact::Zero();
    Matrix deformation;  // set if turns are tested
    Matrix rotation;
    bool has_rotation = false;
  };
  const Matrix& rotation_of(std::uint32_t cell);

  std::vector<Cell> cells_;
  std::vector<Exact> middles_at_rest_;
  std::vector<std::uint32_t> found_;
};

extern template class BreakTest<2>;
extern template class BreakTest<3>;

/// A cut by a program: breaks faces whose cells have their middles on different sides of a parallelogram, or of its whole plane.
/// @param along, across  sides of the parallelogram from `corner`; must not be 0   @param whole_plane  cut along the whole plane
std::vector<std::uint32_t> faces_across(const Lattice<3>& lattice, const BreakableFaces& cracks,
                                        std::span<const Eigen::Vector3f> positions,
                                        const Eigen::Vector3f& corner, const Eigen::Vector3f& along,
                                        const Eigen::Vector3f& across, bool whole_plane);
/// The same in two dimensions: the middles lie on different sides of a line segment, or of its whole line.
/// @param way  from one end of the segment to the other; must not be 0
std::vector<std::uint32_t> faces_across(const Lattice<2>& lattice, const BreakableFaces& cracks,
                                        std::span<const Eigen::Vector2f> positions,
                                        const Eigen::Vector2f& from, const Eigen::Vector2f& way,
                                        bool whole_line);

}  // namespace softcell::ppu
