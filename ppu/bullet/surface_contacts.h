#pragma once
// Handles the contacts of all soft bodies of a BulletSoftBodies that touch with their surfaces.

#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "ppu/bodies/known_models.h"
#include "ppu/bullet/bullet_links.h"
#include "ppu/bullet/bullet_obstacles.h"
#include "ppu/bullet/surface_attachments.h"
#include "ppu/bullet/surface_body.h"
#include "ppu/contact_solver/contact_solver.h"
#include "ppu/contacts/touch_log.h"
#include "ppu/numbers/disjoint_sets.h"
#include "ppu/surfaces/cell_finder.h"
#include "softcell/bullet/bullet_soft_bodies.h"

namespace softcell::ppu {

/// Used by the thread that steps the world.
class SurfaceContacts {
 public:
  /// @param worker  finds and solves contacts; null: the thread that steps the world does it
  SurfaceContacts(btDiscreteDynamicsWorld& world, std::shared_ptr<ContactWorker> worker)
      : world_(world), worker_(std::move(worker)) {
    solver_.worker = worker_.get();
    solver_.attachments = &in_step_;
  }

  /// The data that all bodies of a model share, made at the first call.
  const std::shared_ptr<const ContactModel>& contact_model(
      const std::shared_ptr<const SoftBodyModel<3>>& model);
  /// Keeps a model that was made elsewhere, as if contact_model() had made it.
  void adopt(std::unique_ptr<ContactModel> contact);
  /// Call it when a body has gone or has another model now. Frees the data of a model that no body has any longer, now or in a substep
  /// soon, if it is the model of a piece or nothing else holds it.
  /// @param model  that the body had; need not exist any longer  @pre between substeps
  void forget_model(const SoftBodyModel<3>* model) { models_.forget(model); }

  /// Finds and solves the contacts of the substep that begins, moves all particles of bodies that are awake, and gives rigid bodies their
  /// impulses. Wakes bodies that are touched.
  /// @param bodies  with the velocities at the substep's end without contacts
  void step(std::span<SurfaceBody* const> bodies, float step);

  SurfaceAttachments& attachments() { return attachments_; }
  const SurfaceAttachments& attachments() const { return attachments_; }

  /// Puts bodies to sleep that have been at rest, if everything that they touch has been, too.
  void let_sleep(std::span<SurfaceBody* const> bodies, const SleepSettings& sleep);

  /// Appends the contacts of the last substep whose impulse is above 0.
  void append_contacts(std::vector<Contact>& contacts) const;

  /// Sets whether events are recorded from the next substep on.
  void watch(bool events);
  /// Touches that have begun, gone on or ended since the last call.
  std::vector<ContactEvent> poll_events() { return touches_.poll(); }
  /// Ends the touches of a body that is being removed.
  void forget(const SoftBody<3>& body);

 private:
  using Touch = TouchLog<ContactEvent>::Touch;

  void move(std::span<SurfaceBody* const> bodies, float step);
  void wake_those_in_the_way(std::span<SurfaceBody* const> bodies);
  void find_at_rest(std::span<SurfaceBody* const> bodies);
  void wake_if_disturbed(std::span<SurfaceBody* const> bodies, std::size_t body);
  void wake_those_on_shaken(std::span<SurfaceBody* const> bodies);
  void see_what_is_near(SurfaceBody& sleeper, const BodyInSubstep& in_substep) const;
  template <typename Is>
  bool any_near(const BodyInSubstep& body, const Is& is) const;
  Touch& touch_of(const SurfaceBody& body, TouchedKind kind, const btCollisionObject& object);
  void note_touches(std::span<SurfaceBody* const> bodies);
  void note_triggers(std::span<SurfaceBody* const> bodies, float step);

  btDiscreteDynamicsWorld& world_;
  std::shared_ptr<ContactWorker> worker_;
  KnownModels<3, ContactModel> models_{[this](const ContactModel& contact) {
    if (worker_) worker_->forget(contact);
  }};
  BulletObstacles obstacles_{BulletObstacles::Objects::kSolid};
  BulletLinks links_;
  SurfaceAttachments attachments_{world_};
  Attachments<3> in_step_;
  std::vector<char> near_rigids_;  // for each rigid body: which kind of soft ones are near
  std::vector<bool> at_rest_;      // for each rigid body
  ContactSolver solver_;
  std::vector<BodyInSubstep> in_substep_;
  std::vector<const SoftBody<3>*> softs_;  // of the last substep
  std::vector<std::uint32_t> moving_;      // bodies that wake those in their way
  std::vector<std::size_t> shaken_;        // bodies that wake those on them, as their support has changed
  DisjointSets islands_;                   // of bodies in the last substep
  std::vector<bool> is_restless_;          // of each island
  bool watches_ = false;
  TouchLog<ContactEvent> touches_;
  // Used in each substep while events are recorded:
  std::vector<PressingContact> pressing_;
  BulletObstacles triggers_{BulletObstacles::Objects::kTriggers};
  std::vector<std::uint32_t> near_;  // those of triggers_ near a body
  CellFinder cells_;                 // of a body near a trigger
};

}  // namespace softcell::ppu
