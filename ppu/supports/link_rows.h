#pragma once
// Solves velocities of a few rigid bodies that touch or are joined.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/numbers/skyline_factor.h"
#include "ppu/obstacles/contact_rigid.h"
#include "ppu/obstacles/rigid_links.h"

namespace softcell::ppu {

/// A few rigid bodies, and the rows of their contacts and joints. Joints without limits are solved all at once, as they always hold;
/// contacts, stops and motors are solved one after the other, as it depends on the motion whether they hold. Used by one thread. Allocates
/// when there are more bodies, contacts or joints than ever before.
class LinkRows {
 public:
  static constexpr std::size_t kMostTouches = 16;
  static constexpr std::size_t kOutside = ~std::size_t{0};  ///< instead of a member's index
  using Six = Eigen::Matrix<double, 6, 1>;  ///< velocity, then spin; or an impulse, then a moment

  struct Member {
    std::uint32_t rigid = 0;
    Six before;   ///< its velocity without any impulse
    Six now;      ///< as solve(), or another function since then, has left it
    Six impulse;  ///< from outside
  };
  /// One of the two sides of a row.
  struct Side {
    std::size_t member = kOutside;
    Six along = Six::Zero();   ///< the row's Jacobian: of the member's velocity and of impulses on it
    Six change = Six::Zero();  ///< of its velocity by an impulse of 1 kg m/s; 0 if nothing moves it
  };
  /// One direction of a contact or a joint.
  struct Row {
    bool is_of_engine = false;  ///< a motor, a spring, or watched by the program: the engine carries its load
    Side a, b;
    double outside = 0;   ///< m/s, contribution of bodies that are no members
    double mobility = 0;  ///< 1/kg
    double softness = 0;  ///< 1/kg, of springs
    double target = 0;    ///< m/s, of a against b: at least; across: exactly
    double impulse = 0;
    double stands = 0, stands_by = 0;  ///< speed (m/s) and impulse without loads, as SupportedSet keeps them
  };
  /// The rows of guarded() of one contact: the row along its normal, and the two behind it, across.
  struct Touch {
    std::size_t normal = 0;
    double friction = 0;
  };
  /// The row of guarded() of a limited joint.
  struct Limited {
    std::size_t row = 0;
    double least = 0, most = 0;  ///< limits of its impulse
  };

  /// @param rigids   all rigid bodies; must stay in place until the next call
  /// @param members  the indices of those that the rows move; impulses move them
  void begin(std::span<ContactRigid> rigids, std::span<const std::uint32_t> members);
  /// Ignored if no member takes part in it, or there are kMostTouches already. @param step  seconds
  void add(const RigidTouch& touch, float step);
  /// Ignored if no member takes part in it, or members cannot move in its direction.
  void add(const JointRow& joint);
  /// Call it after the last row.
  void prepare();

  bool empty() const { return joints_.empty() && guarded_.empty(); }
  std::span<Member> members() { return members_; }
  std::span<const Member> members() const { return members_; }
  ContactRigid& rigid(const Member& member) const { return rigids_[member.rigid]; }
  /// kOutside: it is no member.
  std::size_t member_of(std::uint32_t rigid) const;
  std::span<Row> joints() { return joints_; }    ///< joints without limits that are not left to the engine
  std::span<Row> guarded() { return guarded_; }  ///< rows of contacts and of limited joints
  std::span<const Touch> touches() const { return touches_; }
  std::span<const Limited> limited() const { return limited_; }
  bool sticks(const Touch& touch) const;
  template <typename Work>
  void for_each_row(const Work& work) {
    for (Row& row : joints_) work(row);
    for (Row& row : guarded_) work(row);
  }

  bool has_joints() const { return !joints_.empty() || !limited_.empty(); }
  bool has_rows_of_engine() const { return std::ranges::any_of(guarded_, &Row::is_of_engine); }

  enum class Rows { kAll, kWithoutThoseOfEngine };
  /// Computes members' velocities and rows' impulses from the impulses from outside. Warm start: begins with the guarded rows' last
  /// impulses.
  void solve(Rows rows = Rows::kAll);
  /// Sets members' velocities to those that only the joints' targets cause.
  void move_by_targets();
  /// Relative speed of a row's two sides with the members' present velocities, m/s; along a normal, below 0 is approaching.
  double speed(const Row& row) const;
  void push(const Row& row, double impulse);

  /// Factors the matrix that gives changes of some rows' speeds by impulses of these rows. Each row gives way by a millionth. @param row_of
  /// row_of(i), of i < n
  template <class RowOf>
  static void factor(SkylineFactor& made, std::size_t n, const RowOf& row_of) {
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
  /// The change of velocity of a free rigid body by an impulse and a moment.
  static Six change_of_free(const ContactRigid& rigid, const Six& by);
  /// A direction at a point of a rigid body, with its moment about the centre.
  static Six direction_at(const ContactRigid& rigid, const Eigen::Vector3f& point,
                          const Eigen::Vector3d& direction);

 private:
  // Softness added to a row, as a share of its own mobility: four corners of a crate are more constraints than needed, and so are some
  // joints.
  static constexpr double kGivesWay = 1e-6;

  Side side(std::uint32_t rigid, const Six& along, Row& of) const;
  Row row(const RigidTouch& touch, const Eigen::Vector3f& direction) const;
  static bool share_member(const Row& one, const Row& other);
  static double coupling(const Row& one, const Row& other);
  void begin_from_outside();
  double wanted(std::size_t row) const;
  void iterate(Rows rows);

  std::span<ContactRigid> rigids_;
  std::vector<Member> members_;
  std::vector<Row> joints_, guarded_;
  std::vector<Touch> touches_;
  std::vector<Limited> limited_;

  // How guarded rows act on each other while joints hold.
  SkylineFactor joints_factor_;
  std::vector<double> joint_change_;  // for each guarded row: impulses of the joints by an impulse of 1
  std::vector<double> acts_;          // for each pair of guarded rows: m/s by an impulse of 1
  std::vector<double> speed_;         // for each guarded row, m/s
  std::vector<double> joint_impulse_;
};

}  // namespace softcell::ppu
