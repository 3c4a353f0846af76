#pragma once
// Soft bodies in somebody's Box2D world.
//
//     Box2dSoftBodies soft_bodies(world);                      // your b2World
//     SoftBody<2>& man = soft_bodies.add(model, {0, 2});
//     soft_bodies.step(1.0f / 120);                            // in place of world.Step()
//     draw(man.positions());
//
// With ContactMethod::kSurface bodies touch with their drawn edges (make_skin_2d(), with the model's contact radius), what SPEs find and
// solve for a solver on SPEs. Box2D does not know them: its rays and listeners see nothing of them, and contacts() says what they press on.
//
// With ContactMethod::kSpheres, the default, each outer particle is a b2Body: a circle that cannot turn (one that rolls has no friction), which meets
// everything in the world but its own body. Before each step of Box2D shape matching changes the particles'
// velocities, with that step's length; positions are Box2D's own business. Inner particles, which nothing can
// touch, are integrated here.
//
//     step:  [solver: v] [Box2D: collide, solve, x += h v] [gather x v, inner x += h v]

#include <box2d/b2_world.h>

#include <Eigen/Core>
#include <chrono>
#include <memory>
#include <optional>
#include <vector>

#include "softcell/soft_bodies/attachment.h"
#include "softcell/soft_bodies/contact.h"
#include "softcell/soft_bodies/fracture.h"
#include "softcell/soft_bodies/soft_body.h"
#include "softcell/soft_bodies/soft_body_solver.h"
#include "softcell/soft_bodies/solver_factory.h"

namespace softcell::ppu {

/// A point at which a soft body presses on something.
struct Contact2d {
  Eigen::Vector2f position{0, 0};  ///< metres, in the world
  Eigen::Vector2f normal{0, 1};    ///< unit length, from the other one to the first
  float impulse = 0;               ///< kg m/s along the normal, in the last step; above 0
  const SoftBody<2>* first = nullptr;
  const SoftBody<2>* second = nullptr;  ///< or null: `rigid`
  b2Body* rigid = nullptr;
};

/// All soft bodies of one world, which has only one of these; used by the thread that steps it. Box2D has no
/// callback before a step, so the step goes through here. Negative collision groups are its own, one for each
/// body, from -1 downwards: a fixture of the caller in such a group never meets that body. A NaN in a
/// particle throws std::runtime_error out of begin_step().
class Box2dSoftBodies {
 public:
  /// A particle moves at most this many cells in one step; faster ones are slowed down, which takes momentum
  /// from their body. It keeps particles from passing through each other's bodies; walls that do not move are
  /// Box2D's continuous collision's concern.
  static constexpr float kMaxTravelInCells = 1.0f;

  /// The thread that steps the world does the shape matching. @param world  outlives this.
  explicit Box2dSoftBodies(b2World& world, ContactMethod contacts = ContactMethod::kSpheres);
  /// @param solvers  makes the solver that does the shape matching: SpeRuntime has SPEs do it. Outlives this.
  Box2dSoftBodies(b2World& world, SolverFactory& solvers, ContactMethod contacts = ContactMethod::kSpheres);
  /// @param solver  does the shape matching: SpeSolver<2> on the SPEs. Outlives this, and serves nobody else.
  /// @param worker  for ContactMethod::kSurface: who finds and solves contacts, as SolverFactory makes it; null: the thread that steps the
  ///                world
  Box2dSoftBodies(b2World& world, SoftBodySolver<2>& solver, ContactMethod contacts = ContactMethod::kSpheres,
                  std::shared_ptr<ContactWorker> worker = nullptr);
  /// Removes all bodies.
  ~Box2dSoftBodies();
  Box2dSoftBodies(const Box2dSoftBodies&) = delete;
  Box2dSoftBodies& operator=(const Box2dSoftBodies&) = delete;

  /// Adds a body at rest, its model's origin at `position` (metres). The reference is good until remove().
  /// Between steps the body may be changed through its own functions; Box2D is told at the next step. Its attachments end when a body of
  /// another model is assigned to it.
  /// @throws std::runtime_error  there would be more than 32,768 bodies
  SoftBody<2>& add(std::shared_ptr<const SoftBodyModel<2>> model, const Eigen::Vector2f& position);

  /// @throws std::invalid_argument  the body is not one of these.
  void remove(const SoftBody<2>& body);

