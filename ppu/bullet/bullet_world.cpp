#include "ppu/bullet/bullet_world.h"

#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "ppu/bullet/bullet_hook.h"
#include "ppu/bullet/bullet_vector.h"
#include "softcell/base/assert.h"
#include "softcell/bullet/bullet_soft_bodies.h"

namespace softcell::ppu {
namespace {

struct RigidBody {
  std::vector<std::unique_ptr<btCollisionShape>> parts;  // of a compound
  std::unique_ptr<btCollisionShape> shape;
  std::unique_ptr<btRigidBody> body;
  btTransform start;
  // From the frame in which the caller gives shapes to Bullet's, with its origin in the centre of mass and its axes along the principal
  // ones.
  btTransform inner = btTransform::getIdentity();
  bool is_moved = false;  // by move_to()
  btTransform end;        // for a moved one: its place at the next substep's end
};

struct Motor {
  btHingeConstraint* hinge = nullptr;
  float torque = 0;  // N m
};

/// The transform is exact if the rotation is the identity.
btTransform transform_of(const Eigen::Vector3f& position, const Eigen::Quaternionf& rotation) {
  btTransform transform(btQuaternion(rotation.x(), rotation.y(), rotation.z(), rotation.w()),
                        to_bullet(position));
  if (rotation.coeffs() == Eigen::Quaternionf::Identity().coeffs()) transform.getBasis().setIdentity();
  return transform;
}

void require_rotation(const Eigen::Quaternionf& rotation) {
  if (!(std::abs(rotation.norm() - 1) < 1e-3f))
    throw std::invalid_argument("a rigid body needs a rotation of unit length");
}

double milliseconds(std::chrono::nanoseconds time) {
  return std::chrono::duration<double, std::milli>(time).count();
}

}  // namespace

struct BulletWorld::Impl {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher{&configuration};
  // The fastest of Bullet's broad phases, measured on the demo's arena: 5 soft bodies of 1455 colliding particles, 6 boxes, 9 static
  // shapes, gravity turning. Milliseconds of CPU time per frame of two substeps, of which 0.9 are shape matching:
  //
  //     btDbvtBroadphase                    2.9     with deferred collide    4.1
  //     btAxisSweep3 (100 m of world)       3.1     bt32BitAxisSweep3        3.5
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world{&dispatcher, &broadphase, &solver, &configuration};
  std::vector<RigidBody> bodies;
  std::vector<std::unique_ptr<btHingeConstraint>> hinges;
  std::vector<Motor> motors;

  ~Impl() {
    for (const auto& hinge : hinges) world.removeConstraint(hinge.get());
    for (RigidBody& rigid : bodies) world.removeRigidBody(rigid.body.get());
  }

  std::size_t add(std::unique_ptr<btCollisionShape> shape, float mass, const btTransform& start,
                  float friction, float restitution, bool is_moved = false) {
    SC_ASSERT(shape != nullptr && mass >= 0 && friction >= 0 && restitution >= 0,
              "rigid body {} has a mass of {} kg, friction {} and restitution {}", bodies.size(), mass,
              friction, restitution);
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape.get(), inertia);
    info.m_startWorldTransform = start;
    info.m_friction = friction;
    info.m_restitution = restitution;
    auto body = std::make_unique<btRigidBody>(info);
    if (is_moved)
      body->setCollisionFlags((body->getCollisionFlags() & ~btCollisionObject::CF_STATIC_OBJECT) |
                              btCollisionObject::CF_KINEMATIC_OBJECT);
    if (mass > 0 || is_moved) body->setActivationState(DISABLE_DEACTIVATION);
    world.addRigidBody(body.get());
    RigidBody& rigid = bodies.emplace_back();
    rigid.shape = std::move(shape);
    rigid.body = std::move(body);
    rigid.start = rigid.end = start;
    rigid.is_moved = is_moved;
    return bodies.size() - 1;
  }

  /// Bullet computes the velocity of a moved body from its last and its present place: these are set so that it is the substep's.
  void begin_moves() {
    for (RigidBody& rigid : bodies) {
      if (!rigid.is_moved) continue;
      const btTransform now = rigid.body->getWorldTransform();
      const btMatrix3x3 turn = rigid.end.getBasis() * now.getBasis().transpose();
      rigid.body->setInterpolationWorldTransform(btTransform(
          turn.transpose() * now.getBasis(), now.getOrigin() - (rigid.end.getOrigin() - now.getOrigin())));
    }
  }
  void end_moves() {
    for (RigidBody& rigid : bodies) {
      if (!rigid.is_moved) continue;
      rigid.body->setWorldTransform(rigid.end);
      rigid.body->setInterpolationWorldTransform(rigid.end);
    }
  }

