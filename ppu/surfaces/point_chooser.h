#pragma once
// Chooses points of a surface that keep a distance from each other.

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace softcell::ppu {

/// A grid index as one number, a key for tables.
inline std::uint64_t key_of(const Eigen::Vector3i& index) {
  constexpr int kOffset = 1 << 20;
  const auto part = [](int i) { return static_cast<std::uint64_t>(i + kOffset); };
  return part(index.x()) << 42 | part(index.y()) << 21 | part(index.z());
}

/// Chooses the points at which a surface touches other things: closer together where the surface bends. Used by one thread.
class PointChooser {
 public:
  // In cells.
  static constexpr float kPointSpacing = 0.45f;  ///< between points of a smooth surface
  static constexpr float kSamePoint = 0.1f;      ///< points nearer than this are one, whatever their normals
  /// Where the surface bends: how far a point may stand out beyond one that is already chosen. It is half of their distance times the angle
  /// between their normals.
  static constexpr float kBulge = 0.06f;

  explicit PointChooser(float spacing) : spacing_(spacing) {}

  /// @param normal  of unit length; zero: the point belongs to no surface that others belong to
  /// @return  whether the point is far enough from all that were chosen before
  bool choose(const Eigen::Vector3f& point, const Eigen::Vector3f& normal) {
    const Eigen::Vector3i cube = (point / (kPointSpacing * spacing_)).array().floor().cast<int>();
    for (int i = 0; i < 27; ++i) {
      const auto found = chosen_.find(key_of(cube + Eigen::Vector3i(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1)));
      if (found == chosen_.end()) continue;
      for (const Chosen& other : found->second)
        if (is_near(other, point, normal)) return false;
    }
    chosen_[key_of(cube)].push_back({point, normal});
    return true;
  }

 private:
  struct Chosen {
    Eigen::Vector3f point, normal;
  };
  bool is_near(const Chosen& other, const Eigen::Vector3f& point, const Eigen::Vector3f& normal) const {
    const float apart = (other.point - point).norm() / spacing_;
    if (apart < kSamePoint || apart >= kPointSpacing) return apart < kSamePoint;
    const bool of_a_surface = !normal.isZero(0) && !other.normal.isZero(0);
    return of_a_surface && apart * (other.normal - normal).norm() < 2 * kBulge;
  }

  float spacing_;
  std::unordered_map<std::uint64_t, std::vector<Chosen>> chosen_;
};

}  // namespace softcell::ppu
