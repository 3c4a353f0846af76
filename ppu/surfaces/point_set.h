#pragma once
// Points, each once.

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace softcell::ppu {

/// A hash table of points. Allocates only when there are more points than ever before.
class PointSet {
 public:
  /// Empties the set. @param most  of points that will be added, repeated ones included
  void begin(std::size_t most) {
    points_.clear();
    points_.reserve(most);
    const std::size_t slots = std::bit_ceil(2 * most + 1);
    mask_ = slots - 1;
    slots_.assign(slots, kNone);
  }

  /// @pre  not more often than begin() was told
  void add(const Eigen::Vector3f& point) {
    const Point added{point.x(), point.y(), point.z()};
    for (std::size_t slot = hash_of(added) & mask_;; slot = (slot + 1) & mask_) {
      if (slots_[slot] == kNone) {
        slots_[slot] = static_cast<std::uint32_t>(points_.size());
        points_.push_back(added);
        return;
      }
      if (points_[slots_[slot]] == added) return;
    }
  }

  using Point = std::array<float, 3>;
  std::span<const Point> points() const { return points_; }

 private:
  static constexpr std::uint32_t kNone = ~0u;

  static std::size_t hash_of(const Point& point) {
    std::uint64_t hash = 0;
    // -0 + 0 is 0: points that compare equal have one hash.
    for (const float x : point) {
      hash =
          (hash ^ std::bit_cast<std::uint32_t>(x + 0.0f)) * 0x9E3779B97F4A7C15u;  // 2^64 by the golden ratio
      hash ^= hash >> 32;
    }
    return static_cast<std::size_t>(hash);
  }

  std::vector<Point> points_;
  std::vector<std::uint32_t> slots_;
  std::size_t mask_ = 0;
};

}  // namespace softcell::ppu
