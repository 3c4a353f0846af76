#pragma once
// Finds and solves the contacts of all soft bodies of a world in one substep.

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/contacts/attach_units.h"
#include "ppu/contacts/attachments.h"
#include "ppu/contacts/bounces.h"
#include "ppu/contacts/contact_body.h"
#include "ppu/contacts/contact_group.h"
#include "ppu/contacts/contact_order.h"
#include "ppu/contacts/contact_worker.h"
#include "ppu/contacts/crushed_cells.h"
#include "ppu/contacts/end_cells.h"
#include "ppu/contacts/lost_spin.h"
#include "ppu/contacts/rigid_sets.h"
#include "ppu/contacts/sharp_contacts.h"
#include "ppu/contacts/supports.h"
#include "ppu/contacts/swept_contacts.h"
#include "ppu/numbers/disjoint_sets.h"
#include "ppu/surfaces/obstacle.h"
#include "softcell/soft_bodies/contact.h"

namespace softcell::ppu {

/// A soft body and the obstacles near it.
struct BodyInSubstep {
  const ContactModel* model = nullptr;
  std::span<const Eigen::Vector3f> positions = {};   ///< of its particles, metres
  std::span<const Eigen::Vector3f> velocities = {};  ///< m/s, with the gravity of the substep included
  float friction = 0.5f;
  float restitution = 0;
  Bounds<3> box = {};                         ///< box_of_step()
  std::vector<std::uint32_t> obstacles = {};  ///< indices of obstacles that it may meet
  KnownSides* sides = nullptr;                ///< what the body remembers from substep to substep; not null
  bool asleep = false;                        ///< contacts do not move it
  CollisionFilter filter = {};                ///< towards other soft bodies
  bool self_contacts = true;                  ///< SoftBodySettings::self_contacts
};

/// A contact of the last step with an impulse above 0.
struct PressingContact {
  std::uint32_t a = 0, b = 0;  ///< bodies; b is unused if the contact is with a rigid body
  bool with_rigid = false;
  std::uint32_t rigid = 0;          ///< if with_rigid: index of the rigid body
  Eigen::Vector3f point{0, 0, 0};   ///< metres
  Eigen::Vector3f normal{0, 1, 0};  ///< from b, or the rigid body, to a
  float impulse = 0;                ///< kg m/s along the normal, above 0
};

/// Many rounds with few iterations of each group, so that impulses of one group reach the others soon. With two rounds of four, and a
/// stiffening of a half, heaps never came to rest (docs/notes/performance.md).
struct ContactSettings {
  int rounds = 4;                 ///< number of passes over all groups
  int iterations = 3;             ///< iterations of each group in a round
  int heavy_iterations = 8;       ///< the same for a group of a body with a heavier rigid one
  int attachment_iterations = 4;  ///< over all attachments, in a round
  /// 0..1: the share of their relative motion that corners of touched cells lose after each round but the last.
  float stiffening = 0.35f;
  BounceSettings bounces = {};
};

/// A box around particles and their places after `step` seconds. @pre there is at least one
Bounds<3> box_of_step(std::span<const Eigen::Vector3f> positions, std::span<const Eigen::Vector3f> velocities,
                      float step);

/// Used by one thread.
class ContactSolver {
 public:
  /// Finds the contacts that bodies would have within `step` seconds and solves them: particles then move by step (v + push). Velocities of
  /// rigid bodies change, too.
  /// @throws std::runtime_error  a body is not finite, or 1e15 m large or far away.
  /// @param links  of rigid bodies with each other and with static ones; not those of attachments
  void step(std::span<const BodyInSubstep> bodies, std::span<const Obstacle> obstacles,
            std::span<ContactRigid> rigids, const RigidLinks& links, float step);

  /// Velocities of a body after the last step, m/s; those of a sleeping body have not changed.
  std::span<const Eigen::Vector3f> velocities(std::size_t body) const { return bodies_[body].velocities; }
  /// Velocities, m/s, that move the body's particles out of penetration, in that step only.
  std::span<const Eigen::Vector3f> pushes(std::size_t body) const { return bodies_[body].pushes; }

  /// Whether some of its cells were crushed. What its velocities still crush, its pushes give back, so that they do not tell how it moves.
  bool is_crushed(std::size_t body) const { return is_crushed_[body]; }

  /// Appends the contacts of the last step whose impulse is above 0, in the order of bodies, and then those of bounces and sharp edges.
  void append_contacts(std::vector<PressingContact>& contacts) const;
  /// Islands: sets of bodies that pressed on each other in the last step, directly or through other soft bodies. A body that presses on
  /// rigid ones only is an island of its own.
  void find_islands(DisjointSets& islands) const;
  /// Call it when bodies get other numbers.
  void forget_who_presses() { pressed_.clear(); }

