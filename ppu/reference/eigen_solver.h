#pragma once
// Shape matching and damping as one writes it with Eigen: bars, plates and regions, vectors and small
// matrices, nothing laid out by hand. What the kernels are measured against.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <span>
#include <vector>

#include "ppu/matching/matching_plan.h"
#include "ppu/matching/summation.h"

namespace softcell::ppu {

/// What differs between two and three dimensions.
template <int Dimension>
struct EigenTypes;
template <>
struct EigenTypes<2> {
  using Spin = float;          ///< an angular velocity or momentum
  using SecondMoment = float;  ///< m~ |x|^2
  struct Attitude {};          ///< no start is needed to find a rotation
};
template <>
struct EigenTypes<3> {
  using Spin = Eigen::Vector3f;
  using SecondMoment = Eigen::Matrix3f;  ///< m~ x x^T
  using Attitude = Eigen::Quaternionf;   ///< of the step before
};

/// One body. The same sums, plans and rotations as ShapeMatcher<float, Dimension>.
template <int Dimension>
class EigenSolver {
 public:
  using Types = EigenTypes<Dimension>;
  using Vector = Eigen::Matrix<float, Dimension, 1>;
  using Matrix = Eigen::Matrix<float, Dimension, Dimension>;

  explicit EigenSolver(std::shared_ptr<const MatchingPlan<float, Dimension>> plan);

  /// v += alpha (g - x) / h, then damping. @pre  one element per particle.
  void step(std::span<const Vector> x, std::span<Vector> v, float alpha, float h, float damping);

 private:
  struct Moments {  // m~x, m~x x0^T
    Vector p;
    Matrix a;
    Moments& operator+=(const Moments& other);
  };
  struct Momenta {  // m~v, x × m~v
    Vector p;
    typename Types::Spin l;
    typename Types::SecondMoment q;
    Momenta& operator+=(const Momenta& other);
  };
  struct Motion {  // t, R
    Vector t;
    Matrix r;
    Motion& operator+=(const Motion& other);
  };
  struct Twist {  // b, omega
    Vector b;
    typename Types::Spin omega;
    Twist& operator+=(const Twist& other);
  };

  void match(std::span<const Vector> x, std::span<Vector> v, float rate);
  void damp(std::span<const Vector> x, std::span<Vector> v, float damping);

  std::shared_ptr<const MatchingPlan<float, Dimension>> plan_;
  std::vector<Moments> particle_moments_, region_moments_;
  std::vector<Momenta> particle_momenta_, region_momenta_;
  std::vector<Motion> motions_, motion_totals_;
  std::vector<Twist> twists_, twist_totals_;
  std::vector<Vector> centres_;
  std::vector<typename Types::Attitude> attitudes_;
  SumScratch<Moments> moments_scratch_;
  SumScratch<Momenta> momenta_scratch_;
  SumScratch<Motion> motion_scratch_;
  SumScratch<Twist> twist_scratch_;
};

extern template class EigenSolver<2>;
extern template class EigenSolver<3>;

}  // namespace softcell::ppu
