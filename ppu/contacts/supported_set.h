#pragma once
// Rigid bodies that touch each other, and what they lie on.

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/surfaces/contact_rigid.h"

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

/// A few rigid bodies, solved by the matrix of their touches. Used by one thread, in the order of its functions. Allocates when there are
/// more bodies or touches than ever before.
class SupportedSet {
 public:
  static constexpr std::size_t kMostTouches = 16;

  /// @param rigids   all there are; stay where they are until give_support()
  /// @param members  the indices of those of the set; impulses move them
  void begin(std::span<ContactRigid> rigids, std::span<const std::uint32_t> members);
  /// Without effect if it is of no member, or there are kMostTouches already. @param step  seconds
  void add(const RigidTouch& touch, float step);
  /// Finds which touches the presses on members load, and sets ContactRigid::held of those that are pressed on, and the velocities which
  /// that leaves them. @return whether any touch is loaded
  bool hold(std::span<const Press> presses, float step);

  /// What a contact has given to a member, kg m/s, at a place in the world. Of others without effect.
  void add_impulse(std::uint32_t rigid, const Eigen::Vector3f& point, const Eigen::Vector3f& impulse);
  /// Gives members the velocities that these impulses make of theirs, as if nothing held them.
  void give_impulses();
  /// After that of all sets: what they lie on stops them.
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
  /// One of the two that touch.
  struct Side {
    std::uint32_t rigid = 0;
    std::size_t member = kOutside;
    Six along;   // the share of velocities that counts for the row, and of impulses that it takes
    Six change;  // of its velocity by an impulse of 1 kg m/s; 0 of what nothing moves
  };
  /// A touch in one direction.
  struct Row {
    Side a, b;
    double outside = 0;   // m/s, of what is no member
    double mobility = 0;  // 1/kg
    double target = 0;    // m/s, of a against b: at least; across: wanted
    double impulse = 0;
    double stands = 0, stands_by = 0;  // m/s and the impulse, where members stand
  };
  struct Touch {
    Row normal;
    std::array<Row, 2> across;
    double friction = 0;
    bool sticks() const;
  };

  std::size_t member_of(std::uint32_t rigid) const;
  Row row(const RigidTouch& touch, const Eigen::Vector3f& direction) const;
  double speed(const Row& row) const;
  void push(const Row& row, double impulse);
  void iterate();
  void load(std::span<const Press> presses, float step);
  void factor();
  void solve(std::span<double> values) const;
  double fastest() const;
  template <typename Work>
  void for_each_row(const Work& work);
  void hold_member(std::size_t member);

  std::span<ContactRigid> rigids_;
  std::vector<Member> members_;
  std::vector<Touch> touches_;
  std::vector<Row*> rows_;      // of touches_: those that hold members
  bool all_stick_ = true;       // of rows_
  double fastest_ = 0;          // m/s, along rows that hold
  std::vector<double> values_;  // of each row
  std::vector<double> factor_;  // of what impulses of rows change of speeds of rows: lower, row by row
};

}  // namespace softcell::ppu
