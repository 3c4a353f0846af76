#pragma once
// Soft bodies in somebody's Bullet world.
//
//     BulletSoftBodies soft_bodies(world);                     // your btDiscreteDynamicsWorld
//     SoftBody<3>& ball = soft_bodies.add(model, {0, 2, 0});
//     world.stepSimulation(dt, max_substeps, fixed_step);      // as before
//     draw(ball.positions());
//
// The drawn surfaces of soft bodies touch rigid bodies and each other. In every internal substep, before Bullet integrates, shape matching
// changes the velocities of the particles; then softcell finds and solves contacts, which gives rigid bodies their impulses, and moves the
// particles. Bullet does not know the soft bodies:
//
//     substep:  [solver: v] [v += h g] [contacts: v, rigid bodies] [x += h v] [Bullet: collide, solve, integrate]
//
// The thread that steps the world does this work, unless the constructor gets an SpeRuntime:
//
//     SpeRuntime spes;                                         // spe_bodies/spe_runtime.h
//     BulletSoftBodies soft_bodies(world, spes);               // the SPEs do it
//
// With ContactMethod::kSpheres, the method of 2008, each outer particle is a btRigidBody: a small sphere that cannot rotate (a rolling one
// would have no friction). Bullet moves these spheres and solves their contacts with everything else in the world and with other soft
// bodies. softcell never writes their positions, because that would spoil Bullet's contacts. It integrates the inner particles, which
// nothing can touch:
//
//     substep:  [solver: v] [Bullet: collide, solve, x += h v] [gather x v, inner x += h v]
//
// To draw a body's mesh: soft_bodies/skinned_mesh.h, or, by the SPEs, spe_bodies/spe_skinner.h.

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <memory>
#include <optional>
#include <vector>

#include "softcell/soft_bodies/attachment.h"
#include "softcell/soft_bodies/contact.h"
#include "softcell/soft_bodies/fracture.h"
#include "softcell/soft_bodies/soft_body_solver.h"
#include "softcell/soft_bodies/soft_body_times.h"
#include "softcell/soft_bodies/solver_factory.h"
#include "softcell/soft_bodies/surface_query.h"

namespace softcell::ppu {

/// A contact event, with the object of Bullet that takes part.
struct ContactEvent : SoftContactEvent<3> {
  /// The object of Bullet that the body touches, or null. If its hasContactResponse() is false, it is a trigger volume.
  const btCollisionObject* object = nullptr;
};

/// The first point at which a ray meets a soft body.
struct SoftRayHit {
  const SoftBody<3>* body = nullptr;
  SurfaceHit<3> hit;
};

/// The soft bodies of one world. Several objects of this class may share a world; soft bodies of different objects do not touch each other.
/// Links of Bullet's multi-bodies (btMultiBody) pass through soft bodies.
///
/// It installs an internal pre-tick callback and an overlap filter in the world, each of which calls the one that it
/// replaces, and an action. The world's user info stays the caller's own. A callback or filter that the caller installs
/// later must call the one that it replaces, or soft bodies lose their shape. The caller must remove it before the last
/// object of this class is destroyed, because it would call what no longer exists.
///
/// Used by the thread that steps the world. In stepSimulation() it allocates memory only when there are more contacts or
/// obstacles than ever before and when bodies break; Bullet may allocate, too. If a particle is NaN or infinite,
/// stepSimulation() throws std::runtime_error.
class BulletSoftBodies {
 public:
  /// With ContactMethod::kSpheres a particle moves at most this many cells in one substep; faster particles are slowed down, which takes
  /// momentum from their body. Contacts are found before they happen within such a distance, so nothing passes through a floor.
  /// With cells of 0.2 m and substeps of 1/120 s the limit is 24 m/s, the speed after a fall of 29 m.
  static constexpr float kMaxTravelInCells = 1.0f;

  /// @param world  must outlive this object.
  explicit BulletSoftBodies(btDiscreteDynamicsWorld& world, ContactMethod contacts = ContactMethod::kSurface);
  /// @param solvers  makes the solver for these bodies; must outlive this object. Usually an SpeRuntime.
  /// @throws std::runtime_error  as SolverFactory::make_solver().
  BulletSoftBodies(btDiscreteDynamicsWorld& world, SolverFactory& solvers,
                   ContactMethod contacts = ContactMethod::kSurface);
  /// @param solver  must outlive this object, and serve no other object.
  /// @param worker  for ContactMethod::kSurface: finds and solves contacts, as SolverFactory makes it; null: the thread
  ///                that steps the world does it
  BulletSoftBodies(btDiscreteDynamicsWorld& world, SoftBodySolver<3>& solver,
                   ContactMethod contacts = ContactMethod::kSurface,
                   std::shared_ptr<ContactWorker> worker = nullptr);
  /// Removes all bodies and leaves the world as it was found.
  ~BulletSoftBodies();
  BulletSoftBodies(const BulletSoftBodies&) = delete;
  BulletSoftBodies& operator=(const BulletSoftBodies&) = delete;

