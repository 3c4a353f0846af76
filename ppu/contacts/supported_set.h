#pragma once
// Rigid bodies that touch or are joined, and what they lie on or hang from.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/numbers/skyline_factor.h"
#include "ppu/surfaces/contact_rigid.h"
#include "ppu/surfaces/rigid_links.h"

namespace softcell::ppu {

/// What a soft body is about to do to a rigid one.
struct Press {
  std::uint32_t rigid = 0;  ///< its index; impulses move it
  Eigen::Vector3f point{0, 0, 0};
  Eigen::Vector3f normal{0, 1, 0};    ///< from the rigid body to the soft one
  float mass = 0;                     ///< kg, of what there is of the soft body
  Eigen::Vector3f velocity{0, 0, 0};  ///< m/s, likewise
  float friction = 0;                 ///< of the two together
  float spacing = 0;                  ///< metres, of its cells
};

/// A few rigid bodies. Joints without limits are solved for all at once, as they hold whatever happens; touches and limits one after the other,
/// as what happens decides whether they do. Used by one thread, in the order of its functions. Allocates when there are more bodies, touches or
/// joints than ever before.
class SupportedSet {
 public:
  static constexpr std::size_t kMostTouches = 16;

  /// @param rigids   all there are; stay where they are until give_support()
  /// @param members  the indices of those of the set; impulses move them
  void begin(std::span<ContactRigid> rigids, std::span<const std::uint32_t> members);
  /// Without effect if it is of no member, or there are kMostTouches already. @param step  seconds
  void add(const RigidTouch& touch, float step);
  /// Without effect if it is of no member, or of nothing that members do.
  void add(const JointRow& joint);
  /// Finds which touches the presses on members load, and sets ContactRigid::held of those that are pressed on, and the velocities which
  /// that leaves them. @return whether anything holds them
  bool hold(std::span<const Press> presses, float step);

  /// What a contact has given to a member, kg m/s, at a place in the world. Of others without effect.
  void add_impulse(std::uint32_t rigid, const Eigen::Vector3f& point, const Eigen::Vector3f& impulse);
  /// Gives members the velocities that these impulses make of theirs, as if nothing held them.
  void give_impulses();
  /// After that of all sets: what they lie on or hang from stops them.
  void give_support();

 private:
  static constexpr std::size_t kOutside = ~std::size_t{0};
  using Six = Eigen::Matrix<double, 6, 1>;  // velocity, then spin; or an impulse, then a moment

  struct Member {
    std::uint32_t rigid = 0;
    bool pressed = false;
    Six before;   // its velocity without anything
    Six stands;   // on what it lies on, without soft bodies
    Six now;      // at this point of a solution
    Six impulse;  // of soft bodies
  };
  /// One of the two that a row is of.
  struct Side {
    std::uint32_t rigid = JointRow::kWorld;
    std::size_t member = kOutside;
    Six along =
        Six::Zero();  // the share of velocities that counts for the row, and of impulses that it takes
    Six change = Six::Zero();  // of its velocity by an impulse of 1 kg m/s; 0 of what nothing moves
  };
  /// A touch or a joint in one direction.
  struct Row {
    enum class Kind {
      kTouch,
      kJoint,    // without limits
      kStop,     // a limit of a joint
      kOfEngine  // a motor, or what the program watches: what it bears is left to the engine
    };
    Kind kind = Kind::kTouch;
    Side a, b;
    double outside = 0;   // m/s, of what is no member
    double mobility = 0;  // 1/kg
    double softness = 0;  // likewise, of springs
    double target = 0;    // m/s, of a against b: at least; across: wanted
    double impulse = 0;
    double stands = 0, stands_by = 0;  // m/s and the impulse, where members stand
  };
  /// Which rows of guarded_ are one touch: that along its normal, and the two behind it, across.
  struct Touch {
    std::size_t normal = 0;
    double friction = 0;
  };
  /// A joint's row of guarded_.
  struct Limited {
    std::size_t row = 0;
    double least = 0, most = 0;  // impulses
  };

  std::size_t member_of(std::uint32_t rigid) const;
  Side side(std::uint32_t rigid, const Six& along, Row& of) const;
  Row row(const RigidTouch& touch, const Eigen::Vector3f& direction) const;
  static bool share_member(const Row& one, const Row& other);
  static double coupling(const Row& one, const Row& other);
  template <class RowOf>
  static void factor(SkylineFactor& made, std::size_t n, const RowOf& row_of);
  double speed(const Row& row) const;
  void push(const Row& row, double impulse);
  bool sticks(const Touch& touch) const;
  void find_given_joints();
  void limit_targets(std::span<const Press> presses);
  void solve();
  double wanted(std::size_t row) const;
  void iterate();
  void load(std::span<const Press> presses);
  void find_what_holds();
  double fastest() const;
  double share_of_engine() const;
  template <typename Work>
  void for_each_row(const Work& work);
  void spend();
  void hold_member(std::size_t member);

  std::span<ContactRigid> rigids_;
  std::vector<Member> members_;
  double cell_a_substep_ = 0;  // m/s, of the smallest cells that press
  std::vector<Row> joints_;    // that have no limits
  std::vector<Row> guarded_;   // of touches and limited joints
  std::vector<Touch> touches_;
  std::vector<Limited> limited_;

  // How guarded rows act on each other while joints hold.
  SkylineFactor joints_factor_;
  std::vector<double> joint_change_;  // of each guarded row: impulses of joints by one of it
  std::vector<double> acts_;          // of each pair of guarded rows: m/s by an impulse of 1
  std::vector<double> speed_;         // of each guarded row, m/s
  std::vector<double> joint_impulse_;

  std::vector<Row*> rows_;       // those that hold members: joints, then guarded ones
  std::size_t first_touch_ = 0;  // of rows_
  std::vector<Row*> spent_;      // of motors that are too weak for their load
  bool all_stick_ = true;        // touches of rows_
  SkylineFactor factor_;         // of what impulses of rows_ change of their speeds
  std::vector<double> values_;   // of each of rows_
};

}  // namespace softcell::ppu
