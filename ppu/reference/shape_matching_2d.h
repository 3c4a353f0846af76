#pragma once
// Lattice shape matching in two dimensions. As shape_matching.h, but a rotation is one angle and has a closed
// form, so that two of the four sums of a region's matrix are enough:
//
//     C = sum m~ p.q   S = sum m~ q x p   (p = x - c, q = x0 - c0, a x b = ax by - ay bx)   (cos, sin) ~ (C,
//     S)
//
// which is the best rotation whatever the region's rank, mirrored or not. [LSM07]

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "ppu/matching/lanes.h"
#include "ppu/matching/matching_plan.h"
#include "ppu/matching/summation.h"
#include "ppu/reference/shape_matching.h"

namespace softcell::ppu {

/// The moving state of one body, as ShapeMatcher.
template <typename Real>
class ShapeMatcher2d {
 public:
  using Vector = Eigen::Matrix<Real, 2, 1>;

  /// cos and sin of a region's angle: the direction in which its x axis points.
  using Direction = Vector;

  explicit ShapeMatcher2d(std::shared_ptr<const MatchingPlan2d<Real>> plan,
                          SumMethod method = SumMethod::kBarPlateCube);

  /// As ShapeMatcher's.
  void goals(std::span<const Vector> x, std::span<Vector> g);
  void step_velocities(std::span<const Vector> x, std::span<Vector> v, Real alpha, Real h, Real damping);
  void reset();

  /// One for each distinct region: that of particle i is directions()[plan().sums().region_of()[i]].
  std::span<const Direction> directions() const { return directions_; }
  const MatchingPlan2d<Real>& plan() const { return *plan_; }

 private:
  using Payload = Lanes<Real, 4>;

  void match(std::span<const Vector> x);
  void damp(std::span<Vector> v, Real damping);
  void up();
  void down();

  std::shared_ptr<const MatchingPlan2d<Real>> plan_;
  SumMethod method_;
  std::vector<Direction> directions_;
  std::vector<Vector> x_;      // of each particle: position relative to a point in the body
  std::vector<Vector> pulls_;  // g_i - x_i
  std::vector<Vector> centres_;
  std::vector<Payload> of_particles_, of_regions_, totals_;
  SumScratch<Payload> scratch_;
};

extern template class ShapeMatcher2d<float>;
extern template class ShapeMatcher2d<double>;

}  // namespace softcell::ppu
