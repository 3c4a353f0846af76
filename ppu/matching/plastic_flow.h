#pragma once
// Plastic flow: a body that was deformed past its yield keeps a part of the deformation, as another rest shape.
//
// With x the positions, y the rest shape, d = y_b - y_a an edge along a lattice axis at rest and D = x_b - x_a the same
// edge now:
//
//     R_i                                 rotation of sum D d^T over the edges of particle i
//     eps = R^T D - d                     deformation without rotation, in the rest shape's frame; R halfway between the ends' R
//     w   = axis * angle of R_a^T R_b     how much the body is bent along the edge
//     eta = eps - tr / n  d               without the change of volume; tr is the sum of relative elongations over the n axes:
//                                         its own, and the means over its cells' edges along the others
//     e   = |eta| / |d| * n / (n - 1)     the strain. In a bar that is pulled, the elongation
//     g   = share (1 - yield / e)         0 below the yield. share = 1 - exp(-creep h)
//
// An edge flows by g eta. It also rotates, by the mean of g over the regions of its ends, weighted by e^2, to which the elastic energy is
// proportional. The rest shape's new edges are Q (d + g eta), minus any part that would change the volume of cells; Q is the rotation. No
// shape has exactly these edges; two systems of equations give the one whose edges are nearest in least squares:
//
//     omega_b - omega_a = g w            for every edge: the turn of each particle
//     u_b - u_a = Q (d + g eta) - d      for every edge: the displacement, y += u
//
// Both systems have the Laplacian of the edges as their matrix, which never changes. So a dent stays local, and everything beyond a bend
// rotates with it as a whole. Velocities and positions stay as they are; shape matching keeps both momenta for any rest shape.
//
// Why the rest shape as a whole, and not an affine deformation of each region (Mueller et al. 2005): bending is not an affine deformation
// of a region. When a plate of 5 particles bends, a quarter of the energy with which regions of 5 x 5 x 5 resist is affine; the other three
// quarters would spring back, and in thin plates all of it.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "ppu/matching/rest_lattice.h"
#include "ppu/matching/summation.h"
#include "softcell/soft_bodies/soft_body_settings.h"

namespace softcell::ppu {

/// The rest shape of one body. Used by one thread at a time.
template <int kDimension>
class PlasticFlow {
 public:
  using Exact = Eigen::Matrix<double, kDimension, 1>;
  using Vector = Eigen::Matrix<float, kDimension, 1>;

  /// @param rest  positions, metres, in any frame
  PlasticFlow(std::shared_ptr<const RestLattice<kDimension>> lattice, std::span<const Exact> rest);

  std::span<const Exact> rest() const { return rest_; }  ///< metres
  void set_rest(std::span<const Exact> rest);
  /// The number of cells of the rest shape with less volume than contacts allow. Contacts would push them back in each step, and a body
  /// that turns would turn faster and faster.
  std::size_t cells_that_contacts_hold() const;

  /// A quick check of the lengths of edges and diagonals. @return false: no strain is above `yield`
  bool may_yield(std::span<const Vector> x, float yield);
  /// The same from lengths that an SPE has checked: saves most quick checks.
  /// @param stretch  stretch_of() the SPE's result, exact to kSeenWithin
  /// @return what may_yield() would return; if that is false, the internal state is updated likewise. Nothing: the caller has to check the
  /// lengths itself
  std::optional<bool> may_yield(float stretch, float yield);
  /// The measure of strain in lengths, from the largest |now^2 / rest^2 - 1| of edges, and of diagonals.
  static float stretch_of(float edges, float diagonals);
  /// The SPE's rest shape is rounded, and so are its sums: by 1e-5 for bodies of a hundred cells.
  static constexpr float kSeenWithin = 0.002f;

  /// Moves the rest shape towards the body's present shape where the body has yielded. The total volume stays the same, and no cell of the
  /// rest shape gets a volume below kLeastRestVolume.
  /// @param x        positions, metres
  /// @param sums     of the body's regions
  /// @param share    0..1: how much of the strain above the yield flows
  /// @return         whether the rest shape has changed
  bool flow(std::span<const Vector> x, const SumPlan& sums, const Plasticity& plasticity, double share);

  /// Whether the last flow() takes elastic energy out of a body that has moved on to `x` (metres) meanwhile. A body that swings may have
  /// sprung back: then the rest shape would move away from it, and the body would gain energy from nothing.
  bool takes_energy(std::span<const Vector> x) const;
  /// Undoes the last flow(). @pre  it has changed the rest shape, and nothing has since
  void take_back();

  /// The least volume of a cell of the rest shape, in spacing^n: the volume that its mean edges span. A cell counts as crushed below 0.5
  /// (contacts/crushed_cells.h).
  static constexpr double kLeastRestVolume = 0.7;

 private:
  using Matrix = Eigen::Matrix<double, kDimension, kDimension>;
  static constexpr int kSpins = kDimension == 2 ? 1 : 3;  // numbers of an angle, or of axis times angle
  using Spin = Eigen::Matrix<double, kSpins, 1>;

  void find_inverse_squares();
  void find_rotations(std::span<const Vector> x);
  void find_strains(std::span<const Vector> x);
  /// The relative elongation of a cell along each axis if its edges get longer by `of_edge`.
  Exact elongations(const typename RestLattice<kDimension>::EdgesOfCell& edges,
                    const std::vector<Exact>& of_edge) const;
  void find_flow(const SumPlan& sums, const Plasticity& plasticity, double share);
  void keep_volume();
  std::vector<Exact> new_shape() const;
  bool stop_bad_cells(std::span<const Exact> shape);
  void find_along();

  std::shared_ptr<const RestLattice<kDimension>> lattice_;
  std::vector<Exact> rest_, rest_before_;  // before: the last flow
  std::vector<float> inverse_squares_,
      inverse_squares_before_;  // of lengths at rest, as RestLattice::each_length() visits them
  std::vector<Eigen::Quaterniond> rotations_;  // of each particle; in two dimensions about z
  // Of each edge.
  std::vector<Exact> d_, eta_, flow_;
  std::vector<Spin> bend_;
  std::vector<double> strain_, rate_, turn_;
  double largest_strain_ = 0;
  // Of the last flow: it takes energy if the sum of along_ . x is above least_along_.
  std::vector<Exact> along_;  // of each particle
  double least_along_ = 0;
  double volume_ = 0;  // of the rest shape, spacing^n
  // stretch_: how much lengths differed at the last quick check. calm_: up to this difference, a body that did not yield is not checked
  // closely again, until the difference is much less.
  float stretch_ = 0, calm_ = 0;
  static constexpr float kForget = 0.8f;
};

extern template class PlasticFlow<2>;
extern template class PlasticFlow<3>;

}  // namespace softcell::ppu
