#pragma once
// Cuts a triangle at all planes of a lattice, exactly.
//
// Coordinates are integers, kUnitsPerCell to a cell. Corners have odd coordinates and planes lie at even ones, so no corner is on a plane.
// Planes are also moved by e_x, e_y and e_z, which are infinitely small, each much smaller than the one before it, so no line of the
// lattice meets an edge of a triangle. So there are no special cases, and cuts of neighbouring triangles and cells always fit together,
// however corners and crossings are rounded.
// @source  [EM90] for the tiny displacements that decide ties.

#include <array>
#include <cstdint>
#include <vector>

namespace softcell::ppu {

inline constexpr std::int64_t kUnitsPerCell = std::int64_t{1} << 17;
inline constexpr std::int64_t kMaxUnits = kUnitsPerCell * 256;

using UnitPoint = std::array<std::int64_t, 3>;  ///< odd, 0..kMaxUnits

/// A corner of the part of a triangle that lies in a cell: a corner of the triangle (on no plane), a point where a side of the triangle
/// meets a plane (on one), or a point where a line of the lattice meets the triangle (on two).
struct CutVertex {
  std::uint8_t planes = 0;  ///< number of planes that it is on
  /// On no plane: the corner's number in the triangle. On one plane: the number of the side, which goes from corner `of` to the next.
  std::uint8_t of = 0;
  std::array<std::uint8_t, 2> axis{};  ///< of the planes, ascending
  std::array<int, 2> plane{};          ///< multiples of kUnitsPerCell

  bool operator==(const CutVertex&) const = default;
};

/// The part of a triangle that lies in one cell.
struct CutPolygon {
  static constexpr std::uint8_t kOnPlane = 3;  ///< plus the axis
  std::array<int, 3> cell{};                   ///< grid index
  std::vector<CutVertex> vertices;             ///< in the triangle's own direction
  /// For the side from each vertex to the next one: the triangle's side on which it lies, or kOnPlane + the axis of its plane.
  std::vector<std::uint8_t> sides;
  std::vector<int> planes;  ///< for sides that lie on a plane
};

/// @return convex polygons, in ascending order of x, then y, then z of their cells
std::vector<CutPolygon> cut_triangle(const std::array<UnitPoint, 3>& corners);

/// The normal of a triangle, not of unit length.
UnitPoint normal_of(const std::array<UnitPoint, 3>& corners);

}  // namespace softcell::ppu
