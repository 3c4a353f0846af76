#include "ppu/bullet/rigid_touches.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>

#include "ppu/bullet/bullet_vector.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

/// What impulses move.
bool is_dynamic(const btCollisionObject& object) {
  const btRigidBody* const body = btRigidBody::upcast(&object);
  return body != nullptr && !body->isStaticOrKinematicObject();
}

const btCollisionObject& first(const btPersistentManifold& manifold) { return *manifold.getBody0(); }
const btCollisionObject& second(const btPersistentManifold& manifold) { return *manifold.getBody1(); }

}  // namespace

std::span<const RigidTouch> RigidTouches::find(
    const btDiscreteDynamicsWorld& world, BulletObstacles& obstacles,
    const std::function<bool(const btCollisionObject&)>& is_attached) {
  touches_.clear();
  is_reached_.assign(static_cast<std::size_t>(world.getNumCollisionObjects()), false);
  for (const btCollisionObject* const object : obstacles.objects()) reach(*object);
  if (std::ranges::find(is_reached_, true) == is_reached_.end()) return {};
  // Bullet's dispatcher is not const where one only looks.
  btDispatcher& dispatcher = *const_cast<btDiscreteDynamicsWorld&>(world).getDispatcher();
  manifolds_.clear();
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold* const manifold = dispatcher.getManifoldByIndexInternal(i);
    if (manifold->getNumContacts() > 0) manifolds_.push_back(manifold);
  }
  for (int i = 0; i <= kFarthestTouch; ++i)
    if (!add_reached(obstacles, is_attached)) break;
  return touches_;
}

void RigidTouches::reach(const btCollisionObject& object) {
  if (is_dynamic(object)) is_reached_[static_cast<std::size_t>(object.getWorldArrayIndex())] = true;
}

/// Of all that is reached; what it touches is reached then. @return whether there is something new
bool RigidTouches::add_reached(BulletObstacles& obstacles,
                               const std::function<bool(const btCollisionObject&)>& is_attached) {
  const auto is_reached = [&](const btCollisionObject& object) -> bool {
    return is_reached_[static_cast<std::size_t>(object.getWorldArrayIndex())];
  };
  const auto counts = [&](const btCollisionObject& object) {
    return object.hasContactResponse() && !is_attached(object);
  };
  near_.clear();
  std::erase_if(manifolds_, [&](const btPersistentManifold* manifold) {
    if (!is_reached(first(*manifold)) && !is_reached(second(*manifold))) return false;
    if (counts(first(*manifold)) && counts(second(*manifold))) near_.push_back(manifold);
    return true;
  });
  for (const btPersistentManifold* const manifold : near_) {
    add(*manifold, obstacles);
    reach(first(*manifold));
    reach(second(*manifold));
  }
  return !near_.empty();
}

void RigidTouches::add(const btPersistentManifold& manifold, BulletObstacles& obstacles) {
  const auto rigid_of = [&](const btCollisionObject& object) {
    return obstacles.rigid_of(const_cast<btCollisionObject&>(object));
  };
  const std::uint32_t a = rigid_of(first(manifold)), b = rigid_of(second(manifold));
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& point = manifold.getContactPoint(i);
    const Vector3f at_a = to_eigen(first(manifold).getWorldTransform() * point.m_localPointA);
    const Vector3f at_b = to_eigen(second(manifold).getWorldTransform() * point.m_localPointB);
    const Vector3f normal = to_eigen(point.m_normalWorldOnB);
    touches_.push_back({.a = a,
                        .b = b,
                        .point = at_b,
                        .normal = normal,
                        .gap = normal.dot(at_a - at_b),
                        .friction = point.m_combinedFriction});
  }
}

}  // namespace softcell::ppu
