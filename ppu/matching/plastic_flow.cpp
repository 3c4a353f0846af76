#include "ppu/matching/plastic_flow.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "ppu/matching/rotation.h"
#include "ppu/numbers/deterministic_math.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Matrix2d;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector2d;
using Eigen::Vector3d;

// Rotations are quaternions in both dimensions; in two dimensions about z.

/// @param by  of any length but 0
Vector3d turned(const Quaterniond& by, const Vector3d& v) {
  const Vector3d across = by.vec().cross(v);
  return v + 2 / by.squaredNorm() * (by.w() * across + by.vec().cross(across));
}
Vector2d turned(const Quaterniond& by, const Vector2d& v) {
  return turned(by, Vector3d(v.x(), v.y(), 0)).head<2>();
}

/// @param start  a rotation nearby
Quaterniond rotation_of(const Matrix2d& matrix, const Quaterniond& start) {
  const double cosine = matrix.trace(), sine = matrix(1, 0) - matrix(0, 1);
  const double length = std::sqrt(cosine * cosine + sine * sine);
  if (!(length > 0)) return start;
  const Quaterniond q(length + cosine, 0, 0, sine);  // for half the angle
  return q.norm() > 1e-9 * length ? q.normalized() : Quaterniond(0, 0, 0, 1);
}
/// Exact to about 1e-6, far below any yield.
Quaterniond rotation_of(const Matrix3d& matrix, const Quaterniond& start) {
  Eigen::Quaternionf rotation = start.cast<float>();
  update_rotation<float>(matrix.cast<float>(), rotation);
  return rotation.cast<double>().normalized();
}

double smaller_turn(const Quaterniond& a, const Quaterniond& b) { return a.dot(b) < 0 ? -1 : 1; }

/// Not of unit length.
Quaterniond halfway(const Quaterniond& a, const Quaterniond& b) {
  return Quaterniond(a.coeffs() + smaller_turn(a, b) * b.coeffs());
}

/// Rotation from a to b in a's frame, as axis times angle. The angle is replaced by 4 sin(angle / 4), which is less than 1 % smaller up to
/// 1 rad.
Vector3d spin_between(const Quaterniond& a, const Quaterniond& b) {
  const Quaterniond turn = halfway(Quaterniond::Identity(), a.conjugate() * b);
  return 4 / turn.norm() * turn.vec();
}

/// @param spin  axis times angle, radians
Quaterniond rotation_by(const Vector3d& spin) {
  const double angle = std::min(spin.norm(), kMaxSineAngle);
  if (!(angle > 0)) return Quaterniond::Identity();
  const Vector3d vec = sine(angle / 2) / angle * spin;
  return Quaterniond(cosine(angle / 2), vec.x(), vec.y(), vec.z());
}

Eigen::Matrix<double, 1, 1> own_spin(const Vector3d& spin, const Vector2d&) {
  return Eigen::Matrix<double, 1, 1>(spin.z());
}
Vector3d own_spin(const Vector3d& spin, const Vector3d&) { return spin; }

/// The sums of e^2 and g e^2 over the edges of particles.
struct Weighted {
  double weight = 0, flowing = 0;
  Weighted& operator+=(const Weighted& other) {
    weight += other.weight, flowing += other.flowing;
    return *this;
  }
};

/// The means of a cell's edges along each axis, as columns; metres.
template <int kDimension>
Eigen::Matrix<double, kDimension, kDimension> mean_edges(
    const RestLattice<kDimension>& lattice, std::size_t cell,
    std::span<const Eigen::Matrix<double, kDimension, 1>> x) {
  const auto& corners = lattice.corners()[cell];
  Eigen::Matrix<double, kDimension, kDimension> means;
  means.setZero();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    for (int axis = 0; axis < kDimension; ++axis) {
      if ((k >> axis & 1u) != 0)
        means.col(axis) += x[corners[k]];
      else
        means.col(axis) -= x[corners[k]];
    }
  }
  return means / static_cast<double>(corners.size() / 2);
}

/// The volume of a cell in spacing^n.
template <int kDimension>
double volume_of(const RestLattice<kDimension>& lattice, std::size_t cell,
                 std::span<const Eigen::Matrix<double, kDimension, 1>> x) {
  return (mean_edges(lattice, cell, x) / lattice.spacing()).determinant();
}

}  // namespace

