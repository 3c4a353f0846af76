#pragma once
// A set of rigid bodies that touch or are joined, with the bodies that they lie on or hang from.

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/numbers/skyline_factor.h"
#include "ppu/obstacles/contact_rigid.h"
#include "ppu/obstacles/rigid_links.h"
#include "ppu/supports/link_rows.h"

namespace softcell::ppu {

/// A soft body that is about to press on a rigid one.
struct Press {
  std::uint32_t rigid = 0;  ///< its index; impulses move it
  Eigen::Vector3f point{0, 0, 0};
  Eigen::Vector3f normal{0, 1, 0};    ///< from the rigid body to the soft one
  float mass = 0;                     ///< kg: effective mass of the soft body at that point
  Eigen::Vector3f velocity{0, 0, 0};  ///< m/s, of the soft body at that point
  float friction = 0;                 ///< of the two together
  float spacing = 0;                  ///< metres, of the soft body's cells
};

/// A few rigid bodies. Finds which of their contacts and joints are loaded by soft bodies, and what mobility these leave. Call its
/// functions in order; used by one thread. Allocates when there are more bodies, contacts or joints than ever before.
class SupportedSet {
 public:
  /// @param rigids   all rigid bodies; must stay in place until give_support()
  /// @param members  the indices of those of the set; impulses move them
  void begin(std::span<ContactRigid> rigids, std::span<const std::uint32_t> members);
  /// Adds a contact or joint to the links, as LinkRows::add() does. @param step  seconds
  void add(const RigidTouch& touch, float step) { links_.add(touch, step); }
  void add(const JointRow& joint) { links_.add(joint); }
  /// Finds which contacts and joints the presses on members load. Sets ContactRigid::held of the pressed members, and their velocities with
  /// the loaded rows. @return whether anything holds them
  bool hold(std::span<const Press> presses, float step);

  /// Adds an impulse of a soft body's contact on a member, kg m/s, at a place in the world. Ignored for other rigid bodies.
  void add_impulse(std::uint32_t rigid, const Eigen::Vector3f& point, const Eigen::Vector3f& impulse);
  /// Gives members the velocities that these impulses cause, as if nothing held them.
  void give_impulses();
  /// Call it after give_impulses() of all sets: stops members at the bodies that they lie on or hang from.
  void give_support();

 private:
  using Six = LinkRows::Six;
  using Row = LinkRows::Row;
  using Member = LinkRows::Member;
  /// What is kept for each member.
  struct Standing {
    bool pressed = false;
    Six velocity = Six::Zero();  // with its supports, without soft bodies
    Six impulse = Six::Zero();   // from soft bodies
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
  double cell_a_substep_ = 0;    // m/s: one of the smallest cells that press, per substep
  std::vector<Row*> rows_;       // rows that hold members: joints, then guarded ones
  std::size_t first_touch_ = 0;  // index in rows_
  std::vector<Row*> spent_;      // rows of motors that are too weak for their load
  bool all_stick_ = true;        // no contact of rows_ slides
  SkylineFactor factor_;         // of rows_
  std::vector<double> values_;   // one for each of rows_
};

}  // namespace softcell::ppu
