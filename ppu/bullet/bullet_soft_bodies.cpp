#include "softcell/bullet/bullet_soft_bodies.h"

#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ppu/bullet/bullet_hook.h"
#include "ppu/bullet/bullet_vector.h"
#include "ppu/bullet/contact_sphere.h"
#include "ppu/bullet/processor_time.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

/// One soft body and the rigid bodies of its outer particles, in the order of SoftBodyModel::outer().
class CoupledBody {
 public:
  CoupledBody(btDiscreteDynamicsWorld& world, std::shared_ptr<const SoftBodyModel<3>> model,
              const Eigen::Vector3f& position)
      : world_(world),
        soft_(std::move(model), position),
        shape_(soft_.model().contact_radius(), soft_.model().soft_contact_radius(),
               BulletSoftBodies::kMaxTravelInCells * soft_.model().lattice().spacing) {
    particles_.reserve(soft_.model().outer().size());
    for (const std::uint32_t particle : soft_.model().outer()) add_particle(particle);
  }

  ~CoupledBody() {
    for (btRigidBody& particle : particles_) world_.removeRigidBody(&particle);
  }
  CoupledBody(const CoupledBody&) = delete;
  CoupledBody& operator=(const CoupledBody&) = delete;

  SoftBody<3>& soft() { return soft_; }
  const SoftBody<3>& soft() const { return soft_; }

  /// Whether the body's user has changed it since the last substep.
  bool was_changed() const { return soft_.revision() != seen_revision_; }

  /// Whether what is known of its rotations is of no use since then.
  bool was_reset() const { return soft_.resets() != seen_resets_; }

  /// Before the solver: what the caller may have done to the body or, mostly to velocities, its particles.
  void begin_substep() {
    if (was_changed()) {
      rouse();
      place_particles();
    } else if (!soft_.asleep()) {
      gather();
    }
  }

  /// The box around its particles as Bullet knows them. @pre it has some
  Bounds<3> box() const {
    SC_ASSERT(!particles_.empty(), "a body without contacts has no box in Bullet");
    Bounds<3> box{to_eigen(particles_[0].getWorldTransform().getOrigin()), {}};
    box.high = box.low;
    for (const btRigidBody& particle : particles_) {
      box.low = box.low.cwiseMin(to_eigen(particle.getWorldTransform().getOrigin()));
      box.high = box.high.cwiseMax(to_eigen(particle.getWorldTransform().getOrigin()));
    }
    return box;
  }

  /// Wakes the body if it sleeps and may have lain on another, which was in `gone` and is there no longer.
  void lose(const CoupledBody& other, const Bounds<3>& gone) {
    if (!soft_.asleep() || particles_.empty()) return;
    constexpr float kGive = 1.2f;  // bodies that rest on each other are not quite as far apart as they touch
    const Bounds<3> own = box();
    const Eigen::Vector3f reach = Eigen::Vector3f::Constant(
        kGive * (soft_.model().soft_contact_radius() + other.soft_.model().soft_contact_radius()));
    if ((own.low - reach - gone.high).maxCoeff() < 0 && (gone.low - own.high - reach).maxCoeff() < 0) rouse();
  }

  bool can_be_touched() const { return !particles_.empty(); }

  /// Whether particles are no longer as they were gathered last.
  bool was_pushed() const {
    if (soft_.asleep()) return false;
    const auto outer = soft_.model().outer();
    for (std::size_t i = 0; i < outer.size(); ++i) {
      fetch_ahead(i);
      const btRigidBody& particle = particles_[i];
      if (to_eigen(particle.getLinearVelocity()) != soft_.velocities()[outer[i]] ||
          to_eigen(particle.getWorldTransform().getOrigin()) != soft_.position(outer[i]))
        return true;
    }
    return false;
  }

  /// Behind the solver: Bullet integrates with the new velocities.
  void apply(float step) {
    if (soft_.asleep()) return;
    soft_.limit_speed(BulletSoftBodies::kMaxTravelInCells * soft_.model().lattice().spacing / step);
    const auto outer = soft_.model().outer();
    for (std::size_t i = 0; i < outer.size(); ++i) {
      fetch_ahead(i);
      particles_[i].setLinearVelocity(to_bullet(soft_.velocities()[outer[i]]));
    }
  }

