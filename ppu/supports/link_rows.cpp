#include "ppu/supports/link_rows.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Six = LinkRows::Six;

// Iterations end when none changes an impulse by more than this share of the largest one, or after so many.
constexpr int kMostIterations = 100;
constexpr double kSettled = 1e-3;
// As a share of the row's own mobility: if joints leave less of it, the joints alone hold the row's members. Rows that nearly contradict
// joints would move the rest, and fast.
constexpr double kHeldByJoints = 1e-2;
// Softness of joints among each other, likewise.
constexpr double kJointGivesWay = 1e-5;

// A row that gives way by more than this share of its own mobility is a spring.
constexpr double kSpring = 0.1;

/// Whether the joint has a force of its own, as a motor has, and the springs of some of Bullet's joints: the engine applies that force
/// whatever has been applied before.
bool has_force(const JointRow& joint) {
  const auto is_force = [](float limit) { return limit != 0 && std::isfinite(limit); };
  return is_force(joint.least) || is_force(joint.most);
}

Six velocity_of(const ContactRigid& rigid) {
  Six velocity;
  velocity << rigid.velocity.cast<double>(), rigid.spin.cast<double>();
  return velocity;
}

}  // namespace

LinkRows::Six LinkRows::change_of_free(const ContactRigid& rigid, const Six& by) {
  Six change;
  change << double{rigid.inverse_mass} * by.head<3>(), rigid.inverse_inertia.cast<double>() * by.tail<3>();
  return change;
}

LinkRows::Six LinkRows::direction_at(const ContactRigid& rigid, const Vector3f& point,
                                     const Vector3d& direction) {
  const Vector3d arm = (point - rigid.centre).cast<double>();
  Six both;
  both << direction, arm.cross(direction);
  return both;
}

void LinkRows::begin(std::span<ContactRigid> rigids, std::span<const std::uint32_t> members) {
  rigids_ = rigids;
  members_.clear(), joints_.clear(), guarded_.clear(), touches_.clear(), limited_.clear();
  for (const std::uint32_t rigid : members) {
    SC_ASSERT(rigids[rigid].inverse_mass > 0, "nothing moves rigid body {}", rigid);
    const Six velocity = velocity_of(rigids[rigid]);
    members_.push_back({.rigid = rigid, .before = velocity, .now = velocity, .impulse = Six::Zero()});
  }
}

std::size_t LinkRows::member_of(std::uint32_t rigid) const {
  const auto found = std::ranges::find(members_, rigid, &Member::rigid);
  return found == members_.end() ? kOutside : static_cast<std::size_t>(found - members_.begin());
}

LinkRows::Side LinkRows::side(std::uint32_t rigid, const Six& along, Row& of) const {
  Side made{.member = member_of(rigid), .along = along};
  if (rigid == JointRow::kWorld) return made;
  made.change = change_of_free(rigids_[rigid], along);
  if (made.member == kOutside)
    of.outside += along.dot(velocity_of(rigids_[rigid]));
  else
    of.mobility += along.dot(made.change);
  return made;
}

LinkRows::Row LinkRows::row(const RigidTouch& touch, const Vector3f& direction) const {
  const auto along = [&](std::uint32_t rigid, const Vector3f& along_it) {
    return direction_at(rigids_[rigid], touch.point, along_it.cast<double>());
  };
  Row made;
  made.a = side(touch.a, along(touch.a, direction), made);
  made.b = side(touch.b, along(touch.b, -direction), made);
  return made;
}

void LinkRows::add(const RigidTouch& touch, float step) {
  if (touches_.size() == kMostTouches) return;
  if (member_of(touch.a) == kOutside && member_of(touch.b) == kOutside) return;
  const Vector3f across = touch.normal.unitOrthogonal();
  touches_.push_back({.normal = guarded_.size(), .friction = double{touch.friction}});
  for (const Vector3f& direction : {touch.normal, across, Vector3f(touch.normal.cross(across))})
    guarded_.push_back(row(touch, direction));
  guarded_[touches_.back().normal].target = -std::max(0.0, double{touch.gap}) / double{step};
}

void LinkRows::add(const JointRow& joint) {
  if (member_of(joint.a) == kOutside && member_of(joint.b) == kOutside) return;
  const auto along = [](const JointRow::Share& share) {
    Six both;
    both << share.linear.cast<double>(), share.angular.cast<double>();
    return both;
  };
  Row made;
  made.a = side(joint.a, along(joint.of_a), made);
  made.b = side(joint.b, along(joint.of_b), made);
  if (!(made.mobility > 0)) return;  // a rotation of bodies that do not rotate
  made.softness = double{joint.softness} + kJointGivesWay * made.mobility;
  made.target = double{joint.target};
  made.is_of_engine = has_force(joint) || joint.softness > kSpring * made.mobility || joint.is_watched;
  if (!joint.is_limited() && !made.is_of_engine) {
    joints_.push_back(made);
    return;
  }
  limited_.push_back({.row = guarded_.size(), .least = double{joint.least}, .most = double{joint.most}});
  guarded_.push_back(made);
}

bool LinkRows::sticks(const Touch& touch) const {
  const Row* const rows = &guarded_[touch.normal];
  return Vector2d(rows[1].impulse, rows[2].impulse).norm() < touch.friction * rows[0].impulse;
}