  ContactSettings settings;
  /// Finds and solves all the contacts that it can; null: this thread finds and solves all. Must outlive the steps.
  ContactWorker* worker = nullptr;
  /// The attachments of these bodies, solved in each round after contacts with moving bodies and before contacts with static ones. Null:
  /// none. Must outlive the steps.
  AttachmentSolver<3>* attachments = nullptr;

 private:
  /// What crushed cells have done to a body, apart from contacts.
  struct Crushed {
    std::uint32_t body = 0;
    Eigen::Vector3d moment{0, 0, 0};      ///< CrushedCells::moment()
    std::vector<Eigen::Vector3f> pushes;  ///< m/s
  };
  /// The contacts of a pair of bodies, as seen from a, or of one body with rigid ones.
  struct Group {
    std::uint32_t a = 0, b = 0;
    bool with_rigid = false;
    bool by_worker = false;  ///< the worker solves them: they are in `solved`
    bool heavy = false;      ///< with a rigid body that is heavier than a
    /// It alternates with groups that touch the same light rigid body: one iteration each in turn.
    bool alternates = false;
    bool fast = false;     ///< the two bodies may pass through each other in the substep
    bool sharp = false;    ///< some of its contacts limit how far a moves on as a whole
    bool on_held = false;  ///< some of its contacts are SoftContact::on_held: the worker ignores that
    std::vector<SoftContact> contacts;  ///< found here
    FoundContacts solved;
    /// The worker's set of rigid bodies; kNone: impulses do not move the rigid bodies.
    std::uint32_t rigid_set = RigidSets::kNone;
    std::size_t size() const { return by_worker ? solved.contacts.size() : contacts.size(); }
    /// The impulse on the soft body of a contact with a rigid one, kg m/s.
    Eigen::Vector3f whole_impulse(std::size_t contact) const {
      const SoftContact& found = contacts[contact];
      const Eigen::Vector3f friction =
          by_worker ? Eigen::Vector3f(solved.contacts[contact].friction_impulse) : found.friction_impulse;
      return impulse(contact) * found.normal + friction;
    }
    float impulse(std::size_t contact) const {
      return by_worker ? solved.contacts[contact].impulse : contacts[contact].impulse;
    }
  };
  /// A rigid body that presses on held particles at some points.
  struct HeldPress {
    std::uint32_t rigid = 0;  ///< index
    int contacts = 0;
    int contacts_of_body = 0;                           ///< how many of them with one soft body
    Eigen::Vector3f points{0, 0, 0}, normals{0, 0, 0};  ///< sums
    /// kg m/s: that body's share of one impulse in the middle of the points.
    float impulse_to_stop(const ContactRigid& by, const Eigen::Vector3f& held_velocity) const;
  };
  using Pair = ContactOrder::Pair;
  static constexpr std::size_t kManyAttachments = 16;

  void remember_crushed(std::uint32_t body);
  void take_over(std::span<const BodyInSubstep> bodies, float step);
  void find_held(std::span<const ContactRigid> rigids, float step);
  void find_pairs(std::span<const BodyInSubstep> bodies);
  bool may_touch(std::uint32_t a, std::uint32_t b, std::span<const BodyInSubstep> bodies) const;
  void hold_by_own_cells(Group& group);
  void find_here(Group& group, float step);
  void find_among_bodies(float step);
  void find_with_rigid(std::span<const BodyInSubstep> bodies, std::span<const Obstacle> obstacles,
                       std::span<const ContactRigid> rigids, float step);
  Group& next_group(std::uint32_t a, std::uint32_t b, bool with_rigid);
  void put_in_order();
  /// Without contacts, nothing changes the attachments' results between rounds: one round then has the iterations of all.
  int rounds() const { return group_count_ == 0 ? 1 : settings.rounds; }
  int attachment_iterations() const { return settings.attachment_iterations * settings.rounds / rounds(); }
  int iterations_of(const Group& group) const {
    return group.heavy ? settings.heavy_iterations : settings.iterations;
  }
  void hold_pushes_of_crushed_bodies();
  void hold_pushes_by_friction(const Group& group, std::span<const ContactRigid> rigids);
  void find_presses(const Group& group, std::span<const ContactRigid> rigids);
  void find_supports(std::span<ContactRigid> rigids, const RigidLinks& links, float step);
  void release_supports();
  void find_who_feels_what_holds(std::span<const ContactRigid> rigids);
  HeldPress& held_press_of(std::uint32_t rigid);
  void add_held_presses(const Group& group);
  bool breaks_what_holds(const Group& group, std::span<const ContactRigid> rigids);
  void press_on_attachments(std::uint32_t body, const Anchor& anchor, float impulse);
  void bounce(std::span<ContactRigid> rigids, float step);
  void remember_who_presses(std::span<const ContactRigid> rigids);
  void find_touched_cells();
  void stiffen_touched_cells();
  void solve_here(std::span<ContactRigid> rigids, float step);
  void weigh_rigid_groups(std::span<const ContactRigid> rigids);
  void add_rigid_groups(std::span<const ContactRigid> rigids);
  void prepare_here(std::span<ContactRigid> rigids);
  bool has_attachments() const { return attachments != nullptr && !attachments->empty(); }
  void solve_attachments(std::span<ContactRigid> rigids, float step, int round);
  void begin_attachments(std::span<ContactRigid> rigids, float step);
  /// Calls work(group, iterations). Groups that alternate come after the others.
  template <typename Work>
  void for_each_turn(std::span<Group* const> groups, const Work& work) const {
    int turns = 0;
    for (Group* const group : groups) {
      if (group->alternates)
        turns = std::max(turns, iterations_of(*group));
      else
        work(*group, iterations_of(*group));
    }
    for (int i = 0; i < turns; ++i)
      for (Group* const group : groups)
        if (group->alternates && i < iterations_of(*group)) work(*group, 1);
  }
  void iterate_here(std::span<Group* const> groups, std::span<ContactRigid> rigids, float step);
  void find_free_bodies();
  void take_back_lost_spin(float step);

