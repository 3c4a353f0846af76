#include "ppu/spe_bodies/find_model.h"

#include <algorithm>

namespace softcell::ppu {
namespace {

/// Fits a linear function of s = xi - 1/2 below the field: with the slopes of the best fit, as high as possible. The field is trilinear
/// between its nodes, so the difference is least at a node.
void fit_below(spu::FindCell& cell) {
  const auto place = [](int node, int axis) {
    const int step = axis == 0 ? node % 3 : axis == 1 ? node / 3 % 3 : node / 9;
    return 0.5f * static_cast<float>(step) - 0.5f;
  };
  constexpr float kSquares = 18 * 0.25f;  // of the nodes' places along an axis
  for (int axis = 0; axis < 3; ++axis) {
    cell.least[axis] = 0;
    for (int node = 0; node < 27; ++node) cell.least[axis] += place(node, axis) * cell.field[node] / kSquares;
  }
  const auto below = [&](int node) {
    float sum = cell.field[node];
    for (int axis = 0; axis < 3; ++axis) sum -= cell.least[axis] * place(node, axis);
    return sum;
  };
  cell.least[3] = below(0);
  for (int node = 1; node < 27; ++node) cell.least[3] = std::min(cell.least[3], below(node));
}

}  // namespace

FindModel::FindModel(const ContactModel& model) {
  const Lattice<3>& lattice = model.lattice();
  for (std::uint32_t c = 0; c < lattice.cells.size(); ++c) {
    spu::FindCell& cell = cells.emplace_back();
    std::copy(lattice.corners[c].begin(), lattice.corners[c].end(), cell.corner);
    for (int d = 0; d < 3; ++d) cell.grid[d] = static_cast<std::int16_t>(lattice.cells[c][d]);
    const CellPlace& inner = model.inner_places[c];
    cell.inner_cell = static_cast<std::uint16_t>(inner.cell);
    cell.inner_node = static_cast<std::uint16_t>(2 * inner.xi.x() + 8 * inner.xi.y() + 32 * inner.xi.z());
    std::ranges::copy(model.surface.nodes(c), cell.field);
    fit_below(cell);
    cell.first_group = static_cast<std::uint16_t>(groups.size());
    const std::uint32_t first = model.first_of_cell[c], end = model.first_of_cell[c + 1];
    for (std::uint32_t i = first; i < end; ++i) {
      const std::uint32_t lane = (i - first) % 4;
      if (lane == 0) {
        spu::FindGroup& fresh = groups.emplace_back();
        std::fill(std::begin(fresh.allowance), std::end(fresh.allowance), spu::kFindNoPoint);
        // Lanes without a point repeat the first point: so they do not enlarge the region around all of them.
        const Eigen::Vector3f s = model.touch_points[i].xi.array() - 0.5f;
        std::fill(std::begin(fresh.along_x), std::end(fresh.along_x), s.x());
        std::fill(std::begin(fresh.along_y), std::end(fresh.along_y), s.y());
        std::fill(std::begin(fresh.along_z), std::end(fresh.along_z), s.z());
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
