#include "ppu/mesh/solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "ppu/mesh/position_numbers.h"
#include "ppu/numbers/disjoint_sets.h"
#include "ppu/numbers/line_along_x.h"
#include "ppu/numbers/sorted_lists.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

using Eigen::Vector3d;
using Eigen::Vector3f;

Solid::Solid(const TriangleMesh& mesh) {
  SC_ASSERT(!mesh.positions.empty(), "{} triangles without corners", mesh.triangles.size());
  box_ = bounds(mesh);
  add_closed_parts(mesh);
  sort_into_columns();
}

/// Closed are parts in which each edge is passed as often in one direction as in the other.
void Solid::add_closed_parts(const TriangleMesh& mesh) {
  constexpr double kMostOpen = 0.05;  // share of the surface
  const std::vector<std::uint32_t> number = number_positions(mesh.positions);
  DisjointSets parts(number.size());
  // Of edges, from the lower corner to the higher.
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = number[t[k]], b = number[t[(k + 1) % 3]];
      parts.unite(a, b);
      if (a != b) balance[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  std::vector<bool> is_open(number.size());
  for (const auto& [edge, count] : balance)
    if (count != 0) is_open[parts.find(edge.first)] = true;
  double area = 0, open = 0;
  for (const auto& t : mesh.triangles) {
    const std::array<Vector3d, 3> corners{mesh.positions[t[0]].cast<double>(),
                                          mesh.positions[t[1]].cast<double>(),
                                          mesh.positions[t[2]].cast<double>()};
    const double its_area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
    area += its_area;
    if (is_open[parts.find(number[t[0]])])
      open += its_area;
    else if (its_area > 0)
      triangles_.push_back(corners);
  }
  is_whole_ = open <= kMostOpen * area;
}

void Solid::sort_into_columns() {
  constexpr double kMostColumns = 512;  // along an axis
  const double wanted =
      std::clamp(std::ceil(std::sqrt(static_cast<double>(triangles_.size()))), 1.0, kMostColumns);
  const Eigen::Array2d low = box_.low.tail<2>().cast<double>(), high = box_.high.tail<2>().cast<double>();
  columns_.setConstant(static_cast<int>(wanted));
  column_low_ = low;
  columns_per_metre_ = (high - low > 0).select(wanted / (high - low).max(1e-300), 0.0);
  const auto for_each_column = [&](std::size_t number, const auto& work) {
    const auto& t = triangles_[number];
    const Vector3d least = t[0].cwiseMin(t[1]).cwiseMin(t[2]), most = t[0].cwiseMax(t[1]).cwiseMax(t[2]);
    const Eigen::Array2i first = column_of(least), last = column_of(most);
    for (int z = first.y(); z <= last.y(); ++z)
      for (int y = first.x(); y <= last.x(); ++y) work(slot({y, z}));
  };
  sort_into_lists(static_cast<std::size_t>(columns_.prod()), triangles_.size(), for_each_column, begin_,
                  items_);
}

/// The nearest one of a point outside of the box.
Eigen::Array2i Solid::column_of(const Vector3d& point) const {
  const Eigen::Array2d place = (point.tail<2>().array() - column_low_) * columns_per_metre_;
  return place.max(0.0).min((columns_ - 1).cast<double>()).cast<int>();
}

std::size_t Solid::slot(const Eigen::Array2i& column) const {
  return static_cast<std::size_t>(column.y()) * static_cast<std::size_t>(columns_.x()) +
         static_cast<std::size_t>(column.x());
}

bool Solid::contains(const Vector3f& point) const {
  if ((point.array() < box_.low.array()).any() || (point.array() > box_.high.array()).any()) return false;
  const double x = point.x(), y = point.y(), z = point.z();
  const std::size_t i = slot(column_of({x, y, z}));
  int winding = 0;
  for (std::uint32_t k = begin_[i]; k < begin_[i + 1]; ++k) {
    const auto& t = triangles_[items_[k]];
    const int sense = turns_around(t, y, z);
    if (sense != 0 && place_in(t, y, z) > x) winding += sense;
  }
  return winding != 0;
}

}  // namespace softcell::ppu