template <int kDimension>
PlasticFlow<kDimension>::PlasticFlow(std::shared_ptr<const RestLattice<kDimension>> lattice,
                                     std::span<const Exact> rest)
    : lattice_((SC_ASSERT(lattice != nullptr, "plastic flow without a lattice"), std::move(lattice))),
      rotations_(lattice_->particles(), Quaterniond::Identity()) {
  set_rest(rest);
  const std::size_t edges = lattice_->edges().size();
  d_.resize(edges), eta_.resize(edges), flow_.resize(edges), bend_.resize(edges);
  strain_.resize(edges), rate_.resize(edges), turn_.resize(edges);
}

template <int kDimension>
std::size_t PlasticFlow<kDimension>::cells_that_contacts_hold() const {
  // In spacing^n: kLeastVolume of contacts/crushed_cells.h, less the rounding of floats.
  constexpr double kHeld = 0.5 - 1e-6;
  std::size_t held = 0;
  for (std::size_t cell = 0; cell < lattice_->corners().size(); ++cell)
    if (!(volume_of<kDimension>(*lattice_, cell, rest_) >= kHeld)) ++held;
  return held;
}

/// Also forgets up to which difference no close check is needed.
template <int kDimension>
void PlasticFlow<kDimension>::set_rest(std::span<const Exact> rest) {
  SC_ASSERT(rest.size() == lattice_->particles(), "{} positions at rest of {} particles", rest.size(),
            lattice_->particles());
  rest_.assign(rest.begin(), rest.end());
  calm_ = 0;
  find_inverse_squares();
}

template <int kDimension>
void PlasticFlow<kDimension>::find_inverse_squares() {
  inverse_squares_.clear();
  lattice_->each_length([&](std::uint32_t a, std::uint32_t b) {
    inverse_squares_.push_back(static_cast<float>(1 / (rest_[b] - rest_[a]).squaredNorm()));
  });
}

/// At the yield, an edge is longer or shorter by at least 0.67 of the yield if the volume stays the same, and a diagonal by 0.44 if a
/// square is sheared. The square of a length changes by twice as much.
template <int kDimension>
float PlasticFlow<kDimension>::stretch_of(float edges, float diagonals) {
  return std::max(edges / 1.2f, diagonals / 0.8f);
}

template <int kDimension>
bool PlasticFlow<kDimension>::may_yield(std::span<const Vector> x, float yield) {
  SC_ASSERT(x.size() == rest_.size(), "{} positions of {} particles", x.size(), rest_.size());
  float edges = 0, diagonals = 0;
  std::size_t n = 0;
  lattice_->each_length([&](std::uint32_t a, std::uint32_t b) {
    float& largest = n < lattice_->edges().size() ? edges : diagonals;
    largest = std::max(largest, std::abs((x[b] - x[a]).squaredNorm() * inverse_squares_[n++] - 1));
  });
  stretch_ = stretch_of(edges, diagonals);
  if (stretch_ < kForget * calm_) calm_ = 0;
  return stretch_ > std::max(yield, calm_);
}

template <int kDimension>
std::optional<bool> PlasticFlow<kDimension>::may_yield(float stretch, float yield) {
  const float most = stretch + kSeenWithin, least = stretch - kSeenWithin;
  if (least > std::max(yield, calm_)) return true;
  const bool forgets = most < kForget * calm_;
  if (!forgets && calm_ > 0 && least < kForget * calm_) return std::nullopt;
  if (!(most < (forgets ? yield : std::max(yield, calm_)))) return std::nullopt;
  if (forgets) calm_ = 0;
  return false;
}

template <int kDimension>
void PlasticFlow<kDimension>::find_rotations(std::span<const Vector> x) {
  std::vector<Matrix> sums(x.size(), Matrix::Zero());
  for (std::size_t l = 0; l < d_.size(); ++l) {
    const auto& edge = lattice_->edges()[l];
    d_[l] = rest_[edge.to] - rest_[edge.from];
    const Matrix product = (x[edge.to] - x[edge.from]).template cast<double>() * d_[l].transpose();
    sums[edge.from] += product;
    sums[edge.to] += product;
  }
  // The neighbour's rotation is a good start, and does not depend on earlier steps.
  Quaterniond start = Quaterniond::Identity();
  for (std::size_t i = 0; i < sums.size(); ++i) start = rotations_[i] = rotation_of(sums[i], start);
}

