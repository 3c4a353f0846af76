#include "softcell/soft_bodies/mesh.h"

namespace softcell::ppu {

Bounds<3> bounds(const TriangleMesh& mesh) {
  Bounds<3> box{mesh.positions.front(), mesh.positions.front()};
  for (const Eigen::Vector3f& position : mesh.positions) {
    box.low = box.low.cwiseMin(position);
    box.high = box.high.cwiseMax(position);
  }
  return box;
}

void fit(TriangleMesh& mesh, float longest_side) {
  const Bounds<3> box = bounds(mesh);
  // In double: the sides of a box of finite floats may pass the largest float.
  const Eigen::Vector3d low = box.low.cast<double>(), high = box.high.cast<double>();
  const Eigen::Vector3d centre = 0.5 * (low + high);
  const double scale = static_cast<double>(longest_side) / (high - low).maxCoeff();
  for (Eigen::Vector3f& position : mesh.positions) {
    position = (scale * (position.cast<double>() - centre)).cast<float>();
  }
}

}  // namespace softcell::ppu
