#include "ppu/bullet/rigid_touches.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>

#include "ppu/bullet/bullet_vector.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

constexpr int kFarthest = 4;  // bodies behind the one near a soft body; the others stand still for it

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
  const auto is_reached = [&](const btCollisionObject& object) {
    return is_reached_[static_cast<std::size_t>(object.getWorldArrayIndex())];
  };
  bool any = false;
  for (const btCollisionObject* const object : obstacles.objects()) {
    if (!is_dynamic(*object)) continue;
    is_reached(*object) = true;
    any = true;
  }
  if (!any) return {};
  const btDispatcher& dispatcher = *world.getDispatcher();
  manifolds_.clear();
  for (int i = 0; i < dispatcher.getNumManifolds(); ++i) {
    const btPersistentManifold& manifold =
        *const_cast<btDispatcher&>(dispatcher)
             .getManifoldByIndexInternal(i);  // not const where it only looks
    const auto counts = [&](const btCollisionObject& object) {
      return object.hasContactResponse() && !is_attached(object);
    };
    if (manifold.getNumContacts() > 0 && counts(first(manifold)) && counts(second(manifold)))
      manifolds_.push_back(&manifold);
  }
  for (int i = 0; i <= kFarthest; ++i) {
    const auto near = std::stable_partition(manifolds_.begin(), manifolds_.end(), [&](const auto* manifold) {
      return !is_reached(first(*manifold)) && !is_reached(second(*manifold));
    });
    if (near == manifolds_.end()) break;
    for (auto manifold = near; manifold != manifolds_.end(); ++manifold) {
      add(**manifold, obstacles);
      for (const btCollisionObject* const object : {&first(**manifold), &second(**manifold)})
        if (is_dynamic(*object)) is_reached(*object) = true;
    }
    manifolds_.erase(near, manifolds_.end());
  }
  return touches_;
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
