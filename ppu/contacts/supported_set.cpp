#include "ppu/contacts/supported_set.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Six = Eigen::Matrix<double, 6, 1>;

// Until an iteration changes no impulse by more than a share of the largest, or at most so many.
constexpr int kMostIterations = 100;
constexpr double kSettled = 1e-3;
// Of a touch's own mobility, added to it: four corners of a crate say more than there is to say. What holds gives way by so much.
constexpr double kGivesWay = 1e-6;
// Cells in a substep: what moves farther where it was held was not.
constexpr double kHeld = 0.1;
// And of what it would move without: less than that was held.
constexpr double kLeft = 0.1;

/// What an impulse and a moment change of a rigid body that is free.
Six change_of_free(const ContactRigid& rigid, const Six& by) {
  Six change;
  change << double{rigid.inverse_mass} * by.head<3>(), rigid.inverse_inertia.cast<double>() * by.tail<3>();
  return change;
}

Six velocity_of(const ContactRigid& rigid) {
  Six velocity;
  velocity << rigid.velocity.cast<double>(), rigid.spin.cast<double>();
  return velocity;
}

/// A direction at a point of a rigid body, and how that turns it.
Six direction_at(const ContactRigid& rigid, const Vector3f& point, const Vector3d& direction) {
  const Vector3d arm = (point - rigid.centre).cast<double>();
  Six both;
  both << direction, arm.cross(direction);
  return both;
}

}  // namespace

void SupportedSet::begin(std::span<ContactRigid> rigids, std::span<const std::uint32_t> members) {
  rigids_ = rigids;
  members_.clear(), touches_.clear(), rows_.clear();
  for (const std::uint32_t rigid : members) {
    SC_ASSERT(rigids[rigid].inverse_mass > 0, "nothing moves rigid body {}", rigid);
    const Six velocity = velocity_of(rigids[rigid]);
    members_.push_back(
        {.rigid = rigid, .before = velocity, .stands = velocity, .now = velocity, .impulse = Six::Zero()});
  }
}

std::size_t SupportedSet::member_of(std::uint32_t rigid) const {
  const auto found = std::ranges::find(members_, rigid, &Member::rigid);
  return found == members_.end() ? kOutside : static_cast<std::size_t>(found - members_.begin());
}

SupportedSet::Row SupportedSet::row(const RigidTouch& touch, const Vector3f& direction) const {
  Row made;
  const auto side = [&](std::uint32_t rigid, const Vector3f& along_it) -> Side {
    const ContactRigid& body = rigids_[rigid];
    const Six along = direction_at(body, touch.point, along_it.cast<double>());
    const Side one{rigid, member_of(rigid), along, change_of_free(body, along)};
    if (one.member == kOutside)
      made.outside += along.dot(velocity_of(body));
    else
      made.mobility += along.dot(one.change);
    return one;
  };
  made.a = side(touch.a, direction);
  made.b = side(touch.b, -direction);
  return made;
}

void SupportedSet::add(const RigidTouch& touch, float step) {
  if (touches_.size() == kMostTouches) return;
  if (member_of(touch.a) == kOutside && member_of(touch.b) == kOutside) return;
  const Vector3f across = touch.normal.unitOrthogonal();
  touches_.push_back({row(touch, touch.normal),
                      {row(touch, across), row(touch, touch.normal.cross(across))},
                      double{touch.friction}});
  touches_.back().normal.target = -std::max(0.0, double{touch.gap}) / double{step};
}

bool SupportedSet::Touch::sticks() const {
  return Vector2d(across[0].impulse, across[1].impulse).norm() < friction * normal.impulse;
}

/// Of its two sides against each other; along the normal below 0 they come together. m/s.
double SupportedSet::speed(const Row& row) const {
  double speed = row.outside;
  for (const Side* const side : {&row.a, &row.b})
    if (side->member != kOutside) speed += side->along.dot(members_[side->member].now);
  return speed;
}

void SupportedSet::push(const Row& row, double impulse) {
  for (const Side* const side : {&row.a, &row.b})
    if (side->member != kOutside) members_[side->member].now += impulse * side->change;
}