  void teleport(btRigidBody& body, const btTransform& pose, const btVector3& velocity,
                const btVector3& turn) {
    body.setWorldTransform(pose);
    body.setInterpolationWorldTransform(pose);
    body.setLinearVelocity(velocity);
    body.setAngularVelocity(turn);
    body.clearForces();
    world.getBroadphase()->getOverlappingPairCache()->cleanProxyFromPairs(body.getBroadphaseProxy(),
                                                                          &dispatcher);
  }
};

BulletWorld::BulletWorld() : impl_(std::make_unique<Impl>()) {
  btContactSolverInfo& solver = impl_->world.getSolverInfo();
  solver.m_solverMode = SOLVER_USE_WARMSTARTING;  // in order, and without code chosen by the processor
  // Penetration is corrected by moving bodies apart, never by a velocity: that would throw soft bodies upwards.
  solver.m_splitImpulse = 1;
  solver.m_splitImpulsePenetrationThreshold = 0;
  set_gravity({0, -9.81f, 0});
}

BulletWorld::~BulletWorld() = default;

std::size_t BulletWorld::add_box(const Eigen::Vector3f& size, float mass, const Eigen::Vector3f& position,
                                 float friction, float restitution, const Eigen::Quaternionf& rotation) {
  if (!(size.minCoeff() > 0) || !(mass >= 0) || !(friction >= 0)) {
    throw std::invalid_argument("a box needs edges above 0, and a mass and friction of 0 or above");
  }
  if (!(restitution >= 0 && restitution <= 1))
    throw std::invalid_argument("a box needs a restitution from 0 to 1");
  require_rotation(rotation);
  return impl_->add(std::make_unique<btBoxShape>(to_bullet(size / 2)), mass, transform_of(position, rotation),
                    friction, restitution);
}

std::size_t BulletWorld::add_body(std::span<const RigidShape> shapes, const RigidBodySettings& settings) {
  const float mass = settings.mass;
  if (shapes.empty()) throw std::invalid_argument("a rigid body needs a shape");
  if (!(mass >= 0) || !(settings.friction >= 0) ||
      !(settings.restitution >= 0 && settings.restitution <= 1)) {
    throw std::invalid_argument(
        "a rigid body needs a mass and friction of 0 or above, and a restitution from 0 to 1");
  }
  if (settings.is_moved && mass > 0)
    throw std::invalid_argument("a rigid body that the program moves has no mass");
  require_rotation(settings.rotation);
  const btTransform start = transform_of(settings.position, settings.rotation);
  if (shapes.size() == 1 && is_in_the_middle(shapes[0]))
    return impl_->add(make_bullet_shape(shapes[0]), mass, start, settings.friction, settings.restitution,
                      settings.is_moved);
  std::vector<std::unique_ptr<btCollisionShape>> parts;
  std::vector<btScalar> masses;
  float volume = 0;
  for (const RigidShape& shape : shapes) volume += volume_of(shape);
  btCompoundShape together;
  for (const RigidShape& shape : shapes) {
    parts.push_back(make_bullet_shape(shape));
    together.addChildShape(transform_of(shape.position, shape.rotation), parts.back().get());
    masses.push_back((mass > 0 ? mass : 1) * volume_of(shape) / volume);
  }
  btTransform inner = btTransform::getIdentity();
  btVector3 inertia(0, 0, 0);
  if (mass > 0) together.calculatePrincipalAxisTransform(masses.data(), inner, inertia);
  auto compound = std::make_unique<btCompoundShape>();
  for (int i = 0; i < together.getNumChildShapes(); ++i)
    compound->addChildShape(inner.inverse() * together.getChildTransform(i), together.getChildShape(i));
  const std::size_t body = impl_->add(std::move(compound), mass, start * inner, settings.friction,
                                      settings.restitution, settings.is_moved);
  RigidBody& rigid = impl_->bodies[body];
  rigid.parts = std::move(parts);
  rigid.inner = inner;
  if (mass > 0) {  // Bullet's own inertia is that of a box around it
    rigid.body->setMassProps(mass, inertia);
    rigid.body->updateInertiaTensor();
  }
  return body;
}

void BulletWorld::move_to(std::size_t body, const Eigen::Vector3f& position,
                          const Eigen::Quaternionf& rotation) {
  RigidBody& rigid = impl_->bodies.at(body);
  SC_ASSERT(rigid.is_moved, "body {}, which the program does not move, is moved", body);
  SC_ASSERT(position.allFinite() && std::abs(rotation.norm() - 1) < 1e-3f,
            "body {} is moved to ({}, {}, {}), turned by a quaternion {} long", body, position.x(),
            position.y(), position.z(), rotation.norm());
  rigid.end = transform_of(position, rotation) * rigid.inner;
}

