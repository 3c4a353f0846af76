#pragma once
// Soft bodies in somebody's Box2D world.
//
//     Box2dSoftBodies soft_bodies(world);                      // your b2World
//     SoftBody<2>& man = soft_bodies.add(model, {0, 2});
//     soft_bodies.step(1.0f / 120);                            // in place of world.Step()
//     draw(man.positions());
//
// A soft body touches with its drawn edge: make_skin_2d() with the contact radius of its model, or the skin that add() gets. Box2D does not
// know of the body, so Box2D's rays, overlap tests and contact listeners do not see it; use append_contacts(),
// poll_contact_events() and cast_ray() instead. Box2D alone handles rigid bodies.
//
//     step:  [solver: v] [contacts: v, x += h v, impulses on rigid bodies] [Box2D: rigid bodies]
//
// The thread that steps the world does this work, unless the constructor gets an SpeRuntime (spe_bodies/spe_runtime.h): then the SPEs do.
//
// With ContactMethod::kSpheres, the method of 2008, each outer particle is a b2Body: a circle that cannot rotate (a rolling one would have
// no friction). It collides with everything in the world except its own body. Box2D moves the circles; softcell never writes their
// positions. softcell integrates the inner particles, which nothing can touch.
//
//     step:  [solver: v] [Box2D: collide, solve, x += h v] [gather x v, inner x += h v]
//
// To draw a body: soft_bodies/skin_2d.h.

#include <box2d/b2_world.h>

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "softcell/soft_bodies/attachment.h"
#include "softcell/soft_bodies/contact.h"
#include "softcell/soft_bodies/fracture.h"
#include "softcell/soft_bodies/skin_2d.h"
#include "softcell/soft_bodies/soft_body.h"
#include "softcell/soft_bodies/soft_body_solver.h"
#include "softcell/soft_bodies/soft_body_times.h"
#include "softcell/soft_bodies/solver_factory.h"
#include "softcell/soft_bodies/surface_query.h"

namespace softcell::ppu {

/// A point at which a soft body presses on something.
struct Contact2d {
  Eigen::Vector2f position{0, 0};  ///< metres, in the world
  Eigen::Vector2f normal{0, 1};    ///< unit length, towards `first`
  float impulse = 0;               ///< kg m/s along the normal, in the last step; above 0
  const SoftBody<2>* first = nullptr;
  const SoftBody<2>* second = nullptr;  ///< the other soft body; or null, and it is `rigid`
  b2Body* rigid = nullptr;  ///< the rigid body, which the program may have destroyed since; or null
};

/// A contact event, with the object of Box2D that takes part.
struct ContactEvent2d : SoftContactEvent<2> {
  b2Body* rigid = nullptr;      ///< the rigid body, also of a sensor; or null, and it is `other`
  b2Fixture* sensor = nullptr;  ///< the trigger volume; or null
};

/// The first point at which a ray meets a soft body.
struct SoftRayHit2d {
  const SoftBody<2>* body = nullptr;
  SurfaceHit<2> hit;
};

/// All soft bodies of one world. A world can have only one object of this class: the constructor of a second one throws
/// std::invalid_argument. Used by the thread that steps the world.
/// Box2D has no callback before a step, so step() replaces b2World::Step(). With ContactMethod::kSpheres each body uses a negative
/// collision group, from -1 downwards: a fixture of the caller in that group never collides with the body. If a particle is NaN or
/// infinite, begin_step() throws std::runtime_error.
///
/// Within a step of Box2D, for example in a contact listener, call const functions only: like Box2D's own, the others need a world that is
/// not locked. b2World::ShiftOrigin() does not move soft bodies: call shift_origin() in its place.
class Box2dSoftBodies {
 public:
  /// With ContactMethod::kSpheres a particle moves at most this many cells in one step; faster particles are slowed down, which takes
  /// momentum from their body. This keeps particles from passing through other soft bodies. Box2D's continuous collision keeps them
  /// from passing through walls that do not move.
  static constexpr float kMaxTravelInCells = 1.0f;

