#include "ppu/fracture/break_test.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "ppu/matching/rotation.h"
#include "ppu/numbers/cross.h"
#include "ppu/numbers/deterministic_math.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;
template <int kDimension>
using Corners = std::array<std::uint32_t, Lattice<kDimension>::kCorners>;
template <int kDimension>
using Positions = std::span<const Eigen::Vector<float, kDimension>>;

template <int kDimension>
Eigen::Vector<double, kDimension> middle_of(const Corners<kDimension>& corners,
                                            Positions<kDimension> positions) {
  Eigen::Vector<double, kDimension> sum = Eigen::Vector<double, kDimension>::Zero();
  for (const std::uint32_t corner : corners) sum += positions[corner].template cast<double>();
  return sum / static_cast<double>(corners.size());
}

/// A matrix whose columns are the mean edges of a cell along each axis.
template <int kDimension>
Eigen::Matrix<double, kDimension, kDimension> edges_of(const Corners<kDimension>& corners,
                                                       Positions<kDimension> positions) {
  Eigen::Matrix<double, kDimension, kDimension> edges = Eigen::Matrix<double, kDimension, kDimension>::Zero();
  const double share = 2.0 / static_cast<double>(corners.size());
  for (unsigned k = 0; k < corners.size(); ++k)
    for (unsigned axis = 0; axis < kDimension; ++axis)
      edges.col(axis) +=
          ((k >> axis & 1u) != 0 ? share : -share) * positions[corners[k]].template cast<double>();
  return edges;
}

/// The cosine of the angle between two rotations.
double cosine_between(const Matrix2d& a, const Matrix2d& b) { return (a.transpose() * b).trace() / 2; }
double cosine_between(const Matrix3d& a, const Matrix3d& b) { return ((a.transpose() * b).trace() - 1) / 2; }

}  // namespace

template <int kDimension>
auto BreakTest<kDimension>::rotation_of(std::uint32_t number) -> const Matrix& {
  Cell& cell = cells_[number];
  if (!cell.has_rotation) {
    cell.rotation = nearest_rotation(cell.deformation);
    cell.has_rotation = true;
  }
  return cell.rotation;
}

template <int kDimension>
std::span<const std::uint32_t> BreakTest<kDimension>::find(const Lattice<kDimension>& lattice,
                                                           const BreakableFaces& cracks,
                                                           std::span<const Vector> positions,
                                                           std::span<const Vector> rest,
                                                           const Fracture& fracture) {
  SC_ASSERT(positions.size() == lattice.particles.size() && (rest.empty() || rest.size() == positions.size()),
            "{} positions, {} at rest, of {} particles", positions.size(), rest.size(),
            lattice.particles.size());
  const double spacing = double{lattice.spacing};
  const bool turns = fracture.turn.has_value();
  cells_.resize(lattice.cells.size());
  middles_at_rest_.resize(rest.empty() ? 0 : lattice.cells.size());
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const Corners<kDimension>& corners = lattice.corners[c];
    Cell& cell = cells_[c];
    cell.middle = middle_of<kDimension>(corners, positions);
    cell.has_rotation = false;
    if (turns) cell.deformation = edges_of<kDimension>(corners, positions) / spacing;
    if (rest.empty()) continue;
    middles_at_rest_[c] = middle_of<kDimension>(corners, rest);
    if (!turns) continue;
    const Matrix edges_at_rest = edges_of<kDimension>(corners, rest);
    cell.deformation = edges_of<kDimension>(corners, positions) * edges_at_rest.inverse();
  }
  found_.clear();
  for (std::uint32_t f = 0; f < cracks.faces.size(); ++f) {
    if (cracks.is_broken[f]) continue;
    const auto& [low, high, axis] = cracks.faces[f];
    const double strength = double{cracks.strength[f]};
    if (fracture.stretch) {
      const double at_rest = rest.empty() ? spacing : (middles_at_rest_[high] - middles_at_rest_[low]).norm();
      const double most = (1 + double{*fracture.stretch} * strength) * at_rest;
      if ((cells_[high].middle - cells_[low].middle).squaredNorm() > most * most) {
        found_.push_back(f);
        continue;
      }
    }
    if (!turns) continue;
    const double most = double{*fracture.turn} * strength;
    if (!(most < kPi)) continue;
    // Rotations differ by at most twice as much as the deformations that they come from, and |R - R'| = 2 sqrt(2) sin(angle / 2) >= 2
    // sqrt(2) angle / pi.
    const double least = std::sqrt(2.0) * most / kPi;
    if ((cells_[high].deformation - cells_[low].deformation).squaredNorm() < least * least) continue;
    const Matrix &of_low = rotation_of(low), &of_high = rotation_of(high);
    if (cosine_between(of_low, of_high) < cosine(most)) found_.push_back(f);
  }
  return found_;
}

template class BreakTest<2>;
template class BreakTest<3>;

std::vector<std::uint32_t> faces_across(const Lattice<3>& lattice, const BreakableFaces& cracks,
                                        std::span<const Vector3f> positions, const Vector3f& corner,
                                        const Vector3f& along, const Vector3f& across, bool whole_plane) {
  const Vector3d u = along.cast<double>(), v = across.cast<double>(), normal = u.cross(v);
  SC_ASSERT(normal.norm() > 0, "a cut along a parallelogram of the area {}", normal.norm());
  const auto height = [&](const Vector3d& point) { return normal.dot(point - corner.cast<double>()); };
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < cracks.faces.size(); ++f) {
    if (cracks.is_broken[f]) continue;
    const Vector3d a = middle_of<3>(lattice.corners[cracks.faces[f].low], positions);
    const Vector3d b = middle_of<3>(lattice.corners[cracks.faces[f].high], positions);
    const double from = height(a), to = height(b);
    if ((from > 0) == (to > 0)) continue;
    if (!whole_plane) {
      const Vector3d at = a + from / (from - to) * (b - a) - corner.cast<double>();
      // at = s u + t v
      const double s = at.cross(v).dot(normal) / normal.squaredNorm(),
                   t = u.cross(at).dot(normal) / normal.squaredNorm();
      if (!(s >= 0 && s <= 1 && t >= 0 && t <= 1)) continue;
    }
    faces.push_back(f);
  }
  return faces;
}

std::vector<std::uint32_t> faces_across(const Lattice<2>& lattice, const BreakableFaces& cracks,
                                        std::span<const Vector2f> positions, const Vector2f& from,
                                        const Vector2f& way, bool whole_line) {
  const Vector2d along = way.cast<double>(), begin = from.cast<double>();
  SC_ASSERT(along.norm() > 0, "a cut along a stretch of {} m", along.norm());
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < cracks.faces.size(); ++f) {
    if (cracks.is_broken[f]) continue;
    const Vector2d a = middle_of<2>(lattice.corners[cracks.faces[f].low], positions) - begin;
    const Vector2d b = middle_of<2>(lattice.corners[cracks.faces[f].high], positions) - begin;
    const double left_of_a = cross(along, a), left_of_b = cross(along, b);
    if ((left_of_a > 0) == (left_of_b > 0)) continue;
    if (!whole_line) {
      const Vector2d at = a + left_of_a / (left_of_a - left_of_b) * (b - a);
      const double share = along.dot(at) / along.squaredNorm();
      if (!(share >= 0 && share <= 1)) continue;
    }
    faces.push_back(f);
  }
  return faces;
}

}  // namespace softcell::ppu
