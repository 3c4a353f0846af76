#include "ppu/attachments/attachment_rows.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "ppu/attachments/patch_spread.h"
#include "ppu/attachments/turned_patches.h"
#include "ppu/numbers/turning.h"
#include "ppu/numbers/wide_inverse.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

// A substep corrects at most this many cells of an error of position: particles far from their place would otherwise fly there.
constexpr float kMostPushInCells = 0.25f;
// Places of several particles correct only this share: pushes deform the patch, too, which takes some substeps to recover.
constexpr float kPushShareOfPlaces = 0.2f;
// Up to this gap an attachment holds particles, and all angular momentum that it gives is taken back.
constexpr float kMostApartInCells = 0.5f;

/// Inverts a matrix by the formulas for its size, which is known at compile time: a factorisation for all sizes takes ten times as long to
/// compile.
/// @pre there are 1 to kMost rows
template <int kMost, typename Matrix>
Matrix inverse_of_few(const Matrix& matrix) {
  SC_ASSERT(matrix.rows() > 0 && matrix.rows() <= kMost, "{} rows, of at most {}", matrix.rows(), kMost);
  if constexpr (kMost > 1) {
    if (matrix.rows() < kMost) return inverse_of_few<kMost - 1>(matrix);
    return wide_inverse(Eigen::Matrix<float, kMost, kMost>(matrix));
  } else {
    return Matrix::Constant(1, 1, 1 / matrix(0, 0));
  }
}

}  // namespace

template <int kDimension>
void AttachmentRows<kDimension>::add_row(const Vector& point, const PatchParticles<kDimension>& a,
                                         const PatchParticles<kDimension>* b,
                                         const AttachmentFrame<kDimension>* frame) {
  Row& row = rows_.emplace_back();
  row.a = a_.append(a, point);
  if (b != nullptr) row.b = b_.append(*b, point);
  if (frame != nullptr) row.own = frame->to_own(point);
}

template <int kDimension>
void AttachmentRows<kDimension>::add_places_in_common(const PatchParticles<kDimension>& a,
                                                      const PatchParticles<kDimension>& b) {
  const Spread<kDimension> spread = spread_of(a, &b);
  for (const Vector& corner : simplex<kDimension>())
    add_row(spread.middle + spread.root * corner, a, &b, nullptr);
}

template <int kDimension>
void AttachmentRows<kDimension>::add_hinge(const PatchParticles<kDimension>& a,
                                           const PatchParticles<kDimension>* b,
                                           const AttachmentFrame<kDimension>* frame) {
  const Vector point = settings_.point.value_or(a.middle());
  if constexpr (kDimension == 2) {
    add_row(point, a, b, frame);
  } else {
    const Spread<kDimension> spread = spread_of(a, b);
    const Vector axis = settings_.axis.normalized();
    // So that impulses at the two places do not act on each other.
    const float reach = 1 / (spread.inverse_of_root * axis).norm();
    for (const float way : {-reach, reach}) add_row(point + way * axis, a, b, frame);
  }
}

template <int kDimension>
AttachmentRows<kDimension>::AttachmentRows(const AttachmentSettings<kDimension>& settings,
                                           const PatchParticles<kDimension>& a,
                                           const PatchParticles<kDimension>& b)
    : settings_(settings) {
  switch (settings.kind) {
    case AttachmentKind::kWeld:
      add_places_in_common(a, b);
      break;
    case AttachmentKind::kHinge:
      add_hinge(a, &b, nullptr);
      break;
    case AttachmentKind::kRope:
      Row& row = rows_.emplace_back();
      row.a = a_.append_middle(a);
      row.b = b_.append_middle(b);
      length_ = settings.length.value_or((a.middle() - b.middle()).norm());
      break;
  }
}

template <int kDimension>
AttachmentRows<kDimension>::AttachmentRows(const AttachmentSettings<kDimension>& settings,
                                           const PatchParticles<kDimension>& a,
                                           const AttachmentFrame<kDimension>& frame)
    : settings_(settings) {
  switch (settings.kind) {
    case AttachmentKind::kWeld:
      for (std::size_t i = 0; i < a.particles.size(); ++i) {
        Row& row = rows_.emplace_back();
        row.a = a_.append(a.particles[i], 1);
        row.own = frame.to_own(a.positions[i]);
        row.share = a.masses[i];
      }
      break;
    case AttachmentKind::kHinge:
      add_hinge(a, nullptr, &frame);
      break;
    case AttachmentKind::kRope:
      SC_ASSERT(settings.point.has_value(), "a rope of {} particles without its other end",
                a.particles.size());
      Row& row = rows_.emplace_back();
      row.a = a_.append_middle(a);
      row.own = frame.to_own(*settings.point);
      length_ = settings.length.value_or((a.middle() - *settings.point).norm());
      break;
  }
}