  /// @param world  must outlive this object.
  explicit Box2dSoftBodies(b2World& world, ContactMethod contacts = ContactMethod::kSurface);
  /// @param solvers  makes the solver for these bodies; must outlive this object. Usually an SpeRuntime.
  /// @throws std::runtime_error  as SolverFactory::make_solver().
  Box2dSoftBodies(b2World& world, SolverFactory& solvers, ContactMethod contacts = ContactMethod::kSurface);
  /// @param solver  must outlive this object, and serve no other object.
  /// @param worker  for ContactMethod::kSurface: finds and solves contacts if there are many, as SolverFactory makes it; null: the
  ///                thread that steps the world does it
  Box2dSoftBodies(b2World& world, SoftBodySolver<2>& solver, ContactMethod contacts = ContactMethod::kSurface,
                  std::shared_ptr<ContactWorker> worker = nullptr);
  /// Removes all bodies and leaves the world as it was found.
  ~Box2dSoftBodies();
  Box2dSoftBodies(const Box2dSoftBodies&) = delete;
  Box2dSoftBodies& operator=(const Box2dSoftBodies&) = delete;

  /// Adds a body at rest, its model's origin at `position` (metres). The reference is valid until remove(). Between steps you
  /// may change the body through its own functions; the next step sees the change. When a body of another model is
  /// assigned to it, its attachments end.
  /// @param drawn  how bodies of the model are drawn: their outlines touch. Null: as make_skin_2d() draws them. Only the skin passed
  ///               with the first body of a model counts, and none with ContactMethod::kSpheres. It need not outlive the call
  /// @throws std::invalid_argument  the model is null; as validate() of the skin and the model's lattice, or the skin has no outlines
  /// @throws std::runtime_error  with ContactMethod::kSpheres there would be more than 32,768 bodies
  /// @pre the position is finite; the skin was made for the model's lattice
  SoftBody<2>& add(std::shared_ptr<const SoftBodyModel<2>> model, const Eigen::Vector2f& position,
                   const Skin2d* drawn = nullptr);

  /// @throws std::invalid_argument  the body is not one of these.
  void remove(const SoftBody<2>& body);

  /// Holds a patch of a body at its present place in the world, which move_attachment() can move.
  ///
  /// begin_step() solves attachments after the shape matching, together with contacts; with ContactMethod::kSpheres before Box2D solves
  /// contacts. The bodies wake, and from then on sleep and wake together. With ContactMethod::kSpheres, softcell installs a contact filter
  /// if attached sides shall not touch. The filter asks the world's own filter first, which softcell restores at the end. A filter that the
  /// caller installs later must call the one that it replaces (b2ContactManager::m_contactFilter).
  /// @throws std::invalid_argument  a body is not one of these; a setting is out of its range; the patch is empty, or too small for this
  /// kind of attachment. The message says what was found and what was expected.
  AttachmentId attach(const SoftBody<2>& body, const Patch<2>& patch,
                      const AttachmentSettings<2>& settings = {});
  /// Holds a patch to a rigid body; to a disabled one as to a static one. When the rigid body is destroyed, the attachment ends with the
  /// next step. Detach it yourself if you create another b2Body before that step: Box2D may reuse the address.
  /// @throws std::invalid_argument  as above; the b2Body is not in the world, or is a particle of a soft body.
  AttachmentId attach(const SoftBody<2>& body, const Patch<2>& patch, b2Body& rigid,
                      const AttachmentSettings<2>& settings = {});
  /// Holds a patch to a patch of another soft body of this object. @throws std::invalid_argument  as above; both are the same body.
  AttachmentId attach(const SoftBody<2>& body, const Patch<2>& patch, const SoftBody<2>& other,
                      const Patch<2>& other_patch, const AttachmentSettings<2>& settings = {});
  /// Ends an attachment. @throws std::invalid_argument  there is no such attachment: it may have ended.
  void detach(AttachmentId id);
  /// Moves the place in the world to which something is attached. The place moves evenly and arrives after `seconds` of simulated time, at
  /// the earliest at the end of the next step.
  /// @param position  metres: the new point of a hinge or rope; of a weld, where the middle of the patch shall be. It lies within the
  ///                  body: attachment_ends().patch says where it is now
  /// @param angle  radians, counter-clockwise: of the place, relative to its orientation when the patch was attached
  /// @throws std::invalid_argument  there is no such attachment, or it is to a body; a value is not finite; seconds below 0.
  void move_attachment(AttachmentId id, const Eigen::Vector2f& position, float angle = 0, float seconds = 0);
  /// What an attachment did in the last step; no value if it has ended.
  std::optional<AttachmentState<2>> attachment(AttachmentId id) const;
  /// Where an attachment's ends are now; no value if it has ended.
  std::optional<AttachmentEnds<2>> attachment_ends(AttachmentId id) const;
  /// The attachments that have broken or lost a body since the last call, but not those that detach() ended.
  std::vector<EndedAttachment> poll_ended_attachments();