void BulletWorld::teleport(std::size_t body, const Eigen::Vector3f& position,
                           const Eigen::Quaternionf& rotation) {
  move_to(body, position, rotation);
  RigidBody& rigid = impl_->bodies.at(body);
  impl_->teleport(*rigid.body, rigid.end, {0, 0, 0}, {0, 0, 0});
}

void BulletWorld::add_hinge(const Hinge& hinge) {
  SC_ASSERT(hinge.a != hinge.b && hinge.a < impl_->bodies.size() && hinge.b < impl_->bodies.size(),
            "a hinge of bodies {} and {} of {}", hinge.a, hinge.b, impl_->bodies.size());
  SC_ASSERT(std::abs(hinge.axis.norm() - 1) < 1e-3f && hinge.torque >= 0,
            "a hinge with an axis {} long and a torque of {} N m", hinge.axis.norm(), hinge.torque);
  btRigidBody& a = *impl_->bodies[hinge.a].body;
  btRigidBody& b = *impl_->bodies[hinge.b].body;
  SC_ASSERT(a.getInvMass() > 0 || b.getInvMass() > 0, "a hinge of bodies {} and {}, neither of which moves",
            hinge.a, hinge.b);
  const auto place = [&](const btRigidBody& body) {
    return body.getWorldTransform().inverse() * to_bullet(hinge.point);
  };
  const auto direction = [&](const btRigidBody& body) {
    return body.getWorldTransform().getBasis().transpose() * to_bullet(hinge.axis);
  };
  // Bullet's motor rotates its first body against its second one.
  auto joint = std::make_unique<btHingeConstraint>(b, a, place(b), place(a), direction(b), direction(a));
  impl_->world.addConstraint(joint.get(), true);
  if (hinge.torque > 0) {
    joint->enableAngularMotor(true, hinge.speed, 0);
    impl_->motors.push_back({joint.get(), hinge.torque});
  }
  impl_->hinges.push_back(std::move(joint));
}

std::size_t BulletWorld::add_convex(const TriangleMesh& mesh, const Eigen::Vector3f& position, float friction,
                                    float restitution) {
  if (mesh.positions.empty()) throw std::invalid_argument("a convex obstacle needs a mesh with positions");
  auto hull = std::make_unique<btConvexHullShape>();
  for (const Eigen::Vector3f& p : mesh.positions) hull->addPoint(to_bullet(p), false);
  hull->optimizeConvexHull();  // drops inner points: GJK looks at every point
  hull->recalcLocalAabb();
  return impl_->add(std::move(hull), 0, btTransform(btMatrix3x3::getIdentity(), to_bullet(position)),
                    friction, restitution);
}

void BulletWorld::reset() {
  for (RigidBody& rigid : impl_->bodies) {
    impl_->teleport(*rigid.body, rigid.start, {0, 0, 0}, {0, 0, 0});
    rigid.end = rigid.start;
  }
}

bool BulletWorld::moves(std::size_t body) const { return impl_->bodies.at(body).body->getInvMass() > 0; }

BulletWorld::Motion BulletWorld::motion(std::size_t body) const {
  const btRigidBody& rigid = *impl_->bodies.at(body).body;
  const btTransform& pose = rigid.getWorldTransform();
  return {.position = to_eigen(pose.getOrigin()),
          .rotation = Eigen::Quaternionf(to_eigen(pose.getBasis())).normalized(),
          .velocity = to_eigen(rigid.getLinearVelocity()),
          .angular_velocity = to_eigen(rigid.getAngularVelocity())};
}

void BulletWorld::teleport(std::size_t body, const Motion& motion) {
  SC_ASSERT(moves(body), "rigid body {} does not move, and is put elsewhere", body);
  const Eigen::Quaternionf& q = motion.rotation;
  SC_ASSERT(std::abs(q.norm() - 1) < 1e-3f, "a rotation of rigid body {} has the length {}", body, q.norm());
  impl_->teleport(*impl_->bodies.at(body).body, transform_of(motion.position, q), to_bullet(motion.velocity),
                  to_bullet(motion.angular_velocity));
}

Eigen::Matrix4f BulletWorld::pose(std::size_t body) const {
  const RigidBody& rigid = impl_->bodies.at(body);
  const btTransform& own = rigid.body->getWorldTransform();
  Eigen::Matrix4f pose;  // in column order, like Bullet's
  if (rigid.parts.empty())
    own.getOpenGLMatrix(pose.data());
  else
    (own * rigid.inner.inverse()).getOpenGLMatrix(pose.data());
  return pose;
}