template <int kDimension>
auto AttachmentRows<kDimension>::relative_velocity(const Row& row) const -> Vector {
  const Vector v = a_.of(row.a, sides_.a.velocities);
  if (sides_.b != nullptr) return v - b_.of(row.b, sides_.b->velocities);
  if (sides_.rigid != nullptr) return v - AttachedRigid<kDimension>::velocity_at(*sides_.rigid, row.point);
  return v - row.carried;
}

template <int kDimension>
void AttachmentRows<kDimension>::apply(const Row& row, const Vector& impulse) {
  a_.add(row.a, sides_.a, sides_.a.velocities, impulse);
  if (sides_.b != nullptr)
    b_.add(row.b, *sides_.b, sides_.b->velocities, -impulse);
  else if (sides_.rigid != nullptr && sides_.rigid->inverse_mass != 0)
    AttachedRigid<kDimension>::apply(*sides_.rigid, row.point, -impulse);
}

/// Of soft bodies only: a rigid one is moved by its engine.
template <int kDimension>
auto AttachmentRows<kDimension>::relative_push(const Row& row) const -> Vector {
  const Vector push = a_.of(row.a, sides_.a.pushes);
  return sides_.b != nullptr ? Vector(push - b_.of(row.b, sides_.b->pushes)) : push;
}

template <int kDimension>
void AttachmentRows<kDimension>::apply_push(const Row& row, const Vector& impulse) {
  a_.push(row.a, sides_.a, impulse);
  if (sides_.b != nullptr) b_.push(row.b, *sides_.b, -impulse);
}

template <int kDimension>
auto AttachmentRows<kDimension>::begin_row(Row& row) -> Vector {
  const float h = step_;
  Vector place = Vector::Zero();  // where b holds it
  if (sides_.b != nullptr) {
    place = row.point = b_.of(row.b, sides_.b->positions);
  } else {
    place = row.point = sides_.frame->to_world(row.own);
    if (sides_.rigid == nullptr)
      row.carried = sides_.frame->velocity_at(row.own, h);
    else
      place += 0.5f * h * h * AttachedRigid<kDimension>::curve(*sides_.rigid, row.point);
  }
  const Vector apart = a_.of(row.a, sides_.a.positions) - place;
  row.error = apart / h;
  if (softness_ == 0 && row.a.count > 1 && settings_.kind != AttachmentKind::kRope)
    row.error *= kPushShareOfPlaces;

  row.push_mobility = a_.mobility(row.a, sides_.a.inverse_masses);
  if (sides_.b != nullptr) row.push_mobility += b_.mobility(row.b, sides_.b->inverse_masses);
  if (with_rigid_at_once_) row.mobility = row.push_mobility + softness_;
  Matrix mobility = (row.push_mobility + softness_) * Matrix::Identity();
  if (sides_.rigid != nullptr) mobility += AttachedRigid<kDimension>::mobility(*sides_.rigid, row.point);
  if (settings_.kind == AttachmentKind::kRope) {
    row.inverse_mobility = mobility;
    begin_rope(row, apart);
    return apart;
  }
  if (!with_rigid_at_once_)
    row.inverse_mobility = sides_.rigid != nullptr ? Matrix(wide_inverse(mobility))
                                                   : Matrix(Matrix::Identity() / mobility(0, 0));
  const float most = most_of_error(mobility.trace() / kDimension), speed = row.error.norm();
  if (speed > most) row.error *= most / speed;
  pushes_ = pushes_ || (softness_ == 0 && speed > 0);
  return apart;
}

template <int kDimension>
float AttachmentRows<kDimension>::most_push(const AttachedBody<kDimension>& body) const {
  return kMostPushInCells * body.spacing / step_;
}

/// m/s: the largest correction that an error of position may demand from a row. A compliant row gives way, and turns only its rigid share
/// of the demand into velocity.
/// @param mobility  of the row, softness included
template <int kDimension>
float AttachmentRows<kDimension>::most_of_error(float mobility) const {
  SC_ASSERT(mobility >= softness_, "a row with a mobility of {} is softer, {}", mobility, softness_);
  const float most = most_push(sides_.a), rigid = mobility - softness_;
  return rigid > 0 ? most * mobility / rigid : most;
}

