#include "softcell/ppu/bullet_coupling.h"

#include <BulletDynamics/Dynamics/btActionInterface.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>
#include <deque>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bullet_hook.h"
#include "bullet_vector.h"
#include "contact_sphere.h"

namespace softcell::ppu {
namespace {

/// One soft body and the rigid bodies of its outer particles, in the order of SoftBodyModel::outer().
class CoupledBody {
 public:
  CoupledBody(btDiscreteDynamicsWorld& world, std::shared_ptr<const SoftBodyModel> model,
              const Eigen::Vector3f& position)
      : world_(world),
        soft_(std::move(model), position),
        shape_(soft_.model().contact_radius(), soft_.model().soft_contact_radius(),
               BulletSoftBodies::kMaxTravelInCells * soft_.model().lattice().spacing) {
    for (const std::uint32_t particle : soft_.model().outer()) add_particle(particle);
  }

  ~CoupledBody() {
    for (btRigidBody& particle : particles_) world_.removeRigidBody(&particle);
  }
  CoupledBody(const CoupledBody&) = delete;
  CoupledBody& operator=(const CoupledBody&) = delete;

  SoftBody& soft() { return soft_; }
  const SoftBody& soft() const { return soft_; }

  /// Before Bullet integrates: shape matching.
  void begin_substep(float step) {
    if (soft_.revision() != seen_revision_) {
      place_particles();
    } else {
      gather();  // of velocities, mostly: the caller may have pushed particles
    }
    soft_.pull(step);
    soft_.limit_speed(BulletSoftBodies::kMaxTravelInCells * soft_.model().lattice().spacing / step);
    const auto outer = soft_.model().outer();
    for (std::size_t i = 0; i < outer.size(); ++i) {
      particles_[i].setLinearVelocity(to_bullet(soft_.velocities()[outer[i]]));
    }
  }

  /// After Bullet has integrated: outer particles are taken over, inner ones follow.
  void end_substep(float step) {
    gather();
    soft_.advance_inner(step, to_eigen(world_.getGravity()));
  }

 private:
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

  void gather() {
    const auto outer = soft_.model().outer();
    for (std::size_t i = 0; i < outer.size(); ++i) {
      const btRigidBody& particle = particles_[i];
      soft_.set_particle(outer[i], to_eigen(particle.getWorldTransform().getOrigin()),
                         to_eigen(particle.getLinearVelocity()));
    }
  }

  /// The body was moved by its user: so are its particles, and their contacts are forgotten.
  void place_particles() {
    seen_revision_ = soft_.revision();
    const auto outer = soft_.model().outer();
    for (std::size_t i = 0; i < outer.size(); ++i) {
      btRigidBody& particle = particles_[i];
      particle.getWorldTransform().setOrigin(to_bullet(soft_.position(outer[i])));
      particle.setInterpolationWorldTransform(particle.getWorldTransform());
      particle.setLinearVelocity(to_bullet(soft_.velocities()[outer[i]]));
      world_.getPairCache()->cleanProxyFromPairs(particle.getBroadphaseProxy(), world_.getDispatcher());
    }
  }

  btDiscreteDynamicsWorld& world_;
  SoftBody soft_;
  ContactSphere shape_;
  std::deque<btRigidBody> particles_;  // a deque: Bullet keeps their addresses
  std::uint32_t seen_revision_ = 0;
};

}  // namespace

struct BulletSoftBodies::Impl final : SubstepClient, btActionInterface {
  explicit Impl(btDiscreteDynamicsWorld& w) : world(w) {
    BulletHook::attach(world, *this);
    world.addAction(this);
  }
  ~Impl() override {
    bodies.clear();
    world.removeAction(this);
    BulletHook::detach(world, *this);
  }

  template <typename Work>
  void timed(const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    for (const auto& body : bodies) work(*body);
    BulletHook::find(world)->add_time(std::chrono::steady_clock::now() - begin);
  }

  void begin_substep(float step) override {
    timed([&](CoupledBody& body) { body.begin_substep(step); });
  }
  /// Bullet's actions run once per substep, after it has integrated.
  void updateAction(btCollisionWorld*, btScalar step) override {
    timed([&](CoupledBody& body) { body.end_substep(step); });
  }
  void debugDraw(btIDebugDraw*) override {}

  btDiscreteDynamicsWorld& world;
  std::vector<std::unique_ptr<CoupledBody>> bodies;
};

BulletSoftBodies::BulletSoftBodies(btDiscreteDynamicsWorld& world) : impl_(std::make_unique<Impl>(world)) {}
BulletSoftBodies::~BulletSoftBodies() = default;

SoftBody& BulletSoftBodies::add(std::shared_ptr<const SoftBodyModel> model, const Eigen::Vector3f& position) {
  return impl_->bodies.emplace_back(std::make_unique<CoupledBody>(impl_->world, std::move(model), position))
      ->soft();
}

void BulletSoftBodies::remove(const SoftBody& body) {
  const auto found = std::find_if(impl_->bodies.begin(), impl_->bodies.end(),
                                  [&](const auto& coupled) { return &coupled->soft() == &body; });
  if (found == impl_->bodies.end()) {
    throw std::invalid_argument("the soft body to be removed is not in this world");
  }
  impl_->bodies.erase(found);
}

std::size_t BulletSoftBodies::size() const { return impl_->bodies.size(); }
SoftBody& BulletSoftBodies::operator[](std::size_t index) { return impl_->bodies.at(index)->soft(); }
const SoftBody& BulletSoftBodies::operator[](std::size_t index) const {
  return impl_->bodies.at(index)->soft();
}

BulletSoftBodies::Particle BulletSoftBodies::particle_of(const btCollisionObject& object) {
  if (!ContactSphere::is_shape_of(object)) return {};
  return {static_cast<const SoftBody*>(object.getUserPointer()),
          static_cast<std::size_t>(object.getUserIndex())};
}

std::chrono::nanoseconds BulletSoftBodies::time_spent(const btDynamicsWorld& world) {
  const BulletHook* const hook = BulletHook::find(world);
  return hook ? hook->spent() : std::chrono::nanoseconds(0);
}

}  // namespace softcell::ppu
