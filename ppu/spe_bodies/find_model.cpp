#include "ppu/spe_bodies/find_model.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace softcell::ppu {
namespace {

/// The largest binary16 that is neither subnormal nor above a number. @pre |number| <= 65504
Eigen::half half_not_above(float number) {
  constexpr float kLeastNormal = 0x1p-14f;
  if (std::abs(number) < kLeastNormal) return Eigen::half(number < 0 ? -kLeastNormal : 0.0f);
  const Eigen::half nearest(number);
  if (static_cast<float>(nearest) <= number) return nearest;
  // Bits of equal sign are ordered as magnitudes are.
  const auto bits = Eigen::numext::bit_cast<std::uint16_t>(nearest);
  return Eigen::numext::bit_cast<Eigen::half>(static_cast<std::uint16_t>(number < 0 ? bits + 1 : bits - 1));
}

std::uint16_t bits_of(Eigen::half number) { return Eigen::numext::bit_cast<std::uint16_t>(number); }

/// A linear function of s = xi - 1/2 below the field: with the slopes that fit it best, as high as may be.
/// Between its nodes the field is trilinear, so the difference is least at a node.
void fit_below(spu::FindCell& cell, const ContactSurface::CellField& field) {
  const auto place = [](int node, int axis) {
    const int step = axis == 0 ? node % 3 : axis == 1 ? node / 3 % 3 : node / 9;
    return 0.5f * static_cast<float>(step) - 0.5f;
  };
  constexpr float kSquares = 18 * 0.25f;  // of the nodes' places along an axis
  Eigen::Vector3f slopes = Eigen::Vector3f::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    for (int node = 0; node < 27; ++node)
      slopes[axis] += place(node, axis) * field[static_cast<std::size_t>(node)] / kSquares;
    const Eigen::half slope = half_not_above(slopes[axis]);
    cell.least[axis] = bits_of(slope);
    slopes[axis] = static_cast<float>(slope);
  }
  float least = std::numeric_limits<float>::max();
  for (int node = 0; node < 27; ++node) {
    float sum = field[static_cast<std::size_t>(node)];
    for (int axis = 0; axis < 3; ++axis) sum -= slopes[axis] * place(node, axis);
    least = std::min(least, sum);
  }
  cell.least[3] = bits_of(half_not_above(std::max(least, -kDeepestInField)));
}

}  // namespace

FindModel::FindModel(const ContactModel& model) {
  const Lattice<3>& lattice = model.model->lattice();
  for (std::uint32_t c = 0; c < lattice.cells.size(); ++c) {
    spu::FindCell& cell = cells.emplace_back();
    std::copy(lattice.corners[c].begin(), lattice.corners[c].end(), cell.corner);
    for (int d = 0; d < 3; ++d) cell.grid[d] = static_cast<std::int16_t>(lattice.cells[c][d]);
    const ContactSurface::CellField& field = model.surface.nodes(c);
    std::ranges::transform(field, cell.field, [](float distance) { return bits_of(Eigen::half(distance)); });
    fit_below(cell, field);
    cell.first_group = static_cast<std::uint16_t>(groups.size());
    const std::uint32_t first = model.first_of_cell[c], end = model.first_of_cell[c + 1];
    for (std::uint32_t i = first; i < end; ++i) {
      const std::uint32_t lane = (i - first) % 4;
      if (lane == 0) {
        spu::FindGroup& fresh = groups.emplace_back();
        std::fill(std::begin(fresh.allowance), std::end(fresh.allowance), spu::kFindNoPoint);
      }
      const TouchPoint& point = model.touch_points[i];
      spu::FindGroup& group = groups.back();
      group.along_x[lane] = point.xi.x() - 0.5f;
      group.along_y[lane] = point.xi.y() - 0.5f;
      group.along_z[lane] = point.xi.z() - 0.5f;
      group.allowance[lane] = point.allowance;
    }
    cell.group_count = static_cast<std::uint16_t>(groups.size() - cell.first_group);
  }
}

}  // namespace softcell::ppu
