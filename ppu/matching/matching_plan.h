#pragma once
// The constants of shape matching in two and three dimensions: particles and regions of a body at rest. Letters as in shape_matching.h.

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "ppu/matching/summation.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// Constants of particles and regions at rest. All bodies of one model share a plan; a plastic body has a copy with its own rest shape.
/// Copies share the parts that do not depend on the rest shape.
/// @tparam kDimension  2 or 3
template <typename Real, int kDimension>
class MatchingPlan {
 public:
  using Vector = Eigen::Matrix<Real, kDimension, 1>;

  /// @param half_width  w, 0..kMaxHalfWidth; 1 to 4 are useful.
  /// @param masses      kg, one per particle, positive and finite. Scaling all of them changes no result.
  /// @throws std::invalid_argument  masses not as stated.
  /// @throws std::runtime_error     as find_regions().
  MatchingPlan(const Lattice<kDimension>& lattice, int half_width, std::span<const float> masses);

  std::size_t particles() const { return particles_.size(); }
  std::size_t regions() const { return regions_.size(); }  ///< distinct ones; see SumPlan
  int half_width() const { return half_width_; }
  Real spacing() const { return spacing_; }  ///< metres
  const SumPlan& sums() const { return *sums_; }
  /// Centre of mass at rest, in the lattice's frame.
  const Vector& rest_centre() const { return rest_centre_; }

  struct Particle {
    Vector x0;                  ///< rest position relative to rest_centre()
    Real modified_mass;         ///< m~, kg
    Real inverse_region_count;  ///< 1 / |R_i|
    Real mass;                  ///< kg
  };
  struct Region {
    Vector c0;          ///< rest centre relative to rest_centre()
    Real mass;          ///< M_r = sum of m~, kg
    Real inverse_mass;  ///< 1 / M_r
  };
  std::span<const Particle> particle_constants() const { return particles_; }
  std::span<const Region> region_constants() const { return regions_; }

  /// Sets another rest shape for the same particles: changes x0 and c0.
  /// @param rest  finite positions, metres, in any frame
  void set_rest(std::span<const Eigen::Matrix<double, kDimension, 1>> rest);

  /// Below this times M_r, the matrix from which a region's rotation is found is rounding noise: all the region's particles are at one
  /// point. Square metres.
  Real noise_floor() const { return noise_floor_; }

 private:
  std::shared_ptr<const SumPlan> sums_;
  int half_width_;
  Real spacing_;
  Vector rest_centre_;
  Real noise_floor_;
  std::vector<Particle> particles_;
  std::vector<Region> regions_;
};

extern template class MatchingPlan<float, 2>;
extern template class MatchingPlan<double, 2>;
extern template class MatchingPlan<float, 3>;
extern template class MatchingPlan<double, 3>;

}  // namespace softcell::ppu
