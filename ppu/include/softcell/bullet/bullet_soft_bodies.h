#pragma once
// Soft bodies in somebody's Bullet world.
//
//     BulletSoftBodies soft_bodies(world);                     // your btDiscreteDynamicsWorld
//     SoftBody& ball = soft_bodies.add(model, {0, 2, 0});
//     world.stepSimulation(dt, max_substeps, fixed_step);      // as before
//     draw(ball.positions());
//
// Bodies touch with what is drawn of them, rigid bodies and each other. In every internal substep, before Bullet integrates, shape
// matching changes the velocities of their particles, with that substep's length; contacts are found and solved, which gives rigid
// bodies their impulses; and the particles move. Bullet knows nothing of them:
//
//     substep:  [solver: v] [v += h g] [contacts: v, rigid bodies] [x += h v] [Bullet: collide, solve, integrate]
//
// The thread that steps the world does the shape matching, unless the constructor is given somebody else:
//
//     SpeRuntime spes;                                         // spe_bodies/spe_runtime.h
//     BulletSoftBodies soft_bodies(world, spes);               // SPEs do it
//
// With ContactMethod::kSpheres, the way of 2008, each outer particle is a btRigidBody: a small sphere that cannot turn (one that rolls
// has no friction). Bullet moves them and solves their contacts, with everything else in the world and with other soft bodies;
// positions are Bullet's own business, because moving a body spoils its contacts. Inner particles, which nothing can touch, are
// integrated here:
//
//     substep:  [solver: v] [Bullet: collide, solve, x += h v] [gather x v, inner x += h v]
//
// To draw a body's mesh: soft_bodies/skinned_mesh.h, or, by the SPEs, spe_bodies/spe_skinner.h.

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "softcell/soft_bodies/attachment.h"
#include "softcell/soft_bodies/contact.h"
#include "softcell/soft_bodies/fracture.h"
#include "softcell/soft_bodies/soft_body_solver.h"
#include "softcell/soft_bodies/solver_factory.h"
#include "softcell/soft_bodies/surface_query.h"

namespace softcell::ppu {

/// Where the time goes that soft bodies take inside stepSimulation(), since the beginning.
struct SoftBodyTimes {
  std::chrono::nanoseconds gather{0};    ///< processor time: particles from Bullet, inner ones integrated
  std::chrono::nanoseconds solve{0};     ///< processor time of the solver on this thread
  std::chrono::nanoseconds apply{0};     ///< processor time: velocities to Bullet
  std::chrono::nanoseconds contacts{0};  ///< processor time of contacts of surfaces
  std::chrono::nanoseconds wait{0};  ///< by the clock, until the solver had finished; no work for this thread

  /// Of the calling thread.
  std::chrono::nanoseconds processor() const { return gather + solve + apply + contacts; }
};

/// A soft body touches something, or is in a trigger volume: all contacts of the two together, as BulletSoftBodies::take_contact_events()
/// returns them.
struct ContactEvent {
  /// Since when they touch.
  enum class Kind {
    kBegin,    ///< they did not touch when events were taken last
    kPersist,  ///< they did
    kEnd       ///< they touch no longer; one of them may be gone, and its address only a name
  };
  Kind kind = Kind::kBegin;
  const SoftBody<3>* body = nullptr;
  /// Another soft body, or `body` itself, which is folded; else null.
  const SoftBody<3>* other = nullptr;
  /// Or something that Bullet knows; a trigger volume, if hasContactResponse() is false.
  const btCollisionObject* object = nullptr;
  /// Metres: the mean of where they press, by impulse; of a trigger volume, a point that both have in common.
  Eigen::Vector3f position{0, 0, 0};
  /// Unit length, from the other one to `body`; of a trigger volume, the way out of it.
  Eigen::Vector3f normal{0, 1, 0};
  /// kg m/s along the contacts' normals, since events were taken last; 0 of a trigger volume, which holds nothing.
  float impulse = 0;
};

/// What a ray meets first.
struct SoftRayHit {
  const SoftBody<3>* body = nullptr;
  SurfaceHit hit;
};

/// The soft bodies of one world. Several of these may share a world.
///
/// What it installs in the world: an internal pre-tick callback and an overlap filter, each calling the one
/// found there, and an action. The world's user info stays the caller's own. A callback or filter that the
/// caller installs later must call the one it replaces, or soft bodies lose their shape, and must be taken
/// out before the last of these goes: what it calls is no more then.
///
/// Used by the thread that steps the world. In stepSimulation() it allocates nothing but
/// room for more contacts or obstacles than ever before, and what bodies that break need; Bullet may.
/// A NaN in a particle, whoever put it there, throws std::runtime_error out of stepSimulation().
class BulletSoftBodies {
 public:
  /// A particle moves at most this many cells in one substep; faster ones are slowed down. Bullet finds
  /// contacts before they happen within such a distance (see contact_sphere.h), so that nothing goes through
  /// a floor. With cells of 0.2 m and substeps of 1/120 s that is 24 m/s, a fall from 29 m. A
  /// particle that is slowed down takes momentum from its body.
  static constexpr float kMaxTravelInCells = 1.0f;

