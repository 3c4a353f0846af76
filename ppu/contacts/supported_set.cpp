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
// Of a row's own mobility, added to it: four corners of a crate say more than there is to say, and so do joints. What holds gives way by so much.
constexpr double kGivesWay = 1e-6;
// Of its own mobility, what joints leave of it: below that they hold its members alone.
constexpr double kHeldByJoints = 1e-4;
// Cells in a substep: what moves farther where it was held was not.
constexpr double kHeld = 0.1;
// And of what it would move without: less than that was held.
constexpr double kLeft = 0.1;
// Cells in a substep: by how much engines let what is joined move, of what soft bodies do to it, before light things give way.
constexpr double kEngineBears = 0.03;
// Of the impulses with which joints hold what nothing presses, errors that they take back among them. The rest engines find by themselves.
constexpr double kGivenOfStanding = 0.5;

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
  members_.clear(), joints_.clear(), guarded_.clear(), touches_.clear(), limited_.clear(), rows_.clear(),
      spent_.clear();
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

SupportedSet::Side SupportedSet::side(std::uint32_t rigid, const Six& along, Row& of) const {
  Side made{.rigid = rigid, .member = member_of(rigid), .along = along};
  if (rigid == JointRow::kWorld) return made;
  made.change = change_of_free(rigids_[rigid], along);
  if (made.member == kOutside)
    of.outside += along.dot(velocity_of(rigids_[rigid]));
  else
    of.mobility += along.dot(made.change);
  return made;
}

SupportedSet::Row SupportedSet::row(const RigidTouch& touch, const Vector3f& direction) const {
  const auto along = [&](std::uint32_t rigid, const Vector3f& along_it) {
    return direction_at(rigids_[rigid], touch.point, along_it.cast<double>());
  };
  Row made;
  made.a = side(touch.a, along(touch.a, direction), made);
  made.b = side(touch.b, along(touch.b, -direction), made);
  return made;
}

void SupportedSet::add(const RigidTouch& touch, float step) {
  if (touches_.size() == kMostTouches) return;
  if (member_of(touch.a) == kOutside && member_of(touch.b) == kOutside) return;
  const Vector3f across = touch.normal.unitOrthogonal();
  touches_.push_back({.normal = guarded_.size(), .friction = double{touch.friction}});
  for (const Vector3f& direction : {touch.normal, across, Vector3f(touch.normal.cross(across))})
    guarded_.push_back(row(touch, direction));
  guarded_[touches_.back().normal].target = -std::max(0.0, double{touch.gap}) / double{step};
}

void SupportedSet::add(const JointRow& joint) {
  if (member_of(joint.a) == kOutside && member_of(joint.b) == kOutside) return;
  const auto along = [](const JointRow::Share& share) {
    Six both;
    both << share.linear.cast<double>(), share.angular.cast<double>();
    return both;
  };
  Row made;
  made.a = side(joint.a, along(joint.of_a), made);
  made.b = side(joint.b, along(joint.of_b), made);
  if (!(made.mobility > 0)) return;  // of turning, of bodies that do not turn
  made.softness = double{joint.softness};
  const bool is_motor = joint.is_limited() && joint.least != 0 && joint.most != 0;
  made.kind = joint.is_watched || is_motor ? Row::Kind::kOfEngine
              : joint.is_limited()         ? Row::Kind::kStop
                                           : Row::Kind::kJoint;
  made.target = double{joint.target};
  if (!joint.is_limited()) {
    joints_.push_back(made);
    return;
  }
  limited_.push_back({.row = guarded_.size(), .least = double{joint.least}, .most = double{joint.most}});
  guarded_.push_back(made);
}

bool SupportedSet::sticks(const Touch& touch) const {
  const Row* const rows = &guarded_[touch.normal];
  return Vector2d(rows[1].impulse, rows[2].impulse).norm() < touch.friction * rows[0].impulse;
}

bool SupportedSet::share_member(const Row& one, const Row& other) {
  const auto is_of = [](std::size_t member, const Row& row) {
    return member != kOutside && (row.a.member == member || row.b.member == member);
  };
  return is_of(one.a.member, other) || is_of(one.b.member, other);
}

/// What an impulse of one changes of the speed of the other.
double SupportedSet::coupling(const Row& one, const Row& other) {
  double sum = 0;
  for (const Side* const side : {&one.a, &one.b})
    for (const Side* const by : {&other.a, &other.b})
      if (side->member != kOutside && side->member == by->member) sum += side->along.dot(by->change);
  return sum;
}

