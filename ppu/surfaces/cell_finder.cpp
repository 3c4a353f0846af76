#include "ppu/surfaces/cell_finder.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "ppu/numbers/row.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;
using Eigen::Vector3i;

constexpr float kCubeInCells = 1.5f;
constexpr int kMostCubesPerAxis = 64;  // of a body that is stretched far: cubes grow

/// Makes room for twice as much if there is not enough, so that a rotating body does not allocate again and again.
template <typename T>
void make_room(std::vector<T>& list, std::size_t count) {
  if (count > list.capacity()) list.reserve(2 * count);
}

}  // namespace

void CellFinder::place(const Lattice<3>& lattice, std::span<const Vector3f> positions) {
  SC_ASSERT(positions.size() == lattice.particles.size() && !lattice.cells.empty(),
            "{} positions of {} particles", positions.size(), lattice.particles.size());
  lattice_ = &lattice;
  positions_ = positions;
  using Row = Eigen::Array4f;
  rows_.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) set_row(rows_[i], positions[i]);
  boxes_.resize(lattice.cells.size());
  Row lowest = rows_[0], highest = lowest;
  for (std::size_t c = 0; c < boxes_.size(); ++c) {
    const auto& corners = lattice.corners[c];
    Row low = rows_[corners[0]], high = low;
    for (std::size_t k = 1; k < 8; ++k) {
      low = low.min(rows_[corners[k]]);
      high = high.max(rows_[corners[k]]);
    }
    boxes_[c] = {low.head<3>(), high.head<3>()};
    lowest = lowest.min(low);
    highest = highest.max(high);
  }
  low_ = lowest.head<3>();
  const Vector3f size = highest.head<3>().matrix() - low_;
  const float cube = std::max(kCubeInCells * lattice.spacing, size.maxCoeff() / kMostCubesPerAxis);
  per_cube_ = 1 / cube;
  counts_ = (size * per_cube_).cast<int>().array() + 1;

  const auto for_each_cube = [&](const Box& box, const auto& work) {
    const Vector3i first = ((box.low - low_) * per_cube_).cast<int>();
    const Vector3i last =
        ((box.high - low_) * per_cube_).cast<int>().cwiseMin((counts_.array() - 1).matrix());
    for (int z = first.z(); z <= last.z(); ++z)
      for (int y = first.y(); y <= last.y(); ++y)
        for (int x = first.x(); x <= last.x(); ++x)
          work(static_cast<std::size_t>((z * counts_.y() + y) * counts_.x() + x));
  };
  const std::size_t cubes = static_cast<std::size_t>(counts_.prod());
  make_room(begin_, cubes + 1);
  make_room(next_, cubes);
  begin_.assign(cubes + 1, 0);
  for (const Box& box : boxes_) for_each_cube(box, [&](std::size_t i) { ++begin_[i + 1]; });
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  make_room(cells_, begin_.back());
  cells_.resize(begin_.back());
  next_.assign(begin_.begin(), begin_.end() - 1);
  for (std::uint32_t c = 0; c < boxes_.size(); ++c)
    for_each_cube(boxes_[c], [&](std::size_t i) { cells_[next_[i]++] = c; });
}

/// Finds the place by Newton's iteration from the middle of the cell.
std::optional<DeformedPlace> CellFinder::place_in(std::uint32_t cell, const Vector3f& point) const {
  constexpr int kIterations = 4;
  constexpr float kTolerance = 1e-3f;
  constexpr float kHopeless = 1.25f;  // a point this far from the middle after one step is not in the cell
  std::array<Vector3f, 8> x;
  for (std::size_t k = 0; k < 8; ++k) x[k] = positions_[lattice_->corners[cell][k]];

  DeformedPlace place{cell, Vector3f::Constant(0.5f), Matrix3f::Identity()};
  for (int i = 0; i < kIterations; ++i) {
    const Vector3f& u = place.xi;
    const auto mix = [](const Vector3f& a, const Vector3f& b, float t) -> Vector3f {
      return a + t * (b - a);
    };
    const Vector3f x00 = mix(x[0], x[1], u.x()), x10 = mix(x[2], x[3], u.x());
    const Vector3f x01 = mix(x[4], x[5], u.x()), x11 = mix(x[6], x[7], u.x());
    const Vector3f x0 = mix(x00, x10, u.y()), x1 = mix(x01, x11, u.y());
    place.jacobian.col(0) =
        mix(mix(x[1] - x[0], x[3] - x[2], u.y()), mix(x[5] - x[4], x[7] - x[6], u.y()), u.z());
    place.jacobian.col(1) = mix(x10 - x00, x11 - x01, u.z());
    place.jacobian.col(2) = x1 - x0;
    const float volume = place.jacobian.determinant();
    const float least = 1e-3f * lattice_->spacing * lattice_->spacing * lattice_->spacing;
    if (!(volume > least)) return {};
    const Vector3f step = place.jacobian.inverse() * (point - mix(x0, x1, u.z()));
    place.xi = (u + step).cwiseMax(-1.0f).cwiseMin(2.0f);
    if (i == 0 && (place.xi.array() - 0.5f).abs().maxCoeff() > kHopeless) return {};
    if (step.squaredNorm() < kTolerance * kTolerance) break;
  }
  if ((place.xi.array() < -kTolerance).any() || (place.xi.array() > 1 + kTolerance).any()) return {};
  place.xi = place.xi.cwiseMax(0.0f).cwiseMin(1.0f);
  return place;
}

}  // namespace softcell::ppu
