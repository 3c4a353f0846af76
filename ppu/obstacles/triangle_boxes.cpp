#include "ppu/obstacles/triangle_boxes.h"

namespace softcell::ppu {

void TriangleBoxes::place(std::span<const std::array<Eigen::Vector3f, 3>> triangles) {
  using Eigen::Vector3f;
  triangles_ = triangles.size();
  fours_.resize(count_of(triangles_, 4));
  const std::size_t blocks = count_of(triangles_, kInBlock);
  blocks_.resize(count_of(blocks, 4));
  for (std::size_t block = 0; block < blocks; ++block) {
    const std::size_t end = std::min((block + 1) * kInBlock, triangles_);
    Vector3f lowest = triangles[block * kInBlock][0], highest = lowest;
    for (std::size_t t = block * kInBlock; t < end; ++t) {
      const auto& [a, b, c] = triangles[t];
      const Vector3f low = a.cwiseMin(b).cwiseMin(c), high = a.cwiseMax(b).cwiseMax(c);
      fours_[t / 4].set(static_cast<Eigen::Index>(t % 4), low, high);
      lowest = lowest.cwiseMin(low);
      highest = highest.cwiseMax(high);
    }
    blocks_[block / 4].set(static_cast<Eigen::Index>(block % 4), lowest, highest);
    bounds_.low = block == 0 ? lowest : bounds_.low.cwiseMin(lowest);
    bounds_.high = block == 0 ? highest : bounds_.high.cwiseMax(highest);
  }
}

}  // namespace softcell::ppu
