#include "ppu/supports/supported_set.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace softcell::ppu {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// Cells in a substep: contacts that let a member move farther did not hold it.
constexpr double kHeld = 0.1;
// As a share of the motion without contacts: a member that moves less was held.
constexpr double kLeft = 0.1;
// Cells in a substep: how far engines may let joined bodies move under what soft bodies do to them, before light bodies give way.
constexpr double kEngineBears = 0.03;
// The share of what joints do to members that nothing presses on, which includes their correction of errors. Engines find the rest by
// themselves.
constexpr double kGivenOfStanding = 0.5;

}  // namespace

void SupportedSet::begin(std::span<ContactRigid> rigids, std::span<const std::uint32_t> members) {
  links_.begin(rigids, members);
  standing_.assign(members.size(), {});
  rows_.clear(), spent_.clear();
}

/// Limits the joints' targets so that they raise no pressed member by more than kHeld: a chain that its engine lets hang far too long would
/// throw what lies on it into the air.
void SupportedSet::limit_targets(std::span<const Press> presses) {
  links_.move_by_targets();
  double fastest = 0;
  for (const Member& member : links_.members()) fastest = std::max(fastest, member.now.head<3>().norm());
  for (const Press& press : presses) {
    const std::size_t number = links_.member_of(press.rigid);
    if (number == LinkRows::kOutside) continue;
    const Member& member = links_.members()[number];
    const Six normal = LinkRows::direction_at(links_.rigid(member), press.point, press.normal.cast<double>());
    fastest = std::max(fastest, normal.dot(member.now));
  }
  const double most = kHeld * cell_a_substep_;
  if (fastest > most)
    for (Row& row : links_.joints()) row.target *= most / fastest;
}

/// Adds the impulses of soft bodies on members with their present velocities.
void SupportedSet::load(std::span<const Press> presses) {
  for (const Press& press : presses) {
    const std::size_t number = links_.member_of(press.rigid);
    if (number == LinkRows::kOutside) continue;
    Member& member = links_.members()[number];
    standing_[number].pressed = true;
    const Vector3d arm = (press.point - links_.rigid(member).centre).cast<double>();
    const Vector3d relative =
        press.velocity.cast<double>() - member.now.head<3>() - Vector3d(member.now.tail<3>()).cross(arm);
    const Vector3d normal = press.normal.cast<double>();
    const double approach = -normal.dot(relative);
    if (approach <= 0) continue;
    Vector3d sliding = relative + approach * normal;
    const double speed = sliding.norm(), most = double{press.friction} * approach;
    if (speed > most) sliding *= most / speed;
    member.impulse += LinkRows::direction_at(links_.rigid(member), press.point,
                                             double{press.mass} * (sliding - approach * normal));
  }
}

/// Collects joints, stops that are reached, motors that are strong enough, and contacts that are loaded.
void SupportedSet::find_what_holds() {
  for (Row& row : links_.joints()) rows_.push_back(&row);
  for (const LinkRows::Limited& limited : links_.limited()) {
    Row& row = links_.guarded()[limited.row];
    if (row.impulse > limited.least && row.impulse < limited.most)
      rows_.push_back(&row);
    else if (row.impulse != 0)
      spent_.push_back(&row);
  }
  first_touch_ = rows_.size();
  all_stick_ = true;
  for (const LinkRows::Touch& touch : links_.touches()) {
    Row* const rows = &links_.guarded()[touch.normal];
    if (!(rows->impulse > 0)) continue;
    rows_.push_back(rows);
    all_stick_ = all_stick_ && links_.sticks(touch);
    if (links_.sticks(touch)) rows_.insert(rows_.end(), {rows + 1, rows + 2});
  }
}

bool SupportedSet::hold(std::span<const Press> presses, float step) {
  if (links_.empty()) return false;
  cell_a_substep_ = std::numeric_limits<double>::max();
  for (const Press& press : presses)
    if (links_.member_of(press.rigid) != LinkRows::kOutside)
      cell_a_substep_ = std::min(cell_a_substep_, double{press.spacing} / double{step});
  links_.prepare();
  limit_targets(presses);
  links_.solve();
  for (std::size_t i = 0; i < standing_.size(); ++i) standing_[i].velocity = links_.members()[i].now;
  links_.for_each_row([&](Row& row) { row.stands = links_.speed(row), row.stands_by = row.impulse; });
  load(presses);
  links_.solve();
  find_what_holds();
  if (rows_.empty() && spent_.empty()) return false;
  LinkRows::factor(factor_, rows_.size(), [&](std::size_t i) -> const Row& { return *rows_[i]; });
  values_.resize(rows_.size());
  spend();
  for (std::size_t i = 0; i < standing_.size(); ++i)
    if (standing_[i].pressed) hold_member(i);
  for (Member& member : links_.members()) member.impulse.setZero();  // it was an estimate
  return true;
}

/// Sets the velocities that members have if loads use up the whole force of motors, which then hold nothing more.
void SupportedSet::spend() {
  for (std::size_t i = 0; i < standing_.size(); ++i) links_.members()[i].now = standing_[i].velocity;
  if (spent_.empty()) return;
  for (const Row* const row : spent_) links_.push(*row, row->impulse - row->stands_by);
  keep_standing();
  for (std::size_t i = 0; i < rows_.size(); ++i) links_.push(*rows_[i], values_[i]);
}

/// Finds the impulses with which rows keep the speeds that they have without loads.
void SupportedSet::keep_standing() {
  for (std::size_t i = 0; i < rows_.size(); ++i) values_[i] = rows_[i]->stands - links_.speed(*rows_[i]);
  factor_.solve(values_);
}