/// All places of a side have the same particles in the same order.
template <int kDimension>
void AttachmentRows<kDimension>::begin_places() {
  const auto count = static_cast<Eigen::Index>(rows_.size());
  Places mobilities = Places::Zero(count, count);
  const auto add = [&](const Side& side, Place Row::*place, std::span<const float> inverse_masses) {
    for (Eigen::Index k = 0; k < count; ++k) {
      for (Eigen::Index l = 0; l <= k; ++l) {
        const Place& first = rows_[static_cast<std::size_t>(k)].*place;
        const Place& second = rows_[static_cast<std::size_t>(l)].*place;
        for (std::uint32_t i = 0; i < first.count; ++i)
          mobilities(k, l) += side.share[first.first + i] * side.share[second.first + i] *
                              inverse_masses[side.particle[first.first + i]];
      }
    }
  };
  add(a_, &Row::a, sides_.a.inverse_masses);
  if (sides_.b != nullptr) add(b_, &Row::b, sides_.b->inverse_masses);
  for (Eigen::Index k = 0; k < count; ++k)
    for (Eigen::Index l = k + 1; l < count; ++l) mobilities(k, l) = mobilities(l, k);
  inverse_of_pushes_ = inverse_of_few<kDimension + 1>(mobilities);
  mobilities.diagonal().array() += softness_;
  inverse_of_places_ = inverse_of_few<kDimension + 1>(mobilities);
}

/// Sums up the rigid body's mass and inertia, and those of its rows. @pre it has both
template <int kDimension>
void AttachmentRows<kDimension>::begin_weld_to_rigid() {
  using Of = AttachedRigid<kDimension>;
  sum_ = 1 / sides_.rigid->inverse_mass;
  sum_of_arms_.setZero();
  inverse_inertia_ = Of::inertia(*sides_.rigid);
  for (const Row& row : rows_) {
    const float mass = row.mobility > 0 ? 1 / row.mobility : 0;
    const Vector arm = row.point - sides_.rigid->centre;
    sum_ += mass;
    sum_of_arms_ += mass * arm;
    inverse_inertia_ += mass * Of::inertia_of_arm(arm);
  }
  inverse_inertia_ -= Of::inertia_of_arm(sum_of_arms_) / sum_;
  inverse_inertia_ = wide_inverse(inverse_inertia_);
}

/// A rope's length is limited at the point that its ends reach by circling each other, not by moving straight on. So the rope takes no
/// energy from a body that swings.
template <int kDimension>
void AttachmentRows<kDimension>::begin_rope(Row& row, const Vector& apart) {
  const float h = step_, distance = apart.norm(), length = length_;
  row.along = distance > 0 ? Vector(apart / distance) : Vector(Vector::UnitY());
  row.mobility = row.along.dot(row.inverse_mobility * row.along);
  const Vector v = relative_velocity(row);
  const float across = (v - row.along.dot(v) * row.along).squaredNorm() * h * h;
  const float reach = std::sqrt(std::max(length * length - across, 0.25f * length * length));
  const float excess = std::max(distance - length, 0.0f);
  row.most = (reach - std::min(distance, length)) / h;
  if (softness_ > 0) row.most -= std::min(excess / h, most_of_error(row.mobility));
  row.push_most = softness_ > 0 ? 0 : -std::min(excess / h, most_push(sides_.a));
  row.push = 0;
  pushes_ = pushes_ || row.push_most < 0;
}

template <int kDimension>
void AttachmentRows<kDimension>::renumber(bool of_b, std::vector<std::uint32_t> numbers) {
  Side& side = of_b ? b_ : a_;
  SC_ASSERT(numbers.size() == side.particle.size(), "{} new numbers of {} particles", numbers.size(),
            side.particle.size());
  side.particle = std::move(numbers);
}

template <int kDimension>
void AttachmentRows<kDimension>::append_held(std::uint32_t a, const AttachmentFrame<kDimension>& frame,
                                             const Rigid* rigid, float step,
                                             std::vector<HeldParticle<kDimension>>& held) {
  is_pressed_ = breaks_off_ = false;
  if (settings_.kind != AttachmentKind::kWeld || settings_.compliance > 0) return;
  if (rigid != nullptr && rigid->inverse_mass > 0) return;
  // Attachments that contradict each other hold nothing: in the last substep this one's ends were apart.
  if (state_.gap > kMostApartInCells * sides_.a.spacing) return;
  for (const Row& row : rows_) {
    const Vector point = frame.to_world(row.own);
    const Vector velocity = rigid != nullptr ? AttachedRigid<kDimension>::velocity_at(*rigid, point)
                                             : frame.velocity_at(row.own, step);
    held.push_back({a, a_.particle[row.a.first], velocity, settings_.break_force * step, 0});
  }
}