bool LinkRows::share_member(const Row& one, const Row& other) {
  const auto is_of = [](std::size_t member, const Row& row) {
    return member != kOutside && (row.a.member == member || row.b.member == member);
  };
  return is_of(one.a.member, other) || is_of(one.b.member, other);
}

/// The change of one row's speed by an impulse of the other.
double LinkRows::coupling(const Row& one, const Row& other) {
  double sum = 0;
  for (const Side* const side : {&one.a, &one.b})
    for (const Side* const by : {&other.a, &other.b})
      if (side->member != kOutside && side->member == by->member) sum += side->along.dot(by->change);
  return sum;
}

double LinkRows::speed(const Row& row) const {
  double speed = row.outside;
  for (const Side* const side : {&row.a, &row.b})
    if (side->member != kOutside) speed += side->along.dot(members_[side->member].now);
  return speed;
}

void LinkRows::push(const Row& row, double impulse) {
  for (const Side* const side : {&row.a, &row.b})
    if (side->member != kOutside) members_[side->member].now += impulse * side->change;
}

/// Computes how guarded rows act on each other: less than without joints, as joints take a part.
void LinkRows::prepare() {
  const std::size_t joints = joints_.size(), guarded = guarded_.size();
  factor(joints_factor_, joints, [&](std::size_t i) -> const Row& { return joints_[i]; });
  joint_change_.resize(guarded * joints);
  acts_.resize(guarded * guarded);
  joint_impulse_.resize(joints);
  for (std::size_t i = 0; i < guarded; ++i) {
    const std::span change = std::span(joint_change_).subspan(i * joints, joints);
    for (std::size_t j = 0; j < joints; ++j) change[j] = -coupling(joints_[j], guarded_[i]);
    joints_factor_.solve(change);
    for (std::size_t j = 0; j < guarded; ++j) {
      double& acts = acts_[i * guarded + j];
      acts = coupling(guarded_[j], guarded_[i]) + (i == j ? guarded_[i].softness : 0);
      for (std::size_t k = 0; k < joints; ++k)
        if (change[k] != 0) acts += change[k] * coupling(guarded_[j], joints_[k]);
    }
  }
}

void LinkRows::move_by_targets() {
  for (std::size_t j = 0; j < joints_.size(); ++j) joint_impulse_[j] = joints_[j].target;
  joints_factor_.solve(joint_impulse_);
  for (Member& member : members_) member.now.setZero();
  for (std::size_t j = 0; j < joints_.size(); ++j) push(joints_[j], joint_impulse_[j]);
}

void LinkRows::begin_from_outside() {
  for (Member& member : members_)
    member.now = member.before + change_of_free(rigids_[member.rigid], member.impulse);
}

void LinkRows::solve(Rows rows) {
  begin_from_outside();
  for (std::size_t j = 0; j < joints_.size(); ++j) joint_impulse_[j] = joints_[j].target - speed(joints_[j]);
  joints_factor_.solve(joint_impulse_);
  for (std::size_t j = 0; j < joints_.size(); ++j) push(joints_[j], joint_impulse_[j]);
  iterate(rows);
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    joints_[j].impulse = joint_impulse_[j];
    for (std::size_t i = 0; i < guarded_.size(); ++i)
      joints_[j].impulse += joint_change_[i * joints_.size() + j] * guarded_[i].impulse;
  }
  begin_from_outside();
  for_each_row([&](const Row& row) { push(row, row.impulse); });
}

/// The impulse with which a guarded row would reach its target, if nothing limited it.
double LinkRows::wanted(std::size_t row) const {
  const double acts = acts_[row * (guarded_.size() + 1)];
  return acts > kHeldByJoints * guarded_[row].mobility
             ? guarded_[row].impulse + (guarded_[row].target - speed_[row]) / acts
             : 0;
}

/// Iterates over guarded rows: contacts only push apart, with friction, and limited joints stay within their limits.
void LinkRows::iterate(Rows rows) {
  const std::size_t n = guarded_.size();
  double most = 0, largest_change = 0;
  const auto act = [&](std::size_t row, double impulse) {
    for (std::size_t i = 0; i < n; ++i) speed_[i] += impulse * acts_[row * n + i];
  };
  const auto change = [&](std::size_t row, double impulse) {
    double& of_row = guarded_[row].impulse;
    act(row, impulse - of_row);
    largest_change = std::max(largest_change, std::abs(impulse - of_row));
    most = std::max(most, std::abs(impulse));
    of_row = impulse;
  };
  speed_.resize(n);
  for (std::size_t i = 0; i < n; ++i) speed_[i] = speed(guarded_[i]);
  for (std::size_t i = 0; i < n; ++i) act(i, guarded_[i].impulse);
  for (int i = 0; i < kMostIterations; ++i) {
    most = largest_change = 0;
    for (const Limited& limited : limited_) {
      const bool is_there = rows == Rows::kAll || !guarded_[limited.row].is_of_engine;
      change(limited.row, is_there ? std::clamp(wanted(limited.row), limited.least, limited.most) : 0);
    }
    for (const Touch& touch : touches_) {
      change(touch.normal, std::max(0.0, wanted(touch.normal)));
      Vector2d across(wanted(touch.normal + 1), wanted(touch.normal + 2));
      const double length = across.norm(), limit = touch.friction * guarded_[touch.normal].impulse;
      if (length > limit) across *= limit / length;
      change(touch.normal + 1, across.x());
      change(touch.normal + 2, across.y());
    }
    if (largest_change <= kSettled * most) break;
  }
}

}  // namespace softcell::ppu
