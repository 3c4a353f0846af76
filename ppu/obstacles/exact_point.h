#pragma once
// Compares points exactly and planes approximately, to find the corners and edges that triangles share.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <bit>
#include <cstdint>

namespace softcell::ppu {

using ExactPoint = std::array<float, 3>;

inline ExactPoint exact_point(const Eigen::Vector3f& p) { return {p.x(), p.y(), p.z()}; }

inline std::uint64_t hash_of(const ExactPoint& point) {
  std::uint64_t hash = 0;
  // -0 + 0 is 0, so points that compare equal have the same hash.
  for (const float x : point) {
    hash = (hash ^ std::bit_cast<std::uint32_t>(x + 0.0f)) * 0x9E3779B97F4A7C15u;  // 2^64 by the golden ratio
    hash ^= hash >> 32;
  }
  return hash;
}

/// Whether the planes of two triangles bend by at most a twentieth of a radian: between two points of a body, half a cell apart, they then
/// stand out by less than a hundredth of a cell.
/// @param a, b  normals of any length; false if one of them is zero or not finite
inline bool are_nearly_parallel(const Eigen::Vector3f& a, const Eigen::Vector3f& b) {
  constexpr float kTangent = 0.05f;
  const float along = a.dot(b);
  return along > 0 && a.cross(b).squaredNorm() <= kTangent * kTangent * along * along;
}

}  // namespace softcell::ppu