/// By impulses that only part what touches, and friction.
void SupportedSet::iterate() {
  double most = 0, largest_change = 0;
  const auto change = [&](Row& row, double impulse) {
    push(row, impulse - row.impulse);
    largest_change = std::max(largest_change, std::abs(impulse - row.impulse));
    most = std::max(most, std::abs(impulse));
    row.impulse = impulse;
  };
  const auto wanted = [&](const Row& row) {
    return row.mobility > 0 ? row.impulse + (row.target - speed(row)) / row.mobility : 0;
  };
  for (int i = 0; i < kMostIterations; ++i) {
    most = largest_change = 0;
    for (Touch& touch : touches_) {
      change(touch.normal, std::max(0.0, wanted(touch.normal)));
      Vector2d across(wanted(touch.across[0]), wanted(touch.across[1]));
      const double length = across.norm(), limit = touch.friction * touch.normal.impulse;
      if (length > limit) across *= limit / length;
      change(touch.across[0], across.x());
      change(touch.across[1], across.y());
    }
    if (largest_change <= kSettled * most) break;
  }
}

/// With what soft bodies do to members that stand as they do now.
void SupportedSet::load(std::span<const Press> presses, float step) {
  fastest_ = std::numeric_limits<double>::max();
  for (const Press& press : presses) {
    const std::size_t number = member_of(press.rigid);
    if (number == kOutside) continue;
    Member& member = members_[number];
    member.pressed = true;
    fastest_ = std::min(fastest_, kHeld * double{press.spacing} / double{step});
    const Vector3d arm = (press.point - rigids_[press.rigid].centre).cast<double>();
    const Vector3d relative =
        press.velocity.cast<double>() - member.now.head<3>() - Vector3d(member.now.tail<3>()).cross(arm);
    const Vector3d normal = press.normal.cast<double>();
    const double approach = -normal.dot(relative);
    if (approach <= 0) continue;
    Vector3d sliding = relative + approach * normal;
    const double speed = sliding.norm(), most = double{press.friction} * approach;
    if (speed > most) sliding *= most / speed;
    member.impulse +=
        direction_at(rigids_[press.rigid], press.point, double{press.mass} * (sliding - approach * normal));
  }
  for (Member& member : members_) member.now += change_of_free(rigids_[member.rigid], member.impulse);
}

template <typename Work>
void SupportedSet::for_each_row(const Work& work) {
  for (Touch& touch : touches_)
    for (Row* const row : {&touch.normal, &touch.across[0], &touch.across[1]}) work(*row);
}

bool SupportedSet::hold(std::span<const Press> presses, float step) {
  if (touches_.empty()) return false;
  iterate();
  for (Member& member : members_) member.stands = member.now;
  for_each_row([&](Row& row) { row.stands = speed(row), row.stands_by = row.impulse; });
  load(presses, step);
  iterate();
  all_stick_ = true;
  for (Touch& touch : touches_) {
    if (!(touch.normal.impulse > 0)) continue;
    rows_.push_back(&touch.normal);
    all_stick_ = all_stick_ && touch.sticks();
    if (touch.sticks())
      for (Row& across : touch.across) rows_.push_back(&across);
  }
  if (rows_.empty()) return false;
  factor();
  values_.resize(rows_.size());
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (members_[i].pressed) hold_member(i);
  for (Member& member : members_) member.impulse.setZero();  // that was a guess
  return true;
}

/// By Cholesky.
void SupportedSet::factor() {
  const std::size_t n = rows_.size();
  factor_.assign(n * n, 0);
  for (std::size_t i = 0; i < n; ++i) {
    const Row& row = *rows_[i];
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = i == j ? kGivesWay * row.mobility : 0;
      for (const Side* const side : {&row.a, &row.b})
        for (const Side* const other : {&rows_[j]->a, &rows_[j]->b})
          if (side->member != kOutside && side->member == other->member)
            sum += side->along.dot(other->change);
      for (std::size_t k = 0; k < j; ++k) sum -= factor_[i * n + k] * factor_[j * n + k];
      factor_[i * n + j] =
          i == j ? std::sqrt(std::max(sum, kGivesWay * row.mobility)) : sum / factor_[j * n + j];
    }
  }
}

