#pragma once
// Finds and solves the contacts of all soft bodies of a world in one substep.

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "ppu/attachments/attachments.h"
#include "ppu/contact_solver/attach_units.h"
#include "ppu/contact_solver/bounces.h"
#include "ppu/contact_solver/contact_groups.h"
#include "ppu/contact_solver/contact_order.h"
#include "ppu/contact_solver/contact_search.h"
#include "ppu/contact_solver/contact_settings.h"
#include "ppu/contact_solver/contact_worker.h"
#include "ppu/contact_solver/crushed_bodies.h"
#include "ppu/contact_solver/group_turns.h"
#include "ppu/contact_solver/held_presses.h"
#include "ppu/contact_solver/hits.h"
#include "ppu/contact_solver/lost_spin.h"
#include "ppu/contact_solver/presses.h"
#include "ppu/contact_solver/rigid_sets.h"
#include "ppu/contact_solver/touched_cells.h"
#include "ppu/contacts/body_in_substep.h"
#include "ppu/contacts/contact_body.h"
#include "ppu/numbers/disjoint_sets.h"
#include "ppu/obstacles/obstacle.h"
#include "ppu/supports/supports.h"

namespace softcell::ppu {

/// A contact of the last step with an impulse above 0.
struct PressingContact {
  std::uint32_t a = 0, b = 0;  ///< bodies; b is unused if the contact is with a rigid body
  bool with_rigid = false;
  std::uint32_t rigid = 0;          ///< if with_rigid: index of the rigid body
  Eigen::Vector3f point{0, 0, 0};   ///< metres
  Eigen::Vector3f normal{0, 1, 0};  ///< from b, or the rigid body, to a
  float impulse = 0;                ///< kg m/s along the normal, above 0
};

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
  bool is_crushed(std::size_t body) const { return crushed_.is_crushed(body); }

  /// Appends the contacts of the last step whose impulse is above 0, in the order of bodies, and then those of bounces and sharp edges.
  void append_contacts(std::vector<PressingContact>& contacts) const;
  /// Islands: sets of bodies that pressed on each other in the last step, directly or through other soft bodies. A body that presses on
  /// rigid ones only is an island of its own.
  void find_islands(DisjointSets& islands) const;
  /// Call it when bodies get other numbers.
  void forget_who_presses() { hits_.forget_who_presses(); }

  ContactSettings settings;
  /// Finds and solves all the contacts that it can; null: this thread finds and solves all. Must outlive the steps.
  ContactWorker* worker = nullptr;
  /// The attachments of these bodies, solved in each round after contacts with moving bodies and before contacts with static ones. Null:
  /// none. Must outlive the steps.
  AttachmentSolver<3>* attachments = nullptr;

 private:
  static constexpr std::size_t kManyAttachments = 16;

  void take_over(std::span<const BodyInSubstep> bodies, float step);
  /// Without contacts, nothing changes the attachments' results between rounds: one round then has the iterations of all.
  int rounds() const { return groups_.empty() ? 1 : settings.rounds; }
  int attachment_iterations() const { return settings.attachment_iterations * settings.rounds / rounds(); }
  void find_supports(std::span<ContactRigid> rigids, const RigidLinks& links, float step);
  void release_supports();
  void bounce(std::span<ContactRigid> rigids, float step);
  void solve_here(std::span<ContactRigid> rigids, float step);
  void add_rigid_groups(std::span<const ContactRigid> rigids);
  void prepare_here(std::span<ContactRigid> rigids);
  bool has_attachments() const { return attachments != nullptr && !attachments->empty(); }
  void solve_attachments(std::span<ContactRigid> rigids, float step, int round);
  void begin_attachments(std::span<ContactRigid> rigids, float step);
  void iterate_here(std::span<ContactGroup* const> groups, std::span<ContactRigid> rigids, float step);
  void find_free_bodies();
  void take_back_lost_spin(float step);

  // In contact_solver_worker.cpp:
  bool can_hand_to_worker(const ContactGroup& group) const;
  void find_rigid_sets(std::span<ContactRigid> rigids);
  bool hand_attachments_to_worker(std::size_t rigids);
  void hand_to_worker(ContactGroup& group, std::span<ContactRigid> rigids, float step);
  void add_pairs_to(SolveStages& stages);
  SolveGroup solved_by_worker(const ContactGroup& group) const;
  void add_rigid_sets_to(SolveStages& stages);
  void add_attachments_to(SolveStages& stages, bool ends) const;
  void add_bodies_to(SolveStages& stages, float stiffening);
  bool share_with_worker(std::span<ContactRigid> rigids, float step);
  void solve_in_between(std::span<ContactRigid> rigids, float step, int round, float stiffening,
                        bool with_attachments);
  void solve_with_worker(std::span<ContactRigid> rigids, float step);
  bool changed_by_worker(std::uint32_t body) const {
    return worker->holds(body) && (!touched_.of(body).empty() || attach_units_.hold(body));
  }
  void take_from_worker();
  void give_to_worker();

  std::vector<ContactBody> bodies_;
  std::vector<float> nothing_moves_;  // inverse masses of bodies that sleep: zeros
  CrushedBodies crushed_;
  HeldPresses held_presses_;

  ContactSearch search_;
  ContactGroups groups_;
  std::vector<ContactOrder::Pair> pairs_;  // of the groups of pairs
  ContactOrder order_;                     // of these

  Presses presses_;
  Supports supports_;
  Hits hits_;
  Bounces bounces_;
  GroupTurns turns_;
  TouchedCells touched_;
  std::vector<ContactGroup*> here_;        // groups that this thread solves; the worker solves the others
  std::size_t here_that_move_ = 0;         // how many of them, the first ones, have moving bodies only
  std::vector<AttachedBody<3>> attached_;  // bodies_ in the form that attachments use

  RigidSets rigid_sets_;
  std::vector<ContactGroup*> of_set_;  // groups with rigid bodies of one set
  AttachUnits attach_units_;
  SolveStages stages_;

  DisjointSets islands_;       // for find_free_bodies()
  std::vector<bool> is_free_;  // likewise, of each body
  LostSpin lost_spin_;
};

}  // namespace softcell::ppu