  /// Cuts a body as it is now, whether it has a fracture or not (soft_bodies/fracture.h). The body becomes its largest piece and wakes.
  ///
  /// An attachment continues with the piece that has all particles of its patch, each of them once; if no piece has, it ends. New bodies
  /// have the collision filter of the body and follow all others in operator[]. With ContactMethod::kSpheres the body gets new b2Bodies;
  /// joints of its old ones end. Circles of two pieces that overlap do not collide until they have been apart; softcell installs a contact
  /// filter for that, as attach() does.
  /// @return the other pieces that stay (Fracture::least_cells); valid until remove()
  /// @throws std::invalid_argument  the body is not one of these; the cut is not finite or has no length.
  /// @throws std::runtime_error     there would be more than 32,768 bodies; nothing has changed then
  std::vector<SoftBody<2>*> cut(const SoftBody<2>& body, const Cut2d& where);
  /// The same without a stall: the body stays whole for some steps, like one that breaks (below), and poll_broken() returns its pieces. If
  /// the body is already breaking, that is finished first.
  /// @return whether the cut meets the body   @throws std::invalid_argument, std::runtime_error  as cut()
  bool begin_cut(const SoftBody<2>& body, const Cut2d& where);
  /// The bodies that have broken or were cut since the last call, in the order in which that happened, without those that were removed
  /// since. A body with a SoftBodySettings::fracture is tested at the end of each step in which it is awake. A body of up to 100 particles
  /// has its pieces at once. A larger one stays whole for 2 more steps, and one for each 1,000 particles, while another thread makes its
  /// pieces. With ContactMethod::kSpheres a body stays whole while its pieces would make more than 32,768 bodies.
  std::vector<BrokenSoftBody2d> poll_broken();
  /// Whether the body is still whole and will break into pieces. Assigning to the body, or resetting its shape, prevents that.
  /// @throws std::invalid_argument  the body is not one of these
  bool is_breaking(const SoftBody<2>& body) const;

  /// One step of the world and its soft bodies.
  /// @param step  seconds, the same in every step: a body's stiffness depends on it unless its settings have a frequency, and a step much
  ///              shorter or longer than the one before throws bodies up. 0 changes nothing, as in b2World::Step().
  /// @param velocity_iterations,position_iterations  as b2World::Step() takes them
  /// @throws std::invalid_argument  the step is negative or not finite.
  void step(float step, int velocity_iterations = 8, int position_iterations = 3);

  /// The first half of step(), for a program that calls b2World::Step() itself between both halves, with the same length.
  /// @param step  as step()
  /// @throws std::invalid_argument, std::runtime_error  as step(); then do not call end_step()
  /// @pre end_step() was called after the last begin_step(), and b2World::Step() is not running
  void begin_step(float step);
  /// The second half of step(). @param step  as in begin_step()  @pre begin_step() was called, and b2World::Step() is not running
  void end_step(float step);

