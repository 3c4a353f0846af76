#include "support/first_touch.h"

#include <algorithm>
#include <array>
#include <vector>

#include "ppu/surfaces/triangle_distance.h"

namespace softcell::tests {

using Eigen::Vector3d;
using Eigen::Vector3f;

double first_touch(const ppu::TriangleMesh& mesh, const Vector3f& from, const Vector3f& to, double radius) {
  std::vector<std::array<Vector3d, 3>> triangles;
  for (const auto& t : mesh.triangles)
    triangles.push_back({mesh.positions[t[0]].cast<double>(), mesh.positions[t[1]].cast<double>(),
                         mesh.positions[t[2]].cast<double>()});
  constexpr int kSteps = 400;
  for (int i = 0; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    const Vector3d centre = from.cast<double>() + share * (to - from).cast<double>();
    const auto is_touched = [&](const std::array<Vector3d, 3>& corners) {
      return (ppu::nearest_point<double>(corners, centre) - centre).norm() <= radius;
    };
    if (std::ranges::any_of(triangles, is_touched)) return share;
  }
  return 2;
}

}  // namespace softcell::tests
