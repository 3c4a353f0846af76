#pragma once
// Which faces of a body break: after each substep, by where its particles are.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/fracture/cracks.h"
#include "softcell/soft_bodies/soft_body_settings.h"

namespace softcell::ppu {

/// A face breaks when the middles of its cells are farther from each other than 1 + stretch times as far as at rest, or when the cells
/// are turned against each other by more than `turn`: each times the face's strength. A cell is turned as its mean deformation is, by the
/// rotation nearest to it. (A cell that is pressed to less than half in a direction may be seen as turned less than it is.)
///
/// In double precision, in the order of cells: the same bits for every solver. Used by one thread; keeps its room.
/// @source  [LSM07], where links between particles break by the same two measures.
template <int kDimension>
class BreakTest {
 public:
  using Vector = Eigen::Vector<float, kDimension>;

  /// @param positions  metres, of each particle
  /// @param rest       the same at rest, of a body with a rest shape of its own; empty: as the lattice has them
  /// @return numbers of faces that were not broken before, ascending; good until the next call
  std::span<const std::uint32_t> find(const Lattice<kDimension>& lattice, const BreakableFaces& cracks,
                                      std::span<const Vector> positions, std::span<const Vector> rest,
                                      const Fracture& fracture);

 private:
  using Exact = Eigen::Vector<double, kDimension>;
  using Matrix = Eigen::Matrix<double, kDimension, kDimension>;
  struct Cell {
    Exact middle = Exact::Zero();
    Matrix deformation;  // where turns are looked at
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

/// A cut by a program: faces whose cells have their middles on different sides of a parallelogram, or of the whole plane, break.
/// @param along, across  its sides from `corner`; null vectors are not allowed   @param whole_plane  it has no end
std::vector<std::uint32_t> faces_across(const Lattice<3>& lattice, const BreakableFaces& cracks,
                                        std::span<const Eigen::Vector3f> positions,
                                        const Eigen::Vector3f& corner, const Eigen::Vector3f& along,
                                        const Eigen::Vector3f& across, bool whole_plane);
/// The same in two dimensions: the middles lie on different sides of a stretch of a line, or of the whole line.
/// @param way  from one end of the stretch to the other; null vectors are not allowed
std::vector<std::uint32_t> faces_across(const Lattice<2>& lattice, const BreakableFaces& cracks,
                                        std::span<const Eigen::Vector2f> positions,
                                        const Eigen::Vector2f& from, const Eigen::Vector2f& way,
                                        bool whole_line);

}  // namespace softcell::ppu