template <int kDimension>
auto PlasticFlow<kDimension>::elongations(const typename RestLattice<kDimension>::EdgesOfCell& edges,
                                          const std::vector<Exact>& of_edge) const -> Exact {
  Exact sums = Exact::Zero();
  for (std::size_t axis = 0; axis < edges.size(); ++axis)
    for (const std::uint32_t l : edges[axis])
      sums[static_cast<int>(axis)] += of_edge[l].dot(d_[l]) / d_[l].squaredNorm();
  return sums / static_cast<double>(edges[0].size());
}

template <int kDimension>
void PlasticFlow<kDimension>::find_strains(std::span<const Vector> x) {
  SC_ASSERT(rest_.size() == x.size(), "{} positions, {} at rest", x.size(), rest_.size());
  for (std::size_t l = 0; l < d_.size(); ++l) {
    const auto& edge = lattice_->edges()[l];
    const Quaterniond &a = rotations_[edge.from], &b = rotations_[edge.to];
    const Exact now = (x[edge.to] - x[edge.from]).template cast<double>();
    eta_[l] = turned(halfway(a, b).conjugate(), now) - d_[l];
    bend_[l] = own_spin(spin_between(a, b), now);
  }
  std::vector<double> trace(d_.size(), 0.0);
  const auto cells = lattice_->edges_of_cell();
  for (const auto& edges : cells) {
    const Exact along = elongations(edges, eta_);
    for (std::size_t axis = 0; axis < edges.size(); ++axis) {
      const double of_others = along.sum() - along[static_cast<int>(axis)];
      for (const std::uint32_t l : edges[axis]) trace[l] += lattice_->inverse_cells()[l] * of_others;
    }
  }
  constexpr double kOfVolume = 1.0 / kDimension;
  largest_strain_ = 0;
  for (std::size_t l = 0; l < d_.size(); ++l) {
    trace[l] += eta_[l].dot(d_[l]) / d_[l].squaredNorm();
    eta_[l] -= kOfVolume * trace[l] * d_[l];
    strain_[l] = std::sqrt(eta_[l].squaredNorm() / d_[l].squaredNorm()) / (1 - kOfVolume);
    largest_strain_ = std::max(largest_strain_, strain_[l]);
  }
}

/// Computes how far each edge flows and rotates.
template <int kDimension>
void PlasticFlow<kDimension>::find_flow(const SumPlan& sums, const Plasticity& plasticity, double share) {
  const double yield = static_cast<double>(plasticity.yield);
  const double longest = lattice_->spacing() * (1 + static_cast<double>(plasticity.limit));
  const double shortest = lattice_->spacing() / (1 + static_cast<double>(plasticity.limit));
  std::vector<double> part(d_.size());  // share of the flow up to the limit
  for (std::size_t l = 0; l < d_.size(); ++l) {
    rate_[l] = strain_[l] > yield ? share * (1 - yield / strain_[l]) : 0;
    flow_[l] = rate_[l] * eta_[l];
    const double before = d_[l].norm(), after = (d_[l] + flow_[l]).norm();
    part[l] = 1;
    if (after > std::max(longest, before)) part[l] = std::max(0.0, (longest - before) / (after - before));
    if (after < std::min(shortest, before)) part[l] = std::max(0.0, (before - shortest) / (before - after));
  }
  // The edges of a cell stop together: if only one stopped, the volume would lose what the others need.
  std::vector<double> least(d_.size(), 1.0);
  for (const auto& edges : lattice_->edges_of_cell()) {
    double of_cell = 1;
    for (const auto& of_axis : edges)
      for (const std::uint32_t l : of_axis) of_cell = std::min(of_cell, part[l]);
    for (const auto& of_axis : edges)
      for (const std::uint32_t l : of_axis) least[l] = std::min(least[l], of_cell);
  }
  std::vector<Weighted> of_particle(lattice_->particles()), of_region(sums.regions());
  for (std::size_t l = 0; l < d_.size(); ++l) {
    rate_[l] *= least[l];
    flow_[l] *= least[l];
    const double square = strain_[l] * strain_[l];
    for (const std::uint32_t end : {lattice_->edges()[l].from, lattice_->edges()[l].to})
      of_particle[end] += {square, rate_[l] * square};
  }
  SumScratch<Weighted> scratch(sums);
  sum_up<Weighted>(sums, of_particle, scratch, of_region);
  const auto turning = [&](std::uint32_t particle) {
    const Weighted& sum = of_region[sums.region_of()[particle]];
    return sum.weight > 0 ? sum.flowing / sum.weight : 0;
  };
  for (std::size_t l = 0; l < d_.size(); ++l)
    turn_[l] = (turning(lattice_->edges()[l].from) + turning(lattice_->edges()[l].to)) / 2;
}

