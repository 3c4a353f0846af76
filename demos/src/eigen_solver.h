#pragma once
// Shape matching and damping as one writes it with Eigen: bars, plates and regions, vectors and 3x3 matrices,
// nothing laid out by hand. What the kernel is measured against.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <span>
#include <vector>

#include "softcell/ppu/shape_matching.h"
#include "softcell/ppu/summation.h"

namespace softcell::demos {

/// One body. The same sums, plans and rotations as ppu::ShapeMatcher<float>.
class EigenSolver {
 public:
  explicit EigenSolver(std::shared_ptr<const ppu::MatchingPlan<float>> plan);

  /// v += alpha (g - x) / h, then damping. @pre  one element per particle.
  void step(std::span<const Eigen::Vector3f> x, std::span<Eigen::Vector3f> v, float alpha, float h,
            float damping);

 private:
  struct Moments {  // m~x, m~x x0^T
    Eigen::Vector3f p;
    Eigen::Matrix3f a;
    Moments& operator+=(const Moments& other);
  };
  struct Momenta {  // m~v, x × m~v, m~x x^T
    Eigen::Vector3f p, l;
    Eigen::Matrix3f q;
    Momenta& operator+=(const Momenta& other);
  };
  struct Motion {  // t, R
    Eigen::Vector3f t;
    Eigen::Matrix3f r;
    Motion& operator+=(const Motion& other);
  };
  struct Twist {  // b, omega
    Eigen::Vector3f b, omega;
    Twist& operator+=(const Twist& other);
  };

  void match(std::span<const Eigen::Vector3f> x, std::span<Eigen::Vector3f> v, float rate);
  void damp(std::span<const Eigen::Vector3f> x, std::span<Eigen::Vector3f> v, float damping);

  std::shared_ptr<const ppu::MatchingPlan<float>> plan_;
  std::vector<Moments> particle_moments_, region_moments_;
  std::vector<Momenta> particle_momenta_, region_momenta_;
  std::vector<Motion> motions_, motion_totals_;
  std::vector<Twist> twists_, twist_totals_;
  std::vector<Eigen::Vector3f> centres_;
  std::vector<Eigen::Quaternionf> rotations_;
  ppu::SumScratch<Moments> moments_scratch_;
  ppu::SumScratch<Momenta> momenta_scratch_;
  ppu::SumScratch<Motion> motion_scratch_;
  ppu::SumScratch<Twist> twist_scratch_;
};

}  // namespace softcell::demos
