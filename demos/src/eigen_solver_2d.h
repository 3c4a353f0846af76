#pragma once
// Shape matching and damping in two dimensions as one writes it with Eigen: bars and regions, vectors and
// plain structs, nothing laid out by hand. What the kernel is measured against.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <span>
#include <vector>

#include "softcell/ppu/shape_matching_2d.h"
#include "softcell/ppu/summation.h"

namespace softcell::demos {

/// One body. The same sums and plans as ppu::ShapeMatcher2d<float>.
class EigenSolver2d {
 public:
  explicit EigenSolver2d(std::shared_ptr<const ppu::MatchingPlan2d<float>> plan);

  /// v += alpha (g - x) / h, then damping. @pre  one element per particle.
  void step(std::span<const Eigen::Vector2f> x, std::span<Eigen::Vector2f> v, float alpha, float h,
            float damping);

 private:
  struct Moments {  // m~x, m~x x0^T
    Eigen::Vector2f p;
    Eigen::Matrix2f a;
    Moments& operator+=(const Moments& other);
  };
  struct Momenta {  // m~v, x × m~v, m~ |x|^2
    Eigen::Vector2f p;
    float l, inertia;
    Momenta& operator+=(const Momenta& other);
  };
  struct Motion {  // t, R
    Eigen::Vector2f t;
    Eigen::Matrix2f r;
    Motion& operator+=(const Motion& other);
  };
  struct Twist {  // b, omega
    Eigen::Vector2f b;
    float omega;
    Twist& operator+=(const Twist& other);
  };

  void match(std::span<const Eigen::Vector2f> x, std::span<Eigen::Vector2f> v, float rate);
  void damp(std::span<const Eigen::Vector2f> x, std::span<Eigen::Vector2f> v, float damping);

  std::shared_ptr<const ppu::MatchingPlan2d<float>> plan_;
  std::vector<Moments> particle_moments_, region_moments_;
  std::vector<Momenta> particle_momenta_, region_momenta_;
  std::vector<Motion> motions_, motion_totals_;
  std::vector<Twist> twists_, twist_totals_;
  std::vector<Eigen::Vector2f> centres_;
  ppu::SumScratch<Moments> moments_scratch_;
  ppu::SumScratch<Momenta> momenta_scratch_;
  ppu::SumScratch<Motion> motion_scratch_;
  ppu::SumScratch<Twist> twist_scratch_;
};

}  // namespace softcell::demos
