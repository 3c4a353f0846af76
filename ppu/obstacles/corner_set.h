#pragma once
// Collects the corners of triangles, each once, and tells which of them lie flat within a surface.

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/obstacles/exact_point.h"

namespace softcell::ppu {

/// A hash table of corners. Allocates only when there are more of them than ever before.
class CornerSet {
 public:
  using Point = ExactPoint;
  using Triangle = std::array<Eigen::Vector3f, 3>;

  class Corner {
   public:
    Point point{};

    /// Whether triangles surround this corner completely, added in any order, and bend by no more than are_nearly_parallel() allows.
    bool is_flat() const { return !stands_out_ && around_ == 0; }

   private:
    friend CornerSet;
    Eigen::Vector3f normal_;    // of the first triangle; its length does not matter
    std::uint64_t around_ = 0;  // hashes of next corners minus previous ones: 0 if surrounded
    bool stands_out_ = false;
  };

  /// Empties the set. @param most  number of corners that will be added, repeated ones included
  void begin(std::size_t most) {
    corners_.clear();
    corners_.reserve(most);
    const std::size_t slots = std::bit_ceil(2 * most + 1);
    mask_ = slots - 1;
    slots_.assign(slots, kNone);
  }

  /// Adds the corners of a triangle. @pre  no more corners than begin() announced
  /// @return  their indices in corners()
  std::array<std::uint32_t, 3> add(const Triangle& triangle) {
    const Eigen::Vector3f normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    std::array<Point, 3> points;
    std::array<std::uint64_t, 3> hashes;
    for (std::size_t i = 0; i < 3; ++i) hashes[i] = hash_of(points[i] = exact_point(triangle[i]));
    std::array<std::uint32_t, 3> indices;
    for (std::size_t i = 0; i < 3; ++i) {
      Corner& corner = at(points[i], hashes[i], normal);
      indices[i] = static_cast<std::uint32_t>(&corner - corners_.data());
      corner.stands_out_ = corner.stands_out_ || !are_nearly_parallel(corner.normal_, normal);
      corner.around_ += hashes[(i + 1) % 3] - hashes[(i + 2) % 3];
    }
    return indices;
  }

  /// Adds a corner of which nothing else is known, so it is not flat. @pre  as above
  void add(const Eigen::Vector3f& point) {
    const Point added = exact_point(point);
    at(added, hash_of(added), {0, 0, 0}).stands_out_ = true;
  }

  /// In the order in which they were first added.
  std::span<const Corner> corners() const { return corners_; }

 private:
  static constexpr std::uint32_t kNone = ~0u;

  Corner& at(const Point& point, std::uint64_t hash, const Eigen::Vector3f& normal) {
    for (std::size_t slot = static_cast<std::size_t>(hash) & mask_;; slot = (slot + 1) & mask_) {
      if (slots_[slot] == kNone) {
        slots_[slot] = static_cast<std::uint32_t>(corners_.size());
        Corner& corner = corners_.emplace_back();
        corner.point = point;
        corner.normal_ = normal;
        return corner;
      }
      if (corners_[slots_[slot]].point == point) return corners_[slots_[slot]];
    }
  }

  std::vector<Corner> corners_;
  std::vector<std::uint32_t> slots_;
  std::size_t mask_ = 0;
};

}  // namespace softcell::ppu
