#pragma once
// Boxes around triangles, to find the triangles near a point.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/mesh/four_boxes.h"

namespace softcell::ppu {

/// Two layers of boxes: around each triangle, and around each 16 successive ones. A search is quick when successive triangles lie near each
/// other, as those of meshes and height fields do. Allocates only when there are more triangles than ever before.
class TriangleBoxes {
 public:
  void place(std::span<const std::array<Eigen::Vector3f, 3>> triangles);

  /// Calls work(triangle) for the index of each triangle whose box has a point in common with `box`, ascending.
  template <typename Work>
  void for_each_meeting(const Bounds<3>& box, const Work& work) const {
    for_each_lane(blocks_, count_of(triangles_, kInBlock), box, [&](std::size_t block) {
      const std::size_t first = block * kFoursInBlock;
      const std::size_t fours = std::min(kFoursInBlock, fours_.size() - first);
      for_each_lane({fours_.data() + first, fours}, triangles_ - 4 * first, box,
                    [&](std::size_t i) { work(static_cast<std::uint32_t>(4 * first + i)); });
    });
  }

  /// Calls work(first, end, box) for each run of 16 triangles, the last one perhaps shorter, and the box around them.
  template <typename Work>
  void for_each_block(const Work& work) const {
    for (std::size_t block = 0; block < count_of(triangles_, kInBlock); ++block) {
      const FourBoxes& four = blocks_[block / 4];
      work(block * kInBlock, std::min((block + 1) * kInBlock, triangles_),
           four.at(static_cast<Eigen::Index>(block % 4)));
    }
  }

  /// The box around one triangle.
  Bounds<3> at(std::size_t triangle) const {
    return fours_[triangle / 4].at(static_cast<Eigen::Index>(triangle % 4));
  }

  /// The box around all triangles. @pre there are some
  const Bounds<3>& bounds() const { return bounds_; }

 private:
  static constexpr std::size_t kFoursInBlock = 4, kInBlock = 4 * kFoursInBlock;

  static std::size_t count_of(std::size_t items, std::size_t in_each) {
    return (items + in_each - 1) / in_each;
  }

  /// @param count  number of boxes; the lanes beyond it, which fill up the last four, are no boxes
  template <typename Work>
  static void for_each_lane(std::span<const FourBoxes> fours, std::size_t count, const Bounds<3>& box,
                            const Work& work) {
    for (std::size_t g = 0; g < fours.size(); ++g) {
      const Eigen::Array4f apart = fours[g].apart_from(box);
      if (apart.minCoeff() > 0) continue;
      const std::size_t lanes = std::min<std::size_t>(4, count - 4 * g);
      for (std::size_t lane = 0; lane < lanes; ++lane)
        if (apart[static_cast<Eigen::Index>(lane)] <= 0) work(4 * g + lane);
    }
  }

  std::size_t triangles_ = 0;
  std::vector<FourBoxes> fours_, blocks_;
  Bounds<3> bounds_{};
};

}  // namespace softcell::ppu