  /// Lets the solver begin the next step, of `step` seconds, while the caller does something else. If bodies change after
  /// all, or the step has another length, softcell discards that work and does it again. The result is the same, except
  /// for what SoftBodySolver::drop() says of rotations. Call it between steps. A step of 0 s begins nothing.
  /// @throws std::invalid_argument  the step is negative or not finite
  void begin_ahead(float step);

  /// Moves the origin of the world with all that is in it, as b2World::ShiftOrigin() does, which this calls: soft bodies and the places in
  /// the world that attachments hold them at move with it, and nothing is pushed, woken or torn.
  /// @param new_origin  metres, in the coordinates until now   @throws std::invalid_argument  it is not finite.
  void shift_origin(const Eigen::Vector2f& new_origin);

  /// Lets bodies at rest sleep, or never (std::nullopt, the default). Bodies that touch each other or are connected by
  /// joints fall asleep together, soft ones and rigid ones; each of them must be slow and allowed to sleep. A sleeping body
  /// wakes when something that moves comes to it, when what it lay on is removed, moved, disabled, made a sensor or changed in
  /// shape or filter, when gravity changes, when its user changes it, and when Box2D wakes one of its circles.
  /// @throws std::invalid_argument  a setting is out of its range
  void let_sleep(const std::optional<SleepSettings>& settings);

  /// Appends the contacts at which soft bodies that touch with their drawn edges pressed on something in the last step.
  /// Contacts of circles are in Box2D's own list.
  void append_contacts(std::vector<Contact2d>& contacts) const;

  /// Sets what a body may touch: fixtures, whose category and mask bits count, and other soft bodies; without a call it may touch all
  /// groups. The body wakes, and so do bodies that may lie on it.
  /// @throws std::invalid_argument  the body is not one of these.
  void set_filter(const SoftBody<2>& body, const CollisionFilter& filter);

  /// Switches contact events on or off for bodies that touch with their drawn edges. They are off by default and cost nothing then. For
  /// circles use one of Box2D's listeners.
  void watch_contacts(bool watch);
  /// The contacts that have begun, continued or ended since the last call: one event for each pair of bodies, in the order in which bodies
  /// were added. A pair of bodies that both sleep has no events until one of them wakes.
  ///
  /// A sensor fixture is a trigger volume: the events say which bodies, awake or asleep, are in it. Its collision filter counts. An edge or
  /// chain has no inside: a body is in such a volume if the edge cuts it.
  std::vector<ContactEvent2d> poll_contact_events();

  /// The first point at which the line from `from` to `to` (metres) meets the drawn edge of one of these bodies, from inside or outside.
  /// Each body near the line costs some microseconds; a body with circles costs more, as its skin has to be made. For many rays keep a
  /// SurfaceQuery for each body.
  /// @param filter  the ray passes through bodies that may not touch something with this filter  @pre from and to are finite
  std::optional<SoftRayHit2d> cast_ray(const Eigen::Vector2f& from, const Eigen::Vector2f& to,
                                       const CollisionFilter& filter = {}) const;

  /// The time that these bodies have taken inside step(), begin_step(), end_step() and begin_ahead().
  SoftBodyTimes times() const;

  /// Counts the crushed cells of the bodies that touch with their drawn edges. Each call looks at all of their cells as they are now.
  /// softcell keeps crushed cells from being pressed further and pushes them back. If there are many for long, a body is
  /// too soft or too light for what lies on it.
  CrushedCellCount crushed_cells() const;

  std::size_t size() const;  ///< number of soft bodies
  /// The bodies in the order of add(). @throws std::out_of_range  there are not so many
  SoftBody<2>& operator[](std::size_t index);
  /// The same.
  const SoftBody<2>& operator[](std::size_t index) const;

  /// A particle of one of the soft bodies.
  struct Particle {
    const SoftBody<2>* body = nullptr;  ///< null: no particle
    std::size_t number = 0;             ///< of the particle in its body
  };
  /// For contact listeners, with ContactMethod::kSpheres: the particle that a b2Body stands for. For other b2Bodies the result has no body.
  Particle particle_of(const b2Body& body) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace softcell::ppu