template <int kDimension>
void AttachmentRows<kDimension>::begin(const Sides& sides, float step) {
  SC_ASSERT(step > 0 && (sides.b != nullptr || sides.frame != nullptr), "a substep of {} s, of {} rows", step,
            rows_.size());
  sides_ = sides;

  step_ = step;
  const float rows = static_cast<float>(rows_.size());
  softness_ = settings_.compliance * rows / (step * step);
  pushes_ = false;
  const bool is_weld_to_frame = settings_.kind == AttachmentKind::kWeld && sides.b == nullptr;
  with_rigid_at_once_ = is_weld_to_frame && sides.rigid != nullptr && sides.rigid->inverse_mass > 0 &&
                        AttachedRigid<kDimension>::is_free(*sides.rigid) &&
                        AttachedRigid<kDimension>::can_turn(*sides.rigid);
  is_direct_ =
      is_weld_to_frame && (with_rigid_at_once_ || sides.rigid == nullptr || sides.rigid->inverse_mass == 0);
  places_at_once_ = settings_.kind != AttachmentKind::kRope && !is_weld_to_frame &&
                    (sides.b != nullptr || sides.rigid == nullptr || sides.rigid->inverse_mass == 0);
  is_direct_ = is_direct_ || places_at_once_;
  a_.forget_pushes();
  b_.forget_pushes();
  Vector apart = Vector::Zero();
  for (Row& row : rows_) {
    row.impulse.setZero();
    apart += begin_row(row);
  }
  state_.gap = apart.norm() / rows;
  if (with_rigid_at_once_) begin_weld_to_rigid();
  if (places_at_once_) begin_places();
}

template <int kDimension>
float AttachmentRows<kDimension>::solve(Row& row) {
  Vector v = relative_velocity(row);
  if (softness_ > 0) v += row.error + softness_ * row.impulse;
  const Vector change = -(row.inverse_mobility * v);
  row.impulse += change;
  apply(row, change);
  solve_push(row);
  return v.squaredNorm();
}

template <int kDimension>
void AttachmentRows<kDimension>::solve_push(const Row& row) {
  if (pushes_ && row.push_mobility > 0)
    apply_push(row, -(relative_push(row) + row.error) / row.push_mobility);
}

template <int kDimension>
float AttachmentRows<kDimension>::solve_places() {
  Eigen::Matrix<float, Eigen::Dynamic, kDimension, 0, kDimension + 1, kDimension> missing(
      static_cast<Eigen::Index>(rows_.size()), kDimension);
  float largest = 0;
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    Vector v = relative_velocity(rows_[k]);
    if (softness_ > 0) v += rows_[k].error + softness_ * rows_[k].impulse;
    largest = std::max(largest, v.squaredNorm());
    missing.row(static_cast<Eigen::Index>(k)) = -v;
  }
  missing = inverse_of_places_.lazyProduct(missing).eval();
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const Vector change = missing.row(static_cast<Eigen::Index>(k));
    rows_[k].impulse += change;
    apply(rows_[k], change);
  }
  if (!pushes_) return largest;
  for (std::size_t k = 0; k < rows_.size(); ++k)
    missing.row(static_cast<Eigen::Index>(k)) = -(relative_push(rows_[k]) + rows_[k].error);
  missing = inverse_of_pushes_.lazyProduct(missing).eval();
  for (std::size_t k = 0; k < rows_.size(); ++k)
    apply_push(rows_[k], missing.row(static_cast<Eigen::Index>(k)));
  return largest;
}

