#pragma once
// Collects the sides of triangles and tells which of them lie flat within a surface.
//
//      ______              ______
//     |    / |            |    / |      the diagonal of a square lies in its plane: nothing can catch on it.
//     |  /   |            |  / __|__    A side of only one triangle, or of three, stands out.
//     |/_____|            |/___|___/

#include <Eigen/Core>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "ppu/obstacles/exact_point.h"

namespace softcell::ppu {

/// A hash table of sides. Allocates only when there are more of them than ever before.
class EdgeSet {
 public:
  /// Empties the set. @param sides  number of sides: three for each triangle
  void begin(std::size_t sides) {
    found_.clear();
    is_flat_.assign(sides, false);
  }

  /// Adds the sides 3 t, 3 t + 1, 3 t + 2 of triangle t: from corner 0 to 1, to 2, to 0. @pre  begin() has counted them
  void add(std::size_t t, const std::array<Eigen::Vector3f, 3>& triangle) {
    if (found_.empty()) make_slots();
    const Eigen::Vector3f normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
    for (std::size_t i = 0; i < 3; ++i)
      add_side(static_cast<std::uint32_t>(3 * t + i), exact_point(triangle[i]),
               exact_point(triangle[(i + 1) % 3]), normal);
  }

  /// Whether a side belongs to exactly two triangles, wound alike, whose planes are_nearly_parallel().
  bool is_flat(std::size_t side) const { return is_flat_[side]; }

 private:
  static constexpr std::uint32_t kNone = ~0u;
  struct Found {
    ExactPoint low, high;
    Eigen::Vector3f normal;  // of the first triangle
    std::uint32_t first, second;
    bool runs_up;  // the first triangle's side runs from low to high
  };

  /// Called when the first triangle is added, since often there is none.
  void make_slots() {
    found_.reserve(is_flat_.size());
    const std::size_t slots = std::bit_ceil(2 * is_flat_.size() + 1);
    mask_ = slots - 1;
    slots_.assign(slots, kNone);
  }

  void add_side(std::uint32_t side, ExactPoint from, ExactPoint to, const Eigen::Vector3f& normal) {
    const bool runs_up = from < to;
    if (!runs_up) std::swap(from, to);
    const std::uint64_t hash = hash_of(from) + 3 * hash_of(to);
    for (std::size_t slot = static_cast<std::size_t>(hash ^ hash >> 32) & mask_;; slot = (slot + 1) & mask_) {
      if (slots_[slot] == kNone) {
        slots_[slot] = static_cast<std::uint32_t>(found_.size());
        found_.push_back({from, to, normal, side, kNone, runs_up});
        return;
      }
      Found& found = found_[slots_[slot]];
      if (found.low != from || found.high != to) continue;
      const bool is_second = found.second == kNone;
      if (is_second) found.second = side;
      const bool flat = is_second && found.runs_up != runs_up && are_nearly_parallel(found.normal, normal);
      is_flat_[found.first] = is_flat_[found.second] = flat;
      return;
    }
  }

  std::vector<Found> found_;
  std::vector<bool> is_flat_;  // of each side
  std::vector<std::uint32_t> slots_;
  std::size_t mask_ = 0;
};

}  // namespace softcell::ppu