  /// After Bullet has integrated: outer particles are taken over, inner ones follow.
  void end_substep(float step, const std::optional<SleepSettings>& sleep) {
    if (soft_.asleep()) {
      const bool falls_another_way = world_.getGravity() != gravity_asleep_;
      if (sleep && !falls_another_way && !was_touched()) return;
      if (falls_another_way) still_for_ = 0;
      wake();
    }
    gather();
    soft_.advance_inner(step, to_eigen(world_.getGravity()));
    if (sleep) fall_asleep_when_still(step, *sleep);
  }

 private:
  /// Bullet has woken a particle, because something that moves touches it.
  bool was_touched() const {
    return std::any_of(particles_.begin(), particles_.end(), [](const btRigidBody& particle) {
      return particle.getActivationState() != ISLAND_SLEEPING;
    });
  }

  /// It sleeps when it has been still for as long again.
  void rouse() {
    still_for_ = 0;
    wake();
  }

  void wake() {
    soft_.set_asleep(false);
    for (btRigidBody& particle : particles_) {
      particle.forceActivationState(DISABLE_DEACTIVATION);
      particle.setGravity(world_.getGravity());  // Bullet tells only those that are awake
    }
  }

  /// A body that was woken by a touch does not count anew: still slow, it falls asleep again at once.
  void fall_asleep_when_still(float step, const SleepSettings& settings) {
    const auto is_slow = [&](const Eigen::Vector3f& v) {
      return v.squaredNorm() < settings.speed * settings.speed;
    };
    const bool still = std::all_of(soft_.velocities().begin(), soft_.velocities().end(), is_slow);
    still_for_ = still ? still_for_ + step : 0;
    if (still_for_ < settings.seconds) return;
    for (std::size_t i = 0; i < soft_.velocities().size(); ++i)
      soft_.set_velocity(i, Eigen::Vector3f::Zero());
    for (btRigidBody& particle : particles_) {
      particle.setLinearVelocity(btVector3(0, 0, 0));
      particle.forceActivationState(ISLAND_SLEEPING);
    }
    gravity_asleep_ = world_.getGravity();
    soft_.set_asleep(true);
  }

  void add_particle(std::uint32_t number) {
    // No inertia: a sphere that turned would roll, and a body on rolling particles has no friction.
    btRigidBody::btRigidBodyConstructionInfo info(soft_.model().masses()[number], nullptr, &shape_,
                                                  btVector3(0, 0, 0));
    info.m_startWorldTransform.setOrigin(to_bullet(soft_.position(number)));
    info.m_friction = soft_.model().settings().friction;
    info.m_restitution = 0;
    info.m_linearDamping = 0;
    info.m_angularDamping = 0;
    btRigidBody& particle = particles_.emplace_back(info);
    particle.setAngularFactor(0);
    particle.setFlags(0);  // no gyroscopic term for what does not turn
    // A particle alone never sleeps: its neighbours would be pulled towards one that hangs still.
    particle.setActivationState(DISABLE_DEACTIVATION);
    particle.setUserPointer(&soft_);
    particle.setUserIndex(static_cast<int>(number));
    world_.addRigidBody(&particle);
  }

  /// A btRigidBody is 744 bytes, of which position and velocity are in two places: loops over thousands would
  /// wait for memory twice for each.
  void fetch_ahead(std::size_t i) const {
    constexpr std::size_t kAhead = 8;
    if (i + kAhead >= particles_.size()) return;
    const btRigidBody& later = particles_[i + kAhead];
    __builtin_prefetch(&later.getWorldTransform().getOrigin());
    __builtin_prefetch(&later.getLinearVelocity());
  }

  void gather() {
    const auto outer = soft_.model().outer();
    for (std::size_t i = 0; i < outer.size(); ++i) {
      fetch_ahead(i);
      const btRigidBody& particle = particles_[i];
      soft_.set_particle(outer[i], to_eigen(particle.getWorldTransform().getOrigin()),
                         to_eigen(particle.getLinearVelocity()));
    }
  }