/// Makes changes of the speeds of rows the impulses that cause them.
void SupportedSet::solve(std::span<double> values) const {
  const std::size_t n = rows_.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) values[i] -= factor_[i * n + k] * values[k];
    values[i] /= factor_[i * n + i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) values[i] -= factor_[k * n + i] * values[k];
    values[i] /= factor_[i * n + i];
  }
}

void SupportedSet::hold_member(std::size_t number) {
  const Member& member = members_[number];
  ContactRigid& rigid = rigids_[member.rigid];
  const auto change_by = [&](const Row& row) -> Six {
    Six change = Six::Zero();
    for (const Side* const side : {&row.a, &row.b})
      if (side->member == number) change += side->change;
    return change;
  };
  Eigen::Matrix<double, 6, 6> mobility;
  for (int axis = 0; axis < 6; ++axis) {
    // What an impulse changes of speeds of rows is what their impulses change of the member.
    for (std::size_t i = 0; i < rows_.size(); ++i) values_[i] = change_by(*rows_[i])[axis];
    solve(values_);
    Six change = change_of_free(rigid, Six::Unit(axis));
    for (std::size_t i = 0; i < rows_.size(); ++i) change -= values_[i] * change_by(*rows_[i]);
    mobility.col(axis) = change;
  }
  rigid.held = HeldMobility{mobility.topLeftCorner<3, 3>().cast<float>(),
                            mobility.topRightCorner<3, 3>().cast<float>(),
                            mobility.bottomRightCorner<3, 3>().cast<float>()};
  rigid.velocity = member.stands.head<3>().cast<float>();
  rigid.spin = member.stands.tail<3>().cast<float>();
}

void SupportedSet::add_impulse(std::uint32_t rigid, const Vector3f& point, const Vector3f& impulse) {
  const std::size_t member = member_of(rigid);
  if (member != kOutside)
    members_[member].impulse += direction_at(rigids_[rigid], point, impulse.cast<double>());
}

void SupportedSet::give_impulses() {
  for (const Member& member : members_) {
    ContactRigid& rigid = rigids_[member.rigid];
    const Six velocity = member.before + change_of_free(rigid, member.impulse);
    rigid.held.reset();
    rigid.velocity = velocity.head<3>().cast<float>();
    rigid.spin = velocity.tail<3>().cast<float>();
  }
}

/// m/s: how much rows that hold differ from where members stand.
double SupportedSet::fastest() const {
  double most = 0;
  for (const Row* const row : rows_) most = std::max(most, std::abs(speed(*row) - row->stands));
  return most;
}

void SupportedSet::give_support() {
  const auto load_standing = [&] {
    for (Member& member : members_)
      member.now = member.stands + change_of_free(rigids_[member.rigid], member.impulse);
    for_each_row([](Row& row) { row.impulse = row.stands_by; });
  };
  load_standing();
  const double falls = fastest();
  iterate();
  // Soft bodies have been solved as if nothing moved along these rows. What moves a little there, of a table on many legs, is what iterations
  // have left; and a crate that is a hundredth of them would fly away with what they have got from it, if then it slides or is lifted. In both
  // cases what it lies on keeps it for this substep.
  const double moves = fastest();
  if (moves > fastest_ || (all_stick_ && moves < kLeft * falls)) {
    load_standing();
    for (std::size_t i = 0; i < rows_.size(); ++i) values_[i] = rows_[i]->stands - speed(*rows_[i]);
    solve(values_);
    for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i]->impulse += values_[i];
  }
  for_each_row([&](const Row& row) {
    for (const Side* const side : {&row.a, &row.b}) {
      const Six change = row.impulse * side->change;
      rigids_[side->rigid].velocity += change.head<3>().cast<float>();
      rigids_[side->rigid].spin += change.tail<3>().cast<float>();
    }
  });
}

}  // namespace softcell::ppu