void SupportedSet::hold_member(std::size_t number) {
  const Member& member = links_.members()[number];
  ContactRigid& rigid = links_.rigid(member);
  const auto change_by = [&](const Row& row) -> Six {
    Six change = Six::Zero();
    for (const LinkRows::Side* const side : {&row.a, &row.b})
      if (side->member == number) change += side->change;
    return change;
  };
  Eigen::Matrix<double, 6, 6> mobility;
  for (int axis = 0; axis < 6; ++axis) {
    // The changes of the rows' speeds by an impulse equal the changes of the member by the rows' impulses.
    for (std::size_t i = 0; i < rows_.size(); ++i) values_[i] = change_by(*rows_[i])[axis];
    factor_.solve(values_);
    Six change = LinkRows::change_of_free(rigid, Six::Unit(axis));
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
  const std::size_t number = links_.member_of(rigid);
  if (number == LinkRows::kOutside) return;
  Member& member = links_.members()[number];
  member.impulse += LinkRows::direction_at(links_.rigid(member), point, impulse.cast<double>());
}

void SupportedSet::give_impulses() {
  for (const Member& member : links_.members()) {
    ContactRigid& rigid = links_.rigid(member);
    const Six velocity = member.before + LinkRows::change_of_free(rigid, member.impulse);
    rigid.held.reset();
    rigid.velocity = velocity.head<3>().cast<float>();
    rigid.spin = velocity.tail<3>().cast<float>();
  }
}

/// m/s: how much the holding contacts' speeds differ from those without loads.
double SupportedSet::fastest() const {
  double most = 0;
  for (const Row* const row : std::span(rows_).subspan(first_touch_))
    most = std::max(most, std::abs(links_.speed(*row) - row->stands));
  return most;
}

/// The engine's share of what soft bodies do to joints. An engine that sees none of it corrects errors of joints as if nothing lay on them,
/// and so presses the joined bodies into soft ones; one that sees all of it lets light bodies give way in part.
double SupportedSet::share_of_engine() const {
  double mass = 0;
  Vector3d impulse = Vector3d::Zero();
  for (const Member& member : links_.members()) {
    mass += 1 / double{links_.rigid(member).inverse_mass};
    impulse += member.impulse.head<3>();
  }
  const double most = kEngineBears * cell_a_substep_ * mass;
  return impulse.norm() > most ? most / impulse.norm() : 1;
}

/// Sets members' velocities with the impulses of soft bodies, if rows do no more than without loads.
void SupportedSet::load_standing() {
  for (std::size_t i = 0; i < standing_.size(); ++i) {
    Member& member = links_.members()[i];
    member.now = standing_[i].velocity + LinkRows::change_of_free(links_.rigid(member), member.impulse);
  }
  links_.for_each_row([](Row& row) { row.impulse = row.stands_by; });
}

/// Solves members and rows with the loads of soft bodies.
void SupportedSet::solve_loaded() {
  load_standing();
  const double falls = fastest();
  links_.solve();
  // Contacts of soft bodies were solved as if nothing moved along these rows. A small motion there, for example of a table on many legs, is
  // only what iterations have left. And a crate of a hundredth of the soft bodies' mass would fly away with the impulse from them if it
  // then slides or is lifted. In both cases the supports hold their bodies for this substep.
  const double moves = fastest();
  if (moves > kHeld * cell_a_substep_ || (all_stick_ && moves < kLeft * falls)) {
    load_standing();
    keep_standing();
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      rows_[i]->impulse += values_[i];
      links_.push(*rows_[i], values_[i]);
    }
  }
}

/// Solves members without loads, and then with the loads of soft bodies, as if the rows that are left to the engine did not exist.
void SupportedSet::solve_without_engine() {
  for (std::size_t i = 0; i < standing_.size(); ++i)
    standing_[i].impulse = std::exchange(links_.members()[i].impulse, Six::Zero());
  links_.solve(LinkRows::Rows::kWithoutThoseOfEngine);
  for (std::size_t i = 0; i < standing_.size(); ++i) {
    standing_[i].velocity = links_.members()[i].now;
    links_.members()[i].impulse = standing_[i].impulse;
  }
  links_.solve(LinkRows::Rows::kWithoutThoseOfEngine);
}

void SupportedSet::give_support() {
  if (links_.has_rows_of_engine())
    solve_without_engine();
  else
    solve_loaded();
  if (links_.has_joints())
    give_part();
  else
    give_all();
}

void SupportedSet::give_all() {
  links_.for_each_row([&](const Row& row) {
    for (const LinkRows::Side* const side : {&row.a, &row.b}) {
      if (side->member == LinkRows::kOutside) continue;
      ContactRigid& rigid = links_.rigid(links_.members()[side->member]);
      const Six change = row.impulse * side->change;
      rigid.velocity += change.head<3>().cast<float>();
      rigid.spin += change.tail<3>().cast<float>();
    }
  });
}

/// Gives the sums for each member, not each row's impulse: if joints contradict each other, these impulses are large and cancel.
void SupportedSet::give_part() {
  const double left = share_of_engine();
  for (std::size_t i = 0; i < standing_.size(); ++i) {
    const Member& member = links_.members()[i];
    ContactRigid& rigid = links_.rigid(member);
    const Six standing = standing_[i].velocity - member.before;
    const Six by_soft = member.now - standing_[i].velocity - LinkRows::change_of_free(rigid, member.impulse);
    const Six given = kGivenOfStanding * standing + (1 - left) * by_soft;
    rigid.velocity += given.head<3>().cast<float>();
    rigid.spin += given.tail<3>().cast<float>();
  }
}

}  // namespace softcell::ppu