/// Solves all rows at once: first their velocities, then the rigid body's change, then their impulses.
template <int kDimension>
float AttachmentRows<kDimension>::solve_weld_to_rigid() {
  using Of = AttachedRigid<kDimension>;
  Rigid& rigid = *sides_.rigid;
  Vector momentum = Vector::Zero();
  typename Of::Axial turn = Of::Axial::Zero();
  float largest = 0;
  for (Row& row : rows_) {
    row.carried = relative_velocity(row);
    if (softness_ > 0) row.carried += row.error + softness_ * row.impulse;
    if (!(row.mobility > 0)) continue;
    const Vector pull = row.carried / row.mobility;
    momentum += pull;
    turn += Of::moment(row.point - rigid.centre, pull);
    largest = std::max(largest, row.carried.squaredNorm());
  }
  const typename Of::Axial spin = inverse_inertia_ * (turn - Of::moment(sum_of_arms_, momentum) / sum_);
  const Vector velocity = (momentum - Of::turned(spin, sum_of_arms_)) / sum_;
  Vector given = Vector::Zero();
  for (Row& row : rows_) {
    if (!(row.mobility > 0)) continue;
    const Vector change =
        (velocity + Of::turned(spin, row.point - rigid.centre) - row.carried) / row.mobility;
    row.impulse += change;
    given += change;
    a_.add(row.a, sides_.a, sides_.a.velocities, change);
    solve_push(row);
  }
  // The rigid body loses exactly what the rows have been given, as far as floats allow.
  Of::change(rigid, -rigid.inverse_mass * given, spin);
  return largest;
}

template <int kDimension>
float AttachmentRows<kDimension>::solve_rope(Row& row) {
  const float before = row.along.dot(row.impulse);
  const float error = row.most - row.along.dot(relative_velocity(row)) - softness_ * before;
  const float after = std::min(0.0f, before + error / row.mobility);
  apply(row, (after - before) * row.along);
  row.impulse = after * row.along;
  if (row.push_most < 0 && row.push_mobility > 0) {
    const float missing = row.push_most - row.along.dot(relative_push(row));
    const float push = std::min(0.0f, row.push + missing / row.push_mobility);
    apply_push(row, (push - row.push) * row.along);
    row.push = push;
  }
  const float change = (after - before) * row.mobility;
  return change * change;
}

template <int kDimension>
auto AttachmentRows<kDimension>::carried_impulse() const -> Vector {
  Vector sum = Vector::Zero();
  for (const Row& row : rows_) sum += row.impulse;
  return sum;
}

template <int kDimension>
void AttachmentRows<kDimension>::keep_below_break_force() {
  if (!std::isfinite(settings_.break_force)) return;
  const float impulse = carried_impulse().norm(), most = settings_.break_force * step_;
  broke_ = impulse > most;
  if (!broke_ || carries_all()) return;
  for (Row& row : rows_) {
    const Vector kept = most / impulse * row.impulse;
    apply(row, kept - row.impulse);
    row.impulse = kept;
  }
}

template <int kDimension>
float AttachmentRows<kDimension>::iterate() {
  float largest = 0;
  const bool is_rope = settings_.kind == AttachmentKind::kRope;
  if (with_rigid_at_once_) {
    largest = solve_weld_to_rigid();
  } else if (places_at_once_) {
    largest = solve_places();
  } else {
    for (Row& row : rows_) largest = std::max(largest, is_rope ? solve_rope(row) : solve(row));
  }
  keep_below_break_force();
  return largest;
}

/// Limits pushes, as attachments that contradict each other would push further and further. Pushes of contacts and of other attachments
/// remain.
template <int kDimension>
void AttachmentRows<kDimension>::limit_pushes(const Side& side, const AttachedBody<kDimension>& body) const {
  if (!pushes_) return;
  const float most = most_push(body);
  for (std::size_t i = 0; i < side.pushed.size(); ++i) {
    const Vector& pushed = side.pushed[i];
    const float speed = pushed.norm();
    if (speed > most) body.pushes[side.particle[i]] -= (1 - most / speed) * pushed;
  }
}

template <int kDimension>
void AttachmentRows<kDimension>::finish() {
  state_.force = carried_impulse() / step_;
  limit_pushes(a_, sides_.a);
  if (sides_.b != nullptr) limit_pushes(b_, *sides_.b);
}

/// A rope's impulse lies on the line between its ends, so it adds none. A side that does not move takes spin as it takes momentum.
template <int kDimension>
bool AttachmentRows<kDimension>::takes_back_spin() const {
  if (settings_.kind == AttachmentKind::kRope || sides_.a.asleep) return false;
  if (sides_.b != nullptr) return softness_ > 0 && !sides_.b->asleep;
  return pushes_soft_body_only();
}

/// A free rigid body is not pushed.
template <int kDimension>
bool AttachmentRows<kDimension>::pushes_soft_body_only() const {
  return sides_.b == nullptr && sides_.rigid != nullptr && sides_.rigid->inverse_mass > 0;
}