  /// @param world  outlives this.
  explicit BulletSoftBodies(btDiscreteDynamicsWorld& world, ContactMethod contacts = ContactMethod::kSurface);
  /// @param solvers  makes the solver for these bodies; outlives this. Usually an SpeRuntime.
  /// @throws std::runtime_error  as SolverFactory::make_solver().
  BulletSoftBodies(btDiscreteDynamicsWorld& world, SolverFactory& solvers,
                   ContactMethod contacts = ContactMethod::kSurface);
  /// @param solver  outlives this, and serves nobody else.
  /// @param worker  for ContactMethod::kSurface: who finds and solves contacts, as SolverFactory makes it; null:
  ///                the thread that steps the world
  BulletSoftBodies(btDiscreteDynamicsWorld& world, SoftBodySolver<3>& solver,
                   ContactMethod contacts = ContactMethod::kSurface,
                   std::shared_ptr<ContactWorker> worker = nullptr);
  /// Removes all bodies and leaves the world as it was found.
  ~BulletSoftBodies();
  BulletSoftBodies(const BulletSoftBodies&) = delete;
  BulletSoftBodies& operator=(const BulletSoftBodies&) = delete;

  /// Adds a body at rest, its model's origin at `position` (metres). The reference is good until remove().
  /// @throws std::invalid_argument  the model's bodies break (SoftBodySettings::fracture), and these touch with spheres.
  /// @pre the model is not null; the position is finite
  /// Between steps the body may be changed through its own functions; Bullet is told at the next substep.
  SoftBody<3>& add(std::shared_ptr<const SoftBodyModel<3>> model, const Eigen::Vector3f& position);

  /// @throws std::invalid_argument  the body is not one of these.
  void remove(const SoftBody<3>& body);

  /// Holds a patch of a body to the world: to the place where it is now, which move_attachment() may move.
  ///
  /// The bodies wake, as when an attachment is moved, detached or breaks; what is attached to each other sleeps together. Bodies of
  /// ContactMethod::kSurface that touch things can be attached.
  /// @throws std::invalid_argument  a body is not one of these, or cannot be attached; a setting is out of its range; the patch is empty,
  ///         or too small for what is asked of it. The sentence says what was found and what was expected.
  AttachmentId attach(const SoftBody<3>& body, const Patch<3>& patch,
                      const AttachmentSettings<3>& settings = {});
  /// To a rigid body, until that is removed from the world. @throws as above; it is not in the world.
  AttachmentId attach(const SoftBody<3>& body, const Patch<3>& patch, btRigidBody& rigid,
                      const AttachmentSettings<3>& settings = {});
  /// To a patch of another soft body of these. @throws as above; it is the same body.
  AttachmentId attach(const SoftBody<3>& body, const Patch<3>& patch, const SoftBody<3>& other,
                      const Patch<3>& other_patch, const AttachmentSettings<3>& settings = {});
  /// @throws std::invalid_argument  there is no such attachment: it may have ended.
  void detach(AttachmentId id);
  /// Moves the place in the world to which something is attached: of a hinge or rope its point, of a weld the middle of its patch when it
  /// was attached. It moves evenly and is there after `seconds` of simulated time, at the earliest at the next substep's end.
  /// @param rotation  from how it was when it was attached; of any length but 0
  /// @throws std::invalid_argument  there is no such attachment, or it is to a body; a value is not finite; seconds below 0.
  void move_attachment(AttachmentId id, const Eigen::Vector3f& position,
                       const Eigen::Quaternionf& rotation = Eigen::Quaternionf::Identity(),
                       float seconds = 0);
  /// What it did in the last substep; nothing when it has ended.
  std::optional<AttachmentState<3>> attachment(AttachmentId id) const;
  /// Where it holds now; nothing when it has ended.
  std::optional<AttachmentEnds<3>> attachment_ends(AttachmentId id) const;
  /// Those that have broken, or lost a body, since the last call. Those that were detached are none of them.
  std::vector<EndedAttachment> take_ended_attachments();