template <class RowOf>
void SupportedSet::factor(SkylineFactor& made, std::size_t n, const RowOf& row_of) {
  const auto first = [&](std::size_t i) {
    std::size_t j = 0;
    while (j < i && !share_member(row_of(i), row_of(j))) ++j;
    return j;
  };
  const auto element = [&](std::size_t i, std::size_t j) {
    const Row& row = row_of(i);
    return coupling(row, row_of(j)) + (i == j ? kGivesWay * row.mobility + row.softness : 0);
  };
  made.factor(n, first, element, [&](std::size_t i) { return kGivesWay * row_of(i).mobility; });
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

/// How guarded rows act on each other: less than they would, as joints take a part.
void SupportedSet::find_given_joints() {
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

/// Of joints, so that they raise nothing that is pressed by more than kHeld: a chain that its engine lets hang far too long would throw what
/// lies on it into the air.
void SupportedSet::limit_targets(std::span<const Press> presses) {
  for (std::size_t j = 0; j < joints_.size(); ++j) joint_impulse_[j] = joints_[j].target;
  joints_factor_.solve(joint_impulse_);
  for (Member& member : members_) member.now.setZero();
  for (std::size_t j = 0; j < joints_.size(); ++j) push(joints_[j], joint_impulse_[j]);
  double fastest = 0;
  for (const Press& press : presses) {
    const std::size_t member = member_of(press.rigid);
    if (member == kOutside) continue;
    const Six normal = direction_at(rigids_[press.rigid], press.point, press.normal.cast<double>());
    fastest = std::max(fastest, normal.dot(members_[member].now));
  }
  const double most = kHeld * cell_a_substep_;
  if (fastest > most)
    for (Row& row : joints_) row.target *= most / fastest;
}

/// Velocities of members and impulses of rows, by those of soft bodies.
void SupportedSet::solve() {
  const auto begin = [&] {
    for (Member& member : members_)
      member.now = member.before + change_of_free(rigids_[member.rigid], member.impulse);
  };
  begin();
  for (std::size_t j = 0; j < joints_.size(); ++j) joint_impulse_[j] = joints_[j].target - speed(joints_[j]);
  joints_factor_.solve(joint_impulse_);
  for (std::size_t j = 0; j < joints_.size(); ++j) push(joints_[j], joint_impulse_[j]);
  iterate();
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    joints_[j].impulse = joint_impulse_[j];
    for (std::size_t i = 0; i < guarded_.size(); ++i)
      joints_[j].impulse += joint_change_[i * joints_.size() + j] * guarded_[i].impulse;
  }
  begin();
  for_each_row([&](const Row& row) { push(row, row.impulse); });
}

/// The impulse with which a guarded row would have its target, if nothing limited it.
double SupportedSet::wanted(std::size_t row) const {
  const double acts = acts_[row * (guarded_.size() + 1)];
  return acts > kHeldByJoints * guarded_[row].mobility
             ? guarded_[row].impulse + (guarded_[row].target - speed_[row]) / acts
             : 0;
}

/// Of guarded rows: by impulses that only part what touches, friction, and as far as limits let them.
void SupportedSet::iterate() {
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
    for (const Limited& limited : limited_)
      change(limited.row, std::clamp(wanted(limited.row), limited.least, limited.most));
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

/// With what soft bodies do to members that stand as they do now.
void SupportedSet::load(std::span<const Press> presses) {
  for (const Press& press : presses) {
    const std::size_t number = member_of(press.rigid);
    if (number == kOutside) continue;
    Member& member = members_[number];
    member.pressed = true;
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
}

template <typename Work>
void SupportedSet::for_each_row(const Work& work) {
  for (Row& row : joints_) work(row);
  for (Row& row : guarded_) work(row);
}

/// Joints, limits that are reached, motors that are strong enough, and touches that are loaded.
void SupportedSet::find_what_holds() {
  for (Row& row : joints_) rows_.push_back(&row);
  for (const Limited& limited : limited_) {
    Row& row = guarded_[limited.row];
    if (row.impulse > limited.least && row.impulse < limited.most)
      rows_.push_back(&row);
    else if (row.impulse != 0)
      spent_.push_back(&row);
  }
  first_touch_ = rows_.size();
  all_stick_ = true;
  for (const Touch& touch : touches_) {
    Row* const rows = &guarded_[touch.normal];
    if (!(rows->impulse > 0)) continue;
    rows_.push_back(rows);
    all_stick_ = all_stick_ && sticks(touch);
    if (sticks(touch)) rows_.insert(rows_.end(), {rows + 1, rows + 2});
  }
}

bool SupportedSet::hold(std::span<const Press> presses, float step) {
  if (joints_.empty() && guarded_.empty()) return false;
  cell_a_substep_ = std::numeric_limits<double>::max();
  for (const Press& press : presses)
    if (member_of(press.rigid) != kOutside)
      cell_a_substep_ = std::min(cell_a_substep_, double{press.spacing} / double{step});
  find_given_joints();
  limit_targets(presses);
  solve();
  for (Member& member : members_) member.stands = member.now;
  for_each_row([&](Row& row) { row.stands = speed(row), row.stands_by = row.impulse; });
  load(presses);
  solve();
  find_what_holds();
  if (rows_.empty() && spent_.empty()) return false;
  factor(factor_, rows_.size(), [&](std::size_t i) -> const Row& { return *rows_[i]; });
  values_.resize(rows_.size());
  spend();
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (members_[i].pressed) hold_member(i);
  for (Member& member : members_) member.impulse.setZero();  // that was a guess
  return true;
}

/// Velocities of members with all that motors have, if loads take that: they hold nothing then, as weak ones do not.
void SupportedSet::spend() {
  for (Member& member : members_) member.now = member.stands;
  if (spent_.empty()) return;
  for (const Row* const row : spent_) push(*row, row->impulse - row->stands_by);
  for (std::size_t i = 0; i < rows_.size(); ++i) values_[i] = rows_[i]->stands - speed(*rows_[i]);
  factor_.solve(values_);
  for (std::size_t i = 0; i < rows_.size(); ++i) push(*rows_[i], values_[i]);
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
    factor_.solve(values_);
    Six change = change_of_free(rigid, Six::Unit(axis));
    for (std::size_t i = 0; i < rows_.size(); ++i) change -= values_[i] * change_by(*rows_[i]);
    mobility.col(axis) = change;
  }
  rigid.held = HeldMobility{mobility.topLeftCorner<3, 3>().cast<float>(),
                            mobility.topRightCorner<3, 3>().cast<float>(),
                            mobility.bottomRightCorner<3, 3>().cast<float>()};
  rigid.velocity = member.now.head<3>().cast<float>();
  rigid.spin = member.now.tail<3>().cast<float>();
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

/// m/s: how much touches that hold differ from where members stand.
double SupportedSet::fastest() const {
  double most = 0;
  for (const Row* const row : std::span(rows_).subspan(first_touch_))
    most = std::max(most, std::abs(speed(*row) - row->stands));
  return most;
}

/// Of what soft bodies do to joints. An engine that sees nothing of it takes back errors of joints as if nothing lay on them, and so presses what
/// they hold into soft bodies; one that sees all of it lets light bodies go a part of the way.
double SupportedSet::share_of_engine() const {
  double mass = 0;
  Vector3d impulse = Vector3d::Zero();
  for (const Member& member : members_) {
    mass += 1 / double{rigids_[member.rigid].inverse_mass};
    impulse += member.impulse.head<3>();
  }
  const double most = kEngineBears * cell_a_substep_ * mass;
  return impulse.norm() > most ? most / impulse.norm() : 1;
}

void SupportedSet::give_support() {
  const auto load_standing = [&] {
    for (Member& member : members_)
      member.now = member.stands + change_of_free(rigids_[member.rigid], member.impulse);
    for_each_row([](Row& row) { row.impulse = row.stands_by; });
  };
  load_standing();
  const double falls = fastest();
  solve();
  // Soft bodies have been solved as if nothing moved along these rows. What moves a little there, of a table on many legs, is what iterations
  // have left; and a crate that is a hundredth of them would fly away with what they have got from it, if then it slides or is lifted. In both
  // cases what it lies on keeps it for this substep.
  const double moves = fastest();
  if (moves > kHeld * cell_a_substep_ || (all_stick_ && moves < kLeft * falls)) {
    load_standing();
    for (std::size_t i = 0; i < rows_.size(); ++i) values_[i] = rows_[i]->stands - speed(*rows_[i]);
    factor_.solve(values_);
    for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i]->impulse += values_[i];
  }
  const double left = share_of_engine();
  const auto given = [&](const Row& row) {
    const double by_soft = row.impulse - row.stands_by;
    switch (row.kind) {
      case Row::Kind::kJoint:
        return kGivenOfStanding * row.stands_by + (1 - left) * by_soft;
      case Row::Kind::kStop:
        return (1 - left) * by_soft;
      case Row::Kind::kOfEngine:
        return 0.0;
      default:
        return row.impulse;
    }
  };
  for_each_row([&](const Row& row) {
    const double impulse = given(row);
    for (const Side* const side : {&row.a, &row.b}) {
      if (side->member == kOutside) continue;
      const Six change = impulse * side->change;
      rigids_[side->rigid].velocity += change.head<3>().cast<float>();
      rigids_[side->rigid].spin += change.tail<3>().cast<float>();
    }
  });
}

}  // namespace softcell::ppu