  /// Holds a patch of a body to the world: to the place where it is now, which move_attachment() may move.
  ///
  /// Attachments are solved in begin_step(), behind the shape matching; Box2D's contacts come after them. The bodies wake, and do not sleep
  /// while they are attached. What is attached and does not touch needs a contact filter: the world's own is asked first, and is put back
  /// at the end; one that the caller installs later must call the one it replaces (b2ContactManager::m_contactFilter).
  /// @throws std::invalid_argument  a body is not one of these; a setting is out of its range; the patch is empty, or too small for what
  ///         is asked of it. The sentence says what was found and what was expected.
  AttachmentId attach(const SoftBody<2>& body, const Patch<2>& patch,
                      const AttachmentSettings<2>& settings = {});
  /// To a rigid body. @throws as above; it is not in the world, or a particle of a soft body.
  /// When it is destroyed, the attachment ends with the next step. Detach it first if another b2Body is created before that step: Box2D may
  /// give that one the same address.
  AttachmentId attach(const SoftBody<2>& body, const Patch<2>& patch, b2Body& rigid,
                      const AttachmentSettings<2>& settings = {});
  /// To a patch of another soft body of these. @throws as above; it is the same body.
  AttachmentId attach(const SoftBody<2>& body, const Patch<2>& patch, const SoftBody<2>& other,
                      const Patch<2>& other_patch, const AttachmentSettings<2>& settings = {});
  /// @throws std::invalid_argument  there is no such attachment: it may have ended.
  void detach(AttachmentId id);
  /// Moves the place in the world to which something is attached: of a hinge or rope its point, of a weld the middle of its patch when it
  /// was attached. It moves evenly and is there after `seconds` of simulated time, at the earliest at the next step's end.
  /// @param angle  radians, counter-clockwise, from how it was when it was attached
  /// @throws std::invalid_argument  there is no such attachment, or it is to a body; a value is not finite; seconds below 0.
  void move_attachment(AttachmentId id, const Eigen::Vector2f& position, float angle = 0, float seconds = 0);
  /// What it did in the last step; nothing when it has ended.
  std::optional<AttachmentState<2>> attachment(AttachmentId id) const;
  /// Where it holds now; nothing when it has ended.
  std::optional<AttachmentEnds<2>> attachment_ends(AttachmentId id) const;
  /// Those that have broken, or lost a body, since the last call. Those that were detached are none of them.
  std::vector<EndedAttachment> take_ended_attachments();

  /// Cuts a body as it is now, whatever its settings (soft_bodies/fracture.h). It becomes its largest piece and wakes.
  ///
  /// What is attached to it goes on with the piece that has all particles of the patch, each of them once; where none has, the attachment
  /// breaks. New bodies come behind all others in operator[]. The body gets new b2Bodies: joints of its old ones end with these. Particles
  /// of pieces that are still in each other do not touch before they have been apart, for which a contact filter is installed as for
  /// attach().
  /// @return the other pieces; good until remove()
  /// @throws std::invalid_argument  the body is not one of these; the cut is not finite or has no length.
  /// @throws std::runtime_error     there would be more than 32,768 bodies; nothing has changed then
  std::vector<SoftBody<2>*> cut(const SoftBody<2>& body, const Cut2d& where);
  /// The same without a stall: the body stays whole for some steps, as one that breaks (below), and take_broken() names its pieces. One that
  /// is breaking gets the pieces of that first.
  /// @return whether the cut meets the body   @throws as cut()
  bool begin_cut(const SoftBody<2>& body, const Cut2d& where);
  /// What has broken or was cut since the last call, in this order. A body with a SoftBodySettings::fracture is tested at the end of each
  /// step in which it is awake. One of up to 100 particles has pieces at once; a larger one stays whole for 2 more steps, and one for each
  /// 1,000 particles, while another thread makes its pieces. Bodies that were removed since then are not named.
  std::vector<BrokenSoftBody2d> take_broken();
  /// Whether it is still whole and will have pieces. An assignment, or a reset of its shape, prevents it.
  /// @throws std::invalid_argument  the body is not one of these
  bool is_breaking(const SoftBody<2>& body) const;

  /// One step of the world and its soft bodies. @param step  seconds, above 0.
  void step(float step, int velocity_iterations = 8, int position_iterations = 3);

  /// The two halves of step(), for a caller who calls b2World::Step() himself between them, with the same
  /// length.
  void begin_step(float step);
  void end_step(float step);  ///< the second half

  /// Has the solver begin the next step's work now, of `step` seconds, while the caller does something else.
  /// When bodies are changed after all, or the step has another length, that work is dropped and done again:
  /// the result is the same. Call it between steps.
  void begin_ahead(float step);

  /// Lets bodies at rest sleep, or never (std::nullopt, the default). What touches each other, or hangs
  /// together by joints, falls asleep together: soft bodies, and rigid ones that can move, of which each must
  /// be slow and allowed to sleep. A sleeping body wakes when something that moves touches it, when what it
  /// touched is removed, when gravity changes, when its user changes it, and when one of its particles is
  /// woken in Box2D.
  void let_sleep(const std::optional<SleepSettings>& settings);

  std::size_t size() const;                                ///< number of soft bodies
  SoftBody<2>& operator[](std::size_t index);              ///< in the order of add()
  const SoftBody<2>& operator[](std::size_t index) const;  ///< in the order of add()

  /// A particle of one of the soft bodies.
  struct Particle {
    const SoftBody<2>* body = nullptr;  ///< null: no particle
    std::size_t number = 0;             ///< of the particle in its body
  };
  /// The particle that a b2Body stands for, for contact listeners; without a body for every other b2Body.
  Particle particle_of(const b2Body& body) const;

  /// With ContactMethod::kSurface: the contacts of the last step. Else none: Box2D has them.
  std::vector<Contact2d> contacts() const;

  /// Time spent in this class's part of the steps so far, by the clock.
  std::chrono::nanoseconds time_spent() const;
  /// Of that, the time until the solver had finished. The default solver works in that time, one on the SPEs
  /// leaves this thread nothing to do.
  std::chrono::nanoseconds time_waited() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace softcell::ppu