/// Subtracts from each edge's flow what would change the volume of its cells. Cells whose volume has changed before go back.
template <int kDimension>
void PlasticFlow<kDimension>::keep_volume() {
  constexpr double kBack = 0.5;
  std::vector<double> trace(d_.size(), 0.0);
  volume_ = 0;
  for (std::size_t cell = 0; cell < lattice_->corners().size(); ++cell) {
    const auto& edges = lattice_->edges_of_cell()[cell];
    const double volume = volume_of<kDimension>(*lattice_, cell, rest_);
    volume_ += volume;
    const double of_cell = elongations(edges, flow_).sum() + kBack * (volume - 1);
    for (const auto& of_axis : edges)
      for (const std::uint32_t l : of_axis) trace[l] += lattice_->inverse_cells()[l] * of_cell;
  }
  for (std::size_t l = 0; l < d_.size(); ++l) flow_[l] -= trace[l] / kDimension * d_[l];
}

/// The shape whose edges are nearest to the edges after the flow, scaled to the same volume.
template <int kDimension>
auto PlasticFlow<kDimension>::new_shape() const -> std::vector<Exact> {
  const auto edges = lattice_->edges();
  std::vector<Spin> turns;
  for (std::size_t l = 0; l < edges.size(); ++l) turns.push_back(turn_[l] * bend_[l]);
  std::vector<Quaterniond> rotations;  // of each particle of the rest shape
  for (const Spin& omega : lattice_->template integrate<kSpins>(turns)) {
    Vector3d spin(0, 0, 0);
    spin.template tail<kSpins>() = omega;
    rotations.push_back(rotation_by(spin));
  }
  std::vector<Exact> wanted;
  for (std::size_t l = 0; l < edges.size(); ++l)
    wanted.push_back(
        turned(halfway(rotations[edges[l].from], rotations[edges[l].to]), Exact(d_[l] + flow_[l])) - d_[l]);
  const std::vector<Exact> u = lattice_->template integrate<kDimension>(wanted);
  std::vector<Exact> shape = rest_;
  Exact centre = Exact::Zero();
  for (std::size_t i = 0; i < shape.size(); ++i) {
    shape[i] += u[i];
    centre += shape[i];
  }
  centre /= static_cast<double>(shape.size());

  double after = 0;
  for (std::size_t cell = 0; cell < lattice_->corners().size(); ++cell)
    after += volume_of<kDimension>(*lattice_, cell, shape);
  if (!(after > 0.5 * volume_)) return shape;  // its cells will be refused
  double scale = 1;                            // Newton's method for scale^n after = before
  for (int i = 0; i < 6; ++i) {
    const double power = kDimension == 2 ? scale : scale * scale;
    scale -= (power * scale - volume_ / after) / (kDimension * power);
  }
  for (Exact& point : shape) point = centre + scale * (point - centre);
  return shape;
}

