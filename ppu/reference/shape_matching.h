#pragma once
// Lattice shape matching: every region finds its best rigid motion, every particle is pulled towards the mean
// of where its regions would have it. In two dimensions and in three; what differs is in rigid_motion.h.
//
//     x     -- m~x, m~x x0^T ---------> [sum up] --> c_r, A_r --> R_r, t_r --> [sum down] --> g_i
//     x, v  -- m~v, x × m~v, m~x x^T -> [sum up] --> v_r, omega_r -----------> [sum down] --> dv_i
//
//     v_i += alpha (g_i - x_i) / h,  then v_i += k dv_i
//
// Letters as in [LSM07]: m~_i = m_i / |R_i| modified mass, |R_i| number of regions that hold particle i, M_r
// and c0_r mass and rest centre of region r. Velocities change, positions never: contacts of the engine stay
// intact.

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "ppu/matching/matching_plan.h"
#include "ppu/matching/summation.h"
#include "ppu/reference/rigid_motion.h"

namespace softcell::ppu {

/// Both give the same bits. Naive sums are the reference: (2w+1)^3 additions per particle and quantity.
enum class SumMethod { kNaive, kBarPlateCube };

/// The moving state of one body: the rotation of each region, and scratch memory. Copy it to save and
/// restore. Allocates nothing after construction. Not thread safe: one thread at a time for one matcher;
/// matchers of the same plan are independent.
///
/// Every call sums positions (and velocities) first: a NaN or infinity among them is reported before anything
/// changes.
///
/// Goals in float differ from those in double by at most 2e-5 of a cell for a body 50 cells long and 6e-4 for
/// one of 200 cells (measured in three dimensions, w = 2), as long as positions themselves are that fine so
/// far from the world's origin.
/// @tparam Real        float or double
/// @tparam kDimension  2 or 3
template <typename Real, int kDimension>
class ShapeMatcher {
 public:
  using Vector = Eigen::Matrix<Real, kDimension, 1>;
  /// A unit quaternion; in two dimensions cos and sin of an angle.
  using Rotation = typename RigidMotion<Real, kDimension>::Rotation;

  explicit ShapeMatcher(std::shared_ptr<const MatchingPlan<Real, kDimension>> plan,
                        SumMethod method = SumMethod::kBarPlateCube);

  /// The goal position of each particle.
  /// @param x  positions, metres    @param g  out: goals, metres; may be the same memory as x
  /// @throws std::invalid_argument  a span is not one element per particle.
  /// @throws std::runtime_error     a position is NaN or infinite; the sentence names the particle.
  void goals(std::span<const Vector> x, std::span<Vector> g);

  /// One step's change of velocity: the pull towards the goals, then damping of what is not rigid motion of a
  /// region. Call it once per time step of the engine, before it integrates, with that step's `h`.
  /// @param x        positions, metres
  /// @param v        velocities, m/s, changed in place
  /// @param alpha    0..1: the share of the way to the goal that one step makes up for
  /// @param h        time step, seconds, positive and finite
  /// @param damping  k, 0..1: the share of the deviation from rigid motion that one step takes away
  /// @throws  as goals(); std::invalid_argument also for alpha, h, damping outside their ranges. Nothing has
  ///          changed then.
  void step_velocities(std::span<const Vector> x, std::span<Vector> v, Real alpha, Real h, Real damping);

  /// Forgets the rotations: after a teleport, or when the body is put back to rest. The next step starts
  /// cold.
  void reset();

  /// Takes the rotations of another body that this one was a part of.
  /// @param particle_of  of each particle: which one of the whole it was
  void take_rotations(const ShapeMatcher& whole, std::span<const std::uint32_t> particle_of);

  /// One for each distinct region: that of particle i is rotations()[plan().sums().region_of()[i]]. A region
  /// that has none of its own, all its particles on one point, keeps that of the step before.
  std::span<const Rotation> rotations() const { return rotations_; }

  const MatchingPlan<Real, kDimension>& plan() const { return *plan_; }

  /// Uses the constants of another rest shape from the next step on; rotations stay.
  /// @pre the plan has as many particles and regions as the present one
  void set_plan(std::shared_ptr<const MatchingPlan<Real, kDimension>> plan);

 private:
  using Rigid = RigidMotion<Real, kDimension>;
  using Moments = typename Rigid::Moments;
  using Motion = typename Rigid::Motion;
  using Twist = typename Rigid::Twist;

  void match(std::span<const Vector> x);
  void damp(std::span<Vector> v, Real damping);
  void up();
  template <typename Payload>
  void down(const std::vector<Payload>& values, SumScratch<Payload>& scratch, std::vector<Payload>& totals);

  std::shared_ptr<const MatchingPlan<Real, kDimension>> plan_;
  SumMethod method_;
  bool cold_ = true;  // rotations_ say nothing about the body yet
  std::vector<Rotation> rotations_;
  std::vector<Vector> x_;        // of each particle: position relative to a point in the body
  std::vector<Vector> pulls_;    // g_i - x_i
  std::vector<Vector> centres_;  // c_r of each region, relative to the same point
  std::vector<Moments> particle_moments_, region_moments_;
  std::vector<Motion> motions_, motion_totals_;
  std::vector<Twist> twists_, twist_totals_;
  SumScratch<Motion> motion_scratch_;  // moments are as large
  SumScratch<Twist> twist_scratch_;
};

extern template class ShapeMatcher<float, 2>;
extern template class ShapeMatcher<double, 2>;
extern template class ShapeMatcher<float, 3>;
extern template class ShapeMatcher<double, 3>;

}  // namespace softcell::ppu
