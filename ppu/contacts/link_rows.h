#pragma once
// Velocities of rigid bodies that touch or are joined.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/numbers/skyline_factor.h"
#include "ppu/surfaces/contact_rigid.h"
#include "ppu/surfaces/rigid_links.h"

namespace softcell::ppu {

/// A few rigid bodies, and the rows of what touches and joins them. Joints without limits are solved for all at once, as they hold whatever
/// happens; touches, stops and motors one after the other, as what happens decides whether they do. Used by one thread. Allocates when there are
/// more bodies, touches or joints than ever before.
class LinkRows {
 public:
  static constexpr std::size_t kMostTouches = 16;
  static constexpr std::size_t kOutside = ~std::size_t{0};  ///< in the place of a member's index
  using Six = Eigen::Matrix<double, 6, 1>;  ///< velocity, then spin; or an impulse, then a moment

  struct Member {
    std::uint32_t rigid = 0;
    Six before;   ///< its velocity without anything
    Six now;      ///< by solve(), or whatever else was last
    Six impulse;  ///< from outside
  };
  /// One of the two that a row is of.
  struct Side {
    std::size_t member = kOutside;
    Six along = Six::Zero();   ///< what of its velocity counts for the row, and of the row's impulses for it
    Six change = Six::Zero();  ///< of its velocity by an impulse of 1 kg m/s; 0 of what nothing moves
  };
  /// A touch or a joint in one direction.
  struct Row {
    bool is_of_engine = false;  ///< a motor, or what the program watches: what it bears is left to the engine
    Side a, b;
    double outside = 0;   ///< m/s, of what is no member
    double mobility = 0;  ///< 1/kg
    double softness = 0;  ///< likewise, of springs
    double target = 0;    ///< m/s, of a against b: at least; across: wanted
    double impulse = 0;
    double stands = 0, stands_by = 0;  ///< m/s and the impulse, as SupportedSet keeps them
  };
  /// Which of guarded() are one touch: the row along its normal, and the two behind it, across.
  struct Touch {
    std::size_t normal = 0;
    double friction = 0;
  };
  /// Which of guarded() is a joint's.
  struct Limited {
    std::size_t row = 0;
    double least = 0, most = 0;  ///< impulses
  };

  /// @param rigids   all there are; stay where they are until the next call
  /// @param members  the indices of those that rows move; impulses move them
  void begin(std::span<ContactRigid> rigids, std::span<const std::uint32_t> members);
  /// Without effect if it is of no member, or there are kMostTouches already. @param step  seconds
  void add(const RigidTouch& touch, float step);
  /// Without effect if it is of no member, or of nothing that members do.
  void add(const JointRow& joint);
  /// After the last row.
  void prepare();

  bool empty() const { return joints_.empty() && guarded_.empty(); }
  std::span<Member> members() { return members_; }
  std::span<const Member> members() const { return members_; }
  ContactRigid& rigid(const Member& member) const { return rigids_[member.rigid]; }
  /// kOutside: it is none.
  std::size_t member_of(std::uint32_t rigid) const;
  std::span<Row> joints() { return joints_; }    ///< that have no limits and are not of the engine
  std::span<Row> guarded() { return guarded_; }  ///< of touches and limited joints
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
  /// Members' velocities and rows' impulses, by those from outside. Goes on from guarded rows' impulses of before.
  void solve(Rows rows = Rows::kAll);
  /// Members' velocities by what joints want, and nothing else.
  void move_by_targets();
  /// Of a row's two sides against each other, as members move now; along a normal below 0 they come together. m/s.
  double speed(const Row& row) const;
  void push(const Row& row, double impulse);

  /// Of what impulses of some rows change of their speeds. What holds gives way by a millionth. @param row_of  row_of(i), of i < n
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
  /// What an impulse and a moment change of a rigid body that is free.
  static Six change_of_free(const ContactRigid& rigid, const Six& by);
  /// A direction at a point of a rigid body, and how that turns it.
  static Six direction_at(const ContactRigid& rigid, const Eigen::Vector3f& point,
                          const Eigen::Vector3d& direction);

 private:
  // Of a row's own mobility, added to it: four corners of a crate say more than there is to say, and so do joints.
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
  std::vector<double> joint_change_;  // of each guarded row: impulses of joints by one of it
  std::vector<double> acts_;          // of each pair of guarded rows: m/s by an impulse of 1
  std::vector<double> speed_;         // of each guarded row, m/s
  std::vector<double> joint_impulse_;
};

}  // namespace softcell::ppu