/// Stops the flow of edges whose cells `shape` presses flat or turns inside out. @return whether there are any
template <int kDimension>
bool PlasticFlow<kDimension>::stop_bad_cells(std::span<const Exact> shape) {
  constexpr double kLeastAtCorner = 0.25;  // spacing^n
  const double least_at_corner = kLeastAtCorner * (kDimension == 2 ? 1 : lattice_->spacing()) *
                                 lattice_->spacing() * lattice_->spacing();
  bool any = false;
  for (std::size_t c = 0; c < lattice_->corners().size(); ++c) {
    const auto& edges = lattice_->edges_of_cell()[c];
    const auto& corners = lattice_->corners()[c];
    bool good = volume_of<kDimension>(*lattice_, c, shape) >= kLeastRestVolume;
    for (std::uint32_t k = 0; good && k < corners.size(); ++k) {
      Matrix at_corner;
      for (std::uint32_t axis = 0; axis < kDimension; ++axis) {
        const std::uint32_t bit = 1u << axis;
        at_corner.col(axis) = shape[corners[k | bit]] - shape[corners[k & ~bit]];
      }
      good = at_corner.determinant() >= least_at_corner;
    }
    if (good) continue;
    any = true;
    for (const auto& of_axis : edges)
      for (const std::uint32_t l : of_axis) flow_[l].setZero(), turn_[l] = 0;
  }
  return any;
}

/// With R the rotation of an edge when the body was seen, f its flow, d the edge at rest and D the edge now, s = R^T D - d is what
/// stretches it. Half the sum of s^2 stands for the energy; the flow makes it half the sum of (s - f)^2. It takes energy as long as
/// sum f . s is more than half of sum f^2. That it be all of it, so that the rest shape does not pass the present one, leaves something for
/// what this leaves out: how an edge has turned since, and what flows to keep the volume.
template <int kDimension>
void PlasticFlow<kDimension>::find_along() {
  along_.assign(rest_.size(), Exact::Zero());
  least_along_ = 0;
  for (std::size_t l = 0; l < d_.size(); ++l) {
    const auto& edge = lattice_->edges()[l];
    const Exact along = turned(halfway(rotations_[edge.from], rotations_[edge.to]), flow_[l]);
    along_[edge.to] += along;
    along_[edge.from] -= along;
    least_along_ += flow_[l].dot(d_[l]) + flow_[l].squaredNorm();
  }
}

template <int kDimension>
bool PlasticFlow<kDimension>::takes_energy(std::span<const Vector> x) const {
  SC_ASSERT(x.size() == along_.size(), "{} positions of {} particles that have flowed", x.size(),
            along_.size());
  double sum = 0;
  for (std::size_t i = 1; i < x.size(); ++i) sum += along_[i].dot((x[i] - x[0]).template cast<double>());
  return sum > least_along_;
}

template <int kDimension>
void PlasticFlow<kDimension>::take_back() {
  SC_ASSERT(rest_before_.size() == rest_.size(), "the flow has {} positions from before for {} particles",
            rest_before_.size(), rest_.size());
  rest_.swap(rest_before_);
  inverse_squares_.swap(inverse_squares_before_);
}

template <int kDimension>
bool PlasticFlow<kDimension>::flow(std::span<const Vector> x, const SumPlan& sums,
                                   const Plasticity& plasticity, double share) {
  SC_ASSERT(x.size() == rest_.size() && sums.particles() == x.size(),
            "{} positions and sums of {} for {} particles", x.size(), sums.particles(), rest_.size());
  SC_ASSERT(share >= 0 && share <= 1, "a share of {}", share);
  find_rotations(x);
  find_strains(x);
  // Not finite: left to shape matching, which reports it.
  if (!std::isfinite(largest_strain_)) return false;
  // A strain barely above the yield would flow for ever, less and less.
  constexpr double kHair = 1.002, kCautious = 0.97;
  const double yield = static_cast<double>(plasticity.yield);
  if (!(largest_strain_ > kHair * yield)) {
    const double headroom = std::max(1.0, kCautious * yield / std::max(largest_strain_, 1e-9));
    calm_ = stretch_ * static_cast<float>(headroom);
    return false;
  }
  calm_ = 0;
  find_flow(sums, plasticity, share);
  find_along();
  keep_volume();
  constexpr int kTries = 4;
  for (int i = 0; i < kTries; ++i) {
    std::vector<Exact> shape = new_shape();
    if (stop_bad_cells(shape)) continue;
    rest_before_ = std::exchange(rest_, std::move(shape));
    inverse_squares_before_.swap(inverse_squares_);
    find_inverse_squares();
    return true;
  }
  return false;
}

template class PlasticFlow<2>;
template class PlasticFlow<3>;

}  // namespace softcell::ppu