/// The angular momentum that the soft body gets as pushes move particles, each with its momentum: a particle that follows the rigid body on
/// an arc has gone straight on, and is pushed inwards. What arcs do not explain is left out, as it would drive the bodies.
template <int kDimension>
auto AttachmentRows<kDimension>::spin_of_pushes() const -> Axial {
  constexpr double kMost = 2;              // of what arcs explain
  constexpr double kLeastAlignment = 0.5;  // cosine between the spin and what arcs explain
  using Wide = Eigen::Vector<double, kDimension>;
  using Of = AttachedRigid<kDimension>;
  const AttachedBody<kDimension>& body = sides_.a;
  const double step = double{step_};
  Axial sum = turning::cross(Wide::Zero().eval(), Wide::Zero().eval()), of_arcs = sum;
  for (const std::uint32_t i : a_.patch(rows_.front().a)) {
    const double mass = 1 / double{body.inverse_masses[i]};
    const Vector& place = body.positions[i];
    const Wide way = step * body.pushes[i].template cast<double>();
    sum += turning::cross(way, (mass * body.velocities[i].template cast<double>()).eval());
    const Wide arc = 0.5 * step * step * Of::curve(*sides_.rigid, place).template cast<double>();
    const Wide carried = Of::velocity_at(*sides_.rigid, place).template cast<double>();
    of_arcs += turning::cross(arc, (mass * carried).eval());
  }
  const double size = turning::length_of(sum), most = kMost * turning::length_of(of_arcs);
  if (!(turning::dot(sum, of_arcs) > kLeastAlignment * size * turning::length_of(of_arcs)))
    return Axial(0 * sum);
  return size > most ? Axial(most / size * sum) : sum;
}

/// Ends on a rigid body that are a body's length apart, as after a teleport, have a lever with which small patches would be thrown about.
/// Compliance lets ends come apart, and as much more as it makes a row softer.
template <int kDimension>
double AttachmentRows<kDimension>::share_taken_back(const Row& row, const Vector& apart) const {
  if (sides_.b != nullptr) return 1;
  const double softer = softness_ > 0 ? 1 + double{softness_} / double{row.push_mobility} : 1;
  const double limit = softer * double{kMostApartInCells} * double{sides_.a.spacing};
  const double squared = apart.template cast<double>().squaredNorm();
  return squared > limit * limit ? limit * limit / squared : 1;
}

template <int kDimension>
bool AttachmentRows<kDimension>::is_apart() const {
  constexpr float kMost = 0.1f;  // cells
  return state_.gap > kMost * sides_.a.spacing;
}

template <int kDimension>
void AttachmentRows<kDimension>::take_back_spin(bool agrees) {
  if (!takes_back_spin()) return;
  Axial given = turning::cross(Eigen::Vector<double, kDimension>::Zero().eval(),
                               Eigen::Vector<double, kDimension>::Zero().eval());
  // Without compliance, the ends of attachments that contradict each other are apart.
  if (softness_ > 0 || agrees)
    for (const Row& row : rows_) {
      const Vector apart = a_.of(row.a, sides_.a.positions) - row.point;
      given += share_taken_back(row, apart) * turning::cross(apart.template cast<double>().eval(),
                                                             row.impulse.template cast<double>().eval());
    }
  if (pushes_soft_body_only() && agrees) given += spin_of_pushes();
  TurnedPatches<kDimension> patches;
  patches.add(sides_.a, a_.patch(rows_.front().a));
  if (sides_.b != nullptr) patches.add(*sides_.b, b_.patch(rows_.front().b));
  patches.turn(-given);
}

template <int kDimension>
AttachmentEnds<kDimension> AttachmentRows<kDimension>::ends(std::span<const Vector> a,
                                                            std::span<const Vector> b,
                                                            const AttachmentFrame<kDimension>& frame) const {
  AttachmentEnds<kDimension> ends{.length = length_};
  float shares = 0;
  for (const Row& row : rows_) {
    ends.patch += row.share * a_.of(row.a, a);
    ends.other += row.share * (b.empty() ? frame.to_world(row.own) : b_.of(row.b, b));
    shares += row.share;
  }
  ends.patch /= shares;
  ends.other /= shares;
  return ends;
}

template class AttachmentRows<2>;
template class AttachmentRows<3>;

}  // namespace softcell::ppu