  /// The body was changed by its user: so are its particles, and contacts of those that are elsewhere now are
  /// forgotten.
  void place_particles() {
    seen_revision_ = soft_.revision();
    seen_resets_ = soft_.resets();
    const auto outer = soft_.model().outer();
    for (std::size_t i = 0; i < outer.size(); ++i) {
      btRigidBody& particle = particles_[i];
      particle.setLinearVelocity(to_bullet(soft_.velocities()[outer[i]]));
      if (to_eigen(particle.getWorldTransform().getOrigin()) == soft_.position(outer[i])) continue;
      particle.getWorldTransform().setOrigin(to_bullet(soft_.position(outer[i])));
      particle.setInterpolationWorldTransform(particle.getWorldTransform());
      world_.getPairCache()->cleanProxyFromPairs(particle.getBroadphaseProxy(), world_.getDispatcher());
    }
  }

  btDiscreteDynamicsWorld& world_;
  SoftBody<3> soft_;
  ContactSphere shape_;
  std::vector<btRigidBody> particles_;  // never grows: Bullet keeps their addresses
  std::uint32_t seen_revision_ = 0, seen_resets_ = 0;
  float still_for_ = 0;  // seconds
  btVector3 gravity_asleep_{0, 0, 0};
};

/// Adds the processor time of a piece of work.
template <typename Work>
void timed(std::chrono::nanoseconds& time, const Work& work) {
  const auto begin = processor_time();
  work();
  time += processor_time() - begin;
}

}  // namespace

struct BulletSoftBodies::Impl final : SubstepClient, btActionInterface {
  Impl(btDiscreteDynamicsWorld& w, std::unique_ptr<SoftBodySolver<3>> own)
      : world(w), owned(std::move(own)), solver(*owned) {
    attach();
  }
  Impl(btDiscreteDynamicsWorld& w, SoftBodySolver<3>& others) : world(w), solver(others) { attach(); }
  void attach() {
    BulletHook::attach(world, *this);
    world.addAction(this);
  }
  ~Impl() override {
    settle();
    for (SoftBody<3>* const body : soft) solver.forget(*body);
    bodies.clear();
    world.removeAction(this);
    BulletHook::detach(world, *this);
  }

  void begin_substep(float step) override {
    SC_ASSERT(step > 0, "a substep of {} s", step);
    const auto begin = std::chrono::steady_clock::now();
    timed(times.gather, [&] {
      if (ahead != step || std::any_of(bodies.begin(), bodies.end(), [](const auto& body) {
            return body->was_changed() || body->was_pushed();
          })) {
        settle();
        for (const auto& body : bodies) {
          if (body->was_reset()) solver.forget(body->soft());
          if (body->was_changed()) tell_others(*body);
          body->begin_substep();
        }
      }
    });
    timed(times.solve, [&] {
      if (ahead == 0) solver.kick(soft, step);
      ahead = 0;
      const auto waiting = std::chrono::steady_clock::now();
      solver.finish();
      times.wait += std::chrono::steady_clock::now() - waiting;
    });
    timed(times.apply, [&] {
      for (const auto& body : bodies) body->apply(step);
    });
    BulletHook::find(world)->add_time(std::chrono::steady_clock::now() - begin);
  }

  /// Bullet's actions run once per substep, after it has integrated.
  void updateAction(btCollisionWorld*, btScalar step) override {
    const auto begin = std::chrono::steady_clock::now();
    timed(times.gather, [&] {
      for (const auto& body : bodies) body->end_substep(step, sleep);
    });
    BulletHook::find(world)->add_time(std::chrono::steady_clock::now() - begin);
  }
  void debugDraw(btIDebugDraw*) override {}

  /// Nobody may sleep on a body that goes, or may go, from where Bullet knows it.
  void tell_others(const CoupledBody& leaving) {
    if (!leaving.can_be_touched()) return;
    const Bounds<3> box = leaving.box();
    for (const auto& body : bodies)
      if (body.get() != &leaving) body->lose(leaving, box);
  }