  /// Adds a body at rest, its model's origin at `position` (metres). The reference is valid until remove(). Between steps you
  /// may change the body through its own functions; the next substep sees the change. When a body of another model is
  /// assigned to it, its attachments end.
  /// @throws std::invalid_argument  the model is null, or its bodies break (SoftBodySettings::fracture), which bodies that touch with
  /// spheres cannot.
  /// @pre the position is finite
  SoftBody<3>& add(std::shared_ptr<const SoftBodyModel<3>> model, const Eigen::Vector3f& position);

  /// @throws std::invalid_argument  the body is not one of these.
  void remove(const SoftBody<3>& body);

  /// Holds a patch of a body at its present place in the world, which move_attachment() can move.
  ///
  /// The bodies wake now, and when an attachment is moved, detached or breaks. Bodies that are attached to each other sleep and wake
  /// together. Only bodies that touch with their surfaces (ContactMethod::kSurface) and have contacts can be attached.
  /// @throws std::invalid_argument  a body is not one of these, or cannot be attached; a setting is out of its range; the patch is empty,
  /// or too small for this kind of attachment. The message says what was found and what was expected.
  AttachmentId attach(const SoftBody<3>& body, const Patch<3>& patch,
                      const AttachmentSettings<3>& settings = {});
  /// Holds a patch to a rigid body, until the rigid body is removed from the world.
  /// @throws std::invalid_argument  as above; the rigid body is not in the world.
  AttachmentId attach(const SoftBody<3>& body, const Patch<3>& patch, btRigidBody& rigid,
                      const AttachmentSettings<3>& settings = {});
  /// Holds a patch to a patch of another soft body of this object. @throws std::invalid_argument  as above; both are the same body.
  AttachmentId attach(const SoftBody<3>& body, const Patch<3>& patch, const SoftBody<3>& other,
                      const Patch<3>& other_patch, const AttachmentSettings<3>& settings = {});
  /// Ends an attachment. @throws std::invalid_argument  there is no such attachment: it may have ended.
  void detach(AttachmentId id);
  /// Moves the place in the world to which something is attached. The place moves evenly and arrives after `seconds` of simulated time, at
  /// the earliest at the end of the next substep.
  /// @param position  metres: the new point of a hinge or rope; of a weld, where the middle of the patch shall be. It lies within the
  ///                  body: attachment_ends().patch says where it is now
  /// @param rotation  of the place, relative to its orientation when the patch was attached; of any length but 0
  /// @throws std::invalid_argument  there is no such attachment, or it is to a body; a value is not finite; seconds below 0.
  void move_attachment(AttachmentId id, const Eigen::Vector3f& position,
                       const Eigen::Quaternionf& rotation = Eigen::Quaternionf::Identity(),
                       float seconds = 0);
  /// What an attachment did in the last substep; no value if it has ended.
  std::optional<AttachmentState<3>> attachment(AttachmentId id) const;
  /// Where an attachment's ends are now; no value if it has ended.
  std::optional<AttachmentEnds<3>> attachment_ends(AttachmentId id) const;
  /// The attachments that have broken or lost a body since the last call, but not those that detach() ended.
  std::vector<EndedAttachment> poll_ended_attachments();

  /// Cuts a body as it is now, whether it has a fracture or not (soft_bodies/fracture.h). The body becomes its largest piece and wakes.
  ///
  /// An attachment continues with the piece that has all particles of its patch, each of them once; if no piece has, it ends. New bodies
  /// have the collision filter of the body and follow all others in operator[].
  /// @return the other pieces that stay (Fracture::least_cells); valid until remove()
  /// @throws std::invalid_argument  the body is not one of these, or touches with spheres; the cut is not finite or has no area.
  std::vector<SoftBody<3>*> cut(const SoftBody<3>& body, const Cut& where);
  /// The same without a stall: the body stays whole for some substeps, like one that breaks (below), and poll_broken() returns its pieces.
  /// If the body is already breaking, that is finished first.
  /// @return whether the cut meets the body   @throws std::invalid_argument  as cut()
  bool begin_cut(const SoftBody<3>& body, const Cut& where);
  /// The bodies that have broken or were cut since the last call, in the order in which that happened, without those that were removed
  /// since. A body with a SoftBodySettings::fracture is tested at the end of each substep in which it is awake. A body of up to 100
  /// particles has its pieces at once. A larger one stays whole for 2 more substeps, and one for each 1,000 particles, while another thread
  /// makes its pieces.
  std::vector<BrokenSoftBody> poll_broken();
  /// Whether the body is still whole and will break into pieces. Assigning to the body, or resetting its shape, prevents that.
  /// @throws std::invalid_argument  the body is not one of these
  bool is_breaking(const SoftBody<3>& body) const;