  // In contact_solver_worker.cpp:
  bool can_hand_to_worker(const Group& group) const;
  void find_rigid_sets(std::span<ContactRigid> rigids);
  bool hand_attachments_to_worker(std::size_t rigids);
  void hand_to_worker(Group& group, std::span<ContactRigid> rigids, float step);
  void add_pairs_to(SolveStages& stages);
  SolveGroup solved_by_worker(const Group& group) const;
  void add_rigid_sets_to(SolveStages& stages);
  void add_attachments_to(SolveStages& stages, bool ends) const;
  void add_bodies_to(SolveStages& stages, float stiffening);
  bool share_with_worker(std::span<ContactRigid> rigids, float step);
  void solve_in_between(std::span<ContactRigid> rigids, float step, int round, float stiffening,
                        bool with_attachments);
  void solve_with_worker(std::span<ContactRigid> rigids, float step);
  bool changed_by_worker(std::uint32_t body) const {
    return worker->holds(body) && (!touched_[body].empty() || attach_units_.hold(body));
  }
  void take_from_worker();
  void give_to_worker();

  std::vector<ContactBody> bodies_;
  std::vector<float> nothing_moves_;  // inverse masses of bodies that sleep: zeros
  std::vector<EndCells> cells_;       // of each body
  std::vector<std::uint32_t> by_low_;
  std::vector<Pair> pairs_, asked_;     // asked_: pairs for the worker
  std::vector<SoftContact> other_way_;  // points of b in a
  SweptContacts swept_;
  std::vector<Group> groups_;  // groups of pairs, then groups with rigid bodies
  std::size_t group_count_ = 0;
  std::size_t pair_groups_ = 0;                      // how many of them are of pairs
  ContactOrder order_;                               // of the groups of pairs
  std::vector<std::vector<std::uint32_t>> touched_;  // of each body: cells, ascending
  CrushedCells crushed_cells_;
  SharpContacts sharp_contacts_;
  std::vector<bool> is_crushed_;  // of each body: it has crushed cells
  std::vector<Crushed> crushed_;  // the first crushed_count_ are used
  std::size_t crushed_count_ = 0;
  DisjointSets islands_;             // for find_free_bodies()
  std::vector<bool> is_free_;        // likewise, of each body
  std::vector<float> moved_by_all_;  // of each pressing particle, by an impulse of 1 at each point
  std::vector<Press> presses_;
  Supports supports_;
  RigidSets rigid_sets_;
  AttachUnits attach_units_;
  Bounces bounces_;
  // Of the last substep: body a; body b or the number of the rigid body; whether it is a rigid one.
  std::vector<std::array<std::uint32_t, 3>> pressed_;
  std::vector<Group*> here_;        // groups that this thread solves; the worker solves the others
  std::size_t here_that_move_ = 0;  // how many of them, the first ones, have moving bodies only
  /// Which groups touch a rigid body that moves.
  struct TouchedRigid {
    static constexpr std::size_t kNobody = ~std::size_t{0};
    std::size_t first = kNobody;  // group
    bool by_several = false;
    float lightest = 0;  // kg, of the soft bodies that touch it
  };
  std::vector<TouchedRigid> touched_rigids_;
  std::vector<Group*> of_set_;  // groups with rigid bodies of one set
  LostSpin lost_spin_;
  std::vector<HeldParticle<3>> held_;
  std::vector<HeldPress> held_presses_;
  std::vector<AttachedBody<3>> attached_;  // bodies_ in the form that attachments use
  SolveStages stages_;
};

}  // namespace softcell::ppu
