#include "ppu/fracture/break_test.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "ppu/matching/rotation.h"
#include "ppu/numbers/deterministic_math.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Corners = std::array<std::uint32_t, 8>;

Vector3d middle_of(const Corners& corners, std::span<const Vector3f> positions) {
  Vector3d sum = Vector3d::Zero();
  for (const std::uint32_t corner : corners) sum += positions[corner].cast<double>();
  return sum / 8;
}

/// Its columns are the mean edges of a cell along each axis.
Matrix3d edges_of(const Corners& corners, std::span<const Vector3f> positions) {
  Matrix3d edges = Matrix3d::Zero();
  for (unsigned k = 0; k < 8; ++k)
    for (unsigned axis = 0; axis < 3; ++axis)
      edges.col(axis) += ((k >> axis & 1u) != 0 ? 0.25 : -0.25) * positions[corners[k]].cast<double>();
  return edges;
}

}  // namespace

const Matrix3d& BreakTest::rotation_of(std::uint32_t number) {
  Cell& cell = cells_[number];
  if (!cell.has_rotation) {
    Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
    cell.rotation = find_rotation(cell.deformation, orientation);
    cell.has_rotation = true;
  }
  return cell.rotation;
}

std::span<const std::uint32_t> BreakTest::find(const Lattice<3>& lattice, const Cracks& cracks,
                                               std::span<const Vector3f> positions,
                                               std::span<const Vector3f> rest, const Fracture& fracture) {
  SC_ASSERT(positions.size() == lattice.particles.size() && (rest.empty() || rest.size() == positions.size()),
            "{} positions, {} at rest, of {} particles", positions.size(), rest.size(),
            lattice.particles.size());
  const double spacing = double{lattice.spacing};
  const bool turns = fracture.turn.has_value();
  cells_.resize(lattice.cells.size());
  middles_at_rest_.resize(rest.empty() ? 0 : lattice.cells.size());
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    const Corners& corners = lattice.corners[c];
    Cell& cell = cells_[c];
    cell.middle = middle_of(corners, positions);
    cell.has_rotation = false;
    if (turns) cell.deformation = edges_of(corners, positions) / spacing;
    if (rest.empty()) continue;
    middles_at_rest_[c] = middle_of(corners, rest);
    if (turns) cell.deformation = edges_of(corners, positions) * edges_of(corners, rest).inverse();
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
    // Rotations differ by at most twice as much as what they come from, or less, and |R - R'| = 2 sqrt(2) sin(angle / 2) >= 2 sqrt(2) angle / pi.
    const double least = std::sqrt(2.0) * most / kPi;
    if ((cells_[high].deformation - cells_[low].deformation).squaredNorm() < least * least) continue;
    const double cosine_of_turn = ((rotation_of(low).transpose() * rotation_of(high)).trace() - 1) / 2;
    if (cosine_of_turn < cosine(most)) found_.push_back(f);
  }
  return found_;
}

std::vector<std::uint32_t> faces_across(const Lattice<3>& lattice, const Cracks& cracks,
                                        std::span<const Vector3f> positions, const Vector3f& corner,
                                        const Vector3f& along, const Vector3f& across, bool whole_plane) {
  const Vector3d u = along.cast<double>(), v = across.cast<double>(), normal = u.cross(v);
  SC_ASSERT(normal.norm() > 0, "a cut along a parallelogram of the area {}", normal.norm());
  const auto height = [&](const Vector3d& point) { return normal.dot(point - corner.cast<double>()); };
  std::vector<std::uint32_t> faces;
  for (std::uint32_t f = 0; f < cracks.faces.size(); ++f) {
    if (cracks.is_broken[f]) continue;
    const Vector3d a = middle_of(lattice.corners[cracks.faces[f].low], positions);
    const Vector3d b = middle_of(lattice.corners[cracks.faces[f].high], positions);
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

}  // namespace softcell::ppu