  /// What was begun ahead is of no use.
  void settle() {
    if (std::exchange(ahead, 0.0f) != 0) solver.drop();
  }

  btDiscreteDynamicsWorld& world;
  std::unique_ptr<SoftBodySolver<3>> owned;  // none: the caller has it
  SoftBodySolver<3>& solver;
  std::vector<std::unique_ptr<CoupledBody>> bodies;
  std::vector<SoftBody<3>*> soft;  // of `bodies`
  std::optional<SleepSettings> sleep;
  float ahead = 0;  // length of the substep that the solver has begun; 0: none
  SoftBodyTimes times;
};

BulletSoftBodies::BulletSoftBodies(btDiscreteDynamicsWorld& world)
    : impl_(std::make_unique<Impl>(world, std::make_unique<PpuSolver<3>>())) {}
BulletSoftBodies::BulletSoftBodies(btDiscreteDynamicsWorld& world, SolverFactory& solvers)
    : impl_(std::make_unique<Impl>(world, solvers.make_solver())) {}
BulletSoftBodies::BulletSoftBodies(btDiscreteDynamicsWorld& world, SoftBodySolver<3>& solver)
    : impl_(std::make_unique<Impl>(world, solver)) {}
BulletSoftBodies::~BulletSoftBodies() = default;

SoftBody<3>& BulletSoftBodies::add(std::shared_ptr<const SoftBodyModel<3>> model,
                                   const Eigen::Vector3f& position) {
  SC_ASSERT(model != nullptr && position.allFinite(), "a soft body {} a model, at ({}, {}, {})",
            model ? "with" : "without", position.x(), position.y(), position.z());
  impl_->settle();
  SoftBody<3>& soft =
      impl_->bodies.emplace_back(std::make_unique<CoupledBody>(impl_->world, std::move(model), position))
          ->soft();
  impl_->soft.push_back(&soft);
  return soft;
}

void BulletSoftBodies::remove(const SoftBody<3>& body) {
  const auto found = std::find_if(impl_->bodies.begin(), impl_->bodies.end(),
                                  [&](const auto& coupled) { return &coupled->soft() == &body; });
  if (found == impl_->bodies.end()) {
    throw std::invalid_argument("the soft body to be removed is not in this world");
  }
  impl_->settle();
  impl_->solver.forget(body);
  impl_->soft.erase(impl_->soft.begin() + (found - impl_->bodies.begin()));
  impl_->tell_others(**found);
  impl_->bodies.erase(found);
}

void BulletSoftBodies::begin_ahead(float step) {
  SC_ASSERT(step > 0, "a substep of {} s", step);
  impl_->settle();
  timed(impl_->times.solve, [&] { impl_->solver.kick(impl_->soft, step); });
  impl_->ahead = step;
}

void BulletSoftBodies::let_sleep(const std::optional<SleepSettings>& settings) { impl_->sleep = settings; }

SoftBodyTimes BulletSoftBodies::times() const { return impl_->times; }

std::size_t BulletSoftBodies::size() const { return impl_->bodies.size(); }
SoftBody<3>& BulletSoftBodies::operator[](std::size_t index) { return impl_->bodies.at(index)->soft(); }
const SoftBody<3>& BulletSoftBodies::operator[](std::size_t index) const {
  return impl_->bodies.at(index)->soft();
}

BulletSoftBodies::Particle BulletSoftBodies::particle_of(const btCollisionObject& object) {
  if (!ContactSphere::is_shape_of(object)) return {};
  return {static_cast<const SoftBody<3>*>(object.getUserPointer()),
          static_cast<std::size_t>(object.getUserIndex())};
}

std::chrono::nanoseconds BulletSoftBodies::time_spent(const btDynamicsWorld& world) {
  const BulletHook* const hook = BulletHook::find(world);
  return hook ? hook->spent() : std::chrono::nanoseconds(0);
}

}  // namespace softcell::ppu
