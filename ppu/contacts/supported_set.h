#pragma once
// Rigid bodies that touch or are joined, and what they lie on or hang from.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/contacts/link_rows.h"
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

/// A few rigid bodies: which of their touches and joints soft ones load, and what these leave of a body's mobility. Used by one thread, in the
/// order of its functions. Allocates when there are more bodies, touches or joints than ever before.
class SupportedSet {
 public:
  /// @param rigids   all there are; stay where they are until give_support()
  /// @param members  the indices of those of the set; impulses move them
  void begin(std::span<ContactRigid> rigids, std::span<const std::uint32_t> members);
  /// As LinkRows::add(). @param step  seconds
  void add(const RigidTouch& touch, float step) { links_.add(touch, step); }
  void add(const JointRow& joint) { links_.add(joint); }
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
  using Six = LinkRows::Six;
  using Row = LinkRows::Row;
  using Member = LinkRows::Member;
  /// Of a member.
  struct Standing {
    bool pressed = false;
    Six velocity = Six::Zero();  // on what it lies on, without soft bodies
    Six impulse = Six::Zero();   // of soft bodies
  };

  void limit_targets(std::span<const Press> presses);
  void load(std::span<const Press> presses);
  void find_what_holds();
  void spend();
  void keep_standing();
  void hold_member(std::size_t member);
  void load_standing();
  double fastest() const;
  double share_of_engine() const;
  void solve_loaded();
  void solve_without_engine();
  void give_all();
  void give_part();

  LinkRows links_;
  std::vector<Standing> standing_;
  double cell_a_substep_ = 0;    // m/s, of the smallest cells that press
  std::vector<Row*> rows_;       // those that hold members: joints, then guarded ones
  std::size_t first_touch_ = 0;  // of rows_
  std::vector<Row*> spent_;      // of motors that are too weak for their load
  bool all_stick_ = true;        // touches of rows_
  SkylineFactor factor_;         // of rows_
  std::vector<double> values_;   // of each of rows_
};

}  // namespace softcell::ppu