btRigidBody& BulletWorld::rigid_body(std::size_t body) { return *impl_->bodies.at(body).body; }

std::size_t BulletWorld::rigid_bodies() const { return impl_->bodies.size(); }

std::vector<BulletWorld::RayHit> BulletWorld::cast_ray(const Eigen::Vector3f& from,
                                                       const Eigen::Vector3f& to) const {
  SC_ASSERT(from.allFinite() && to.allFinite() && from != to, "a ray from ({}, {}, {})", from.x(), from.y(),
            from.z());
  std::vector<RayHit> hits;
  const btTransform begin(btQuaternion::getIdentity(), to_bullet(from));
  const btTransform end(btQuaternion::getIdentity(), to_bullet(to));
  for (std::size_t i = 0; i < impl_->bodies.size(); ++i) {
    btRigidBody& body = *impl_->bodies[i].body;
    btCollisionWorld::ClosestRayResultCallback nearest(to_bullet(from), to_bullet(to));
    btCollisionWorld::rayTestSingle(begin, end, &body, body.getCollisionShape(), body.getWorldTransform(),
                                    nearest);
    if (nearest.hasHit())
      hits.push_back({i, nearest.m_closestHitFraction, to_eigen(nearest.m_hitPointWorld)});
  }
  std::ranges::stable_sort(hits, {}, &RayHit::share);
  return hits;
}

bool BulletWorld::is_free(const Eigen::Vector3f& low, const Eigen::Vector3f& high) const {
  SC_ASSERT(low.allFinite() && high.allFinite() && (low.array() < high.array()).all(),
            "a box from ({}, {}, {}) to ({}, {}, {})", low.x(), low.y(), low.z(), high.x(), high.y(),
            high.z());
  struct Anything : btCollisionWorld::ContactResultCallback {
    bool found = false;
    btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper* /*a*/, int, int,
                             const btCollisionObjectWrapper* /*b*/, int, int) override {
      found = found || point.getDistance() <= 0;
      return 0;
    }
  } anything;
  btBoxShape shape(to_bullet(0.5f * (high - low)));
  btCollisionObject box;
  box.setCollisionShape(&shape);
  box.setWorldTransform(btTransform(btQuaternion::getIdentity(), to_bullet(0.5f * (low + high))));
  impl_->world.contactTest(&box, anything);
  return !anything.found;
}

void BulletWorld::set_gravity(const Eigen::Vector3f& gravity) { impl_->world.setGravity(to_bullet(gravity)); }

StepTimes BulletWorld::step(float seconds, int substeps) {
  if (!(seconds > 0) || substeps < 1) {
    throw std::invalid_argument("a step needs a time above 0 and at least one substep");
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto soft_begin = BulletHook::spent_in(impl_->world);
  const float substep = seconds / static_cast<float>(substeps);
  // One call per substep: with maxSubSteps = 0 Bullet takes the step as it is, and keeps no remainder.
  for (const Motor& motor : impl_->motors) motor.hinge->setMaxMotorImpulse(motor.torque * substep);
  for (int i = 0; i < substeps; ++i) {
    impl_->begin_moves();
    impl_->world.stepSimulation(substep, 0);
    impl_->end_moves();
  }
  const auto soft = BulletHook::spent_in(impl_->world) - soft_begin;
  const auto all = std::chrono::steady_clock::now() - begin;
  return {.physics_ms = milliseconds(all - soft), .soft_body_ms = milliseconds(soft)};
}

void BulletWorld::contacts(std::vector<Contact>& contacts) const {
  contacts.clear();
  const auto side = [](const btCollisionObject* object) -> Contact::Body {
    const SoftBody<3>* const soft = BulletSoftBodies::particle_of(*object).body;
    return soft != nullptr ? Contact::Body{.soft = soft} : Contact::Body{.object = object};
  };
  const btDispatcher& dispatcher = impl_->dispatcher;
  for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *impl_->dispatcher.getManifoldByIndexInternal(m);
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      const btManifoldPoint& point = manifold.getContactPoint(p);
      if (point.getAppliedImpulse() <= 0) continue;
      contacts.push_back({.position = to_eigen(point.getPositionWorldOnB()),
                          .normal = to_eigen(point.m_normalWorldOnB),
                          .impulse = point.getAppliedImpulse(),
                          .first = side(manifold.getBody0()),
                          .second = side(manifold.getBody1())});
    }
  }
}

btDiscreteDynamicsWorld& BulletWorld::world() { return impl_->world; }
const btDiscreteDynamicsWorld& BulletWorld::world() const { return impl_->world; }

}  // namespace softcell::ppu