  /// Cuts a body as it is now, whatever its settings (soft_bodies/fracture.h). It becomes its largest piece and wakes.
  ///
  /// What is attached to it goes on with the piece that has all particles of the patch, each of them once; where none has, the attachment
  /// breaks. New bodies have the filter of the body, and come behind all others in operator[].
  /// @return the other pieces; good until remove()
  /// @throws std::invalid_argument  the body is not one of these, or touches with spheres; the cut is not finite or has no area.
  std::vector<SoftBody<3>*> cut(const SoftBody<3>& body, const Cut& where);
  /// The same without a stall: the body stays whole for some substeps, as one that breaks (below), and take_broken() names its pieces. One that
  /// is breaking gets the pieces of that first.
  /// @return whether the cut meets the body   @throws std::invalid_argument  as cut()
  bool begin_cut(const SoftBody<3>& body, const Cut& where);
  /// What has broken or was cut since the last call, in this order. A body with a SoftBodySettings::fracture is tested at the end of each
  /// substep in which it is awake. One of up to 100 particles has pieces at once; a larger one stays whole for 2 more substeps, and one for each
  /// 1,000 particles, while another thread makes its pieces. Bodies that were removed since then are not named.
  std::vector<BrokenSoftBody> take_broken();
  /// Whether it is still whole and will have pieces. An assignment, or a reset of its shape, prevents it.
  /// @throws std::invalid_argument  the body is not one of these
  bool is_breaking(const SoftBody<3>& body) const;

  /// Has the solver begin the next substep's work now, of `step` seconds, while the caller does something
  /// else. When bodies are changed after all, or the substep has another length, that work is dropped and
  /// done again: the result is the same but for what SoftBodySolver::drop() says of rotations. Call it
  /// between steps. @pre step > 0
  void begin_ahead(float step);

  /// Lets bodies at rest sleep, or never (std::nullopt, the default). Bodies that touch with their surfaces fall
  /// asleep together with those that they press on; with spheres each does so alone, and those that lean on
  /// each other may keep each other awake. A sleeping body wakes when something that moves touches it or,
  /// with surfaces, reaches its box; when gravity changes, when its user changes it, or when another soft body
  /// of these, on which it may have lain, is changed or removed. Removing a rigid body, or a soft body that another BulletSoftBodies owns, wakes nothing:
  /// wake what rested on it yourself, a soft body by add_velocity({0, 0, 0}).
  void let_sleep(const std::optional<SleepSettings>& settings);

  /// Appends where soft bodies that touch with their surfaces press on something, as of the last substep.
  /// Spheres are in Bullet's own contact manifolds.
  void append_contacts(std::vector<Contact>& contacts) const;

  /// What a body may touch; all that moves and that stands still, if nothing is said. The body wakes, and so does what may lie on it.
  /// @throws std::invalid_argument  the body is not one of these.
  void set_filter(const SoftBody<3>& body, const CollisionFilter& filter);

  /// Whether contacts of bodies that touch with their surfaces are watched; not, if nothing is said, and then they cost nothing. Of spheres
  /// Bullet's own callbacks tell.
  void watch_contacts(bool watch);
  /// What has begun, gone on or ended since the last call, an event for each two, in the order in which bodies were added. Of two that
  /// sleep on each other there are none until one wakes.
  ///
  /// A collision object or rigid body with btCollisionObject::CF_NO_CONTACT_RESPONSE, a btGhostObject for example, is a trigger volume:
  /// nothing bounces off it, and the events say which bodies are in it, also of those that sleep. Its filter counts. One of triangles has
  /// no inside: bodies are in it that it cuts.
  std::vector<ContactEvent> take_contact_events();

  /// The first point of a ray on the drawn surface of one of these bodies, from either side of it. Each body whose box the ray meets costs some
  /// microseconds for a thousand triangles: for many rays keep a SurfaceQuery for each body.
  /// @param filter  bodies that it does not let are not seen  @pre from and to are finite, metres
  std::optional<SoftRayHit> cast_ray(const Eigen::Vector3f& from, const Eigen::Vector3f& to,
                                     const CollisionFilter& filter = {}) const;

  SoftBodyTimes times() const;  ///< since the construction

  /// At the beginning of the last substep, of bodies that were awake and touch with what is drawn. Contacts hold
  /// crushed cells from being pressed further and push them back; many of them, for long, say that a body is too soft
  /// or too light for what lies on it.
  CrushedCellCount crushed_cells() const;

  std::size_t size() const;                                ///< number of soft bodies
  SoftBody<3>& operator[](std::size_t index);              ///< in the order of add()
  const SoftBody<3>& operator[](std::size_t index) const;  ///< in the order of add()

  /// A particle of one of the soft bodies.
  struct Particle {
    const SoftBody<3>* body = nullptr;  ///< null: no particle
    std::size_t number = 0;             ///< of the particle in its body
  };
  /// The particle that a collision object stands for, for contact callbacks; without a body for every other
  /// object.
  static Particle particle_of(const btCollisionObject& object);

  /// Time spent in this class inside stepSimulation(), for all soft bodies of `world`, since the first was
  /// attached.
  static std::chrono::nanoseconds time_spent(const btDynamicsWorld& world);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace softcell::ppu