  /// Lets the solver begin the next substep, of `step` seconds, while the caller does something else. If bodies change
  /// after all, or the substep has another length, softcell discards that work and does it again. The result is the
  /// same, except for what SoftBodySolver::drop() says of rotations. Call it between steps. A step of 0 s begins nothing.
  /// @throws std::invalid_argument  the step is negative or not finite
  void begin_ahead(float step);

  /// Lets bodies at rest sleep, or never (std::nullopt, the default). Bodies that touch with their surfaces fall asleep together with
  /// the bodies that they press on. With spheres each body falls asleep alone; bodies that lean on each other may keep each other awake.
  ///
  /// A sleeping body wakes when something that moves touches it or, with surfaces, reaches its box; when gravity changes; when its user
  /// changes it; and when another soft body of this object, on which it may have lain, is changed or removed. With surfaces it also wakes
  /// when an object near it is moved, removed or made a trigger volume, or gets another shape, size, group or mask.
  ///
  /// Three changes wake nothing: a change of a rigid body that a body touches with spheres; a change of a soft body of another
  /// BulletSoftBodies; and points that move within a shape whose box stays the same. Wake what rested there yourself, a soft body by
  /// add_velocity({0, 0, 0}).
  /// @throws std::invalid_argument  a setting is out of its range
  void let_sleep(const std::optional<SleepSettings>& settings);

  /// Appends the contacts at which soft bodies that touch with their surfaces pressed on something in the last substep.
  /// Contacts of spheres are in Bullet's own manifolds.
  void append_contacts(std::vector<Contact>& contacts) const;

  /// Sets what a body may touch; without a call it may touch all groups. The body wakes, and so do bodies that may lie on it.
  /// @throws std::invalid_argument  the body is not one of these.
  void set_filter(const SoftBody<3>& body, const CollisionFilter& filter);

  /// Switches contact events on or off for bodies that touch with their surfaces. They are off by default and cost nothing then. For
  /// spheres use Bullet's own callbacks.
  void watch_contacts(bool watch);
  /// The contacts that have begun, continued or ended since the last call: one event for each pair of bodies, in the order in which bodies
  /// were added. A pair of bodies that both sleep has no events until one of them wakes.
  ///
  /// A collision object or rigid body with btCollisionObject::CF_NO_CONTACT_RESPONSE, a btGhostObject for example, is a trigger volume: it
  /// stops nothing, and the events say which bodies, awake or asleep, are in it. Its collision filter counts. A triangle mesh has no
  /// inside: a body is in such a volume if triangles cut it.
  std::vector<ContactEvent> poll_contact_events();

  /// The first point at which the line from `from` to `to` (metres) meets the drawn surface of one of these bodies, from inside or outside.
  /// Each body whose box the line meets costs about half a microsecond for each of its triangles: for many rays keep a SurfaceQuery for
  /// each body.
  /// @param filter  the ray passes through bodies that may not touch something with this filter  @pre from and to are finite
  std::optional<SoftRayHit> cast_ray(const Eigen::Vector3f& from, const Eigen::Vector3f& to,
                                     const CollisionFilter& filter = {}) const;

  SoftBodyTimes times() const;  ///< the time that these bodies have taken inside stepSimulation()

  /// Counts the crushed cells of the bodies that touch with their surfaces. Each call looks at all of their cells as they are now.
  /// softcell keeps crushed cells from being pressed further and pushes them back. If there are many for long, a body is
  /// too soft or too light for what lies on it.
  CrushedCellCount crushed_cells() const;

  std::size_t size() const;  ///< number of soft bodies
  /// The bodies in the order of add(). @throws std::out_of_range  there are not so many
  SoftBody<3>& operator[](std::size_t index);
  /// The same.
  const SoftBody<3>& operator[](std::size_t index) const;

  /// A particle of one of the soft bodies.
  struct Particle {
    const SoftBody<3>* body = nullptr;  ///< null: no particle
    std::size_t number = 0;             ///< of the particle in its body
  };
  /// For contact callbacks of bodies that touch with spheres: the particle that a collision object stands for. For any
  /// other object the result has no body.
  static Particle particle_of(const btCollisionObject& object);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace softcell::ppu
