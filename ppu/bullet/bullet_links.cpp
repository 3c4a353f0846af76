#include "ppu/bullet/bullet_links.h"

#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <algorithm>

#include "ppu/bullet/bullet_vector.h"
#include "ppu/bullet/joint_rows.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

/// A joint to the world has a body that is in no world.
bool is_in_world(const btCollisionObject& object) { return object.getWorldArrayIndex() >= 0; }

std::uint32_t index_of(const btCollisionObject& object) {
  return static_cast<std::uint32_t>(object.getWorldArrayIndex());
}

/// Whether impulses move the object.
bool is_dynamic(const btCollisionObject& object) {
  const btRigidBody* const body = btRigidBody::upcast(&object);
  return body != nullptr && !body->isStaticOrKinematicObject() && is_in_world(object);
}

const btCollisionObject& first(const btPersistentManifold& manifold) { return *manifold.getBody0(); }
const btCollisionObject& second(const btPersistentManifold& manifold) { return *manifold.getBody1(); }

}  // namespace

RigidLinks BulletLinks::find(const btDiscreteDynamicsWorld& world, BulletObstacles& obstacles,
                             const std::function<bool(const btCollisionObject&)>& is_attached, float step) {
  touches_.clear();
  rows_.clear();
  const auto moves = [](const btCollisionObject* object) { return is_dynamic(*object); };
  if (std::ranges::none_of(obstacles.objects(), moves)) return {};
  // Bullet's world and dispatcher are not const even for reading.
  auto& bullet = const_cast<btDiscreteDynamicsWorld&>(world);
  manifolds_.clear();
  for (int i = 0; i < bullet.getDispatcher()->getNumManifolds(); ++i) {
    const btPersistentManifold* const manifold = bullet.getDispatcher()->getManifoldByIndexInternal(i);
    if (manifold->getNumContacts() > 0) manifolds_.push_back(manifold);
  }
  joints_.clear();
  joined_.reset(static_cast<std::size_t>(world.getNumCollisionObjects()));
  for (int i = 0; i < bullet.getNumConstraints(); ++i) {
    btTypedConstraint& joint = *bullet.getConstraint(i);
    const btRigidBody &a = joint.getRigidBodyA(), &b = joint.getRigidBodyB();
    if (!joint.isEnabled() || is_attached(a) || is_attached(b)) continue;
    joints_.push_back(&joint);
    if (is_dynamic(a) && is_dynamic(b)) joined_.unite(index_of(a), index_of(b));
  }
  is_reached_.assign(joined_.numbers(), false);
  for (const btCollisionObject* const object : obstacles.objects()) reach(*object);
  for (int i = 0; i <= kFarthestTouch; ++i)
    if (!add_reached(obstacles, is_attached)) break;
  // Joints see where a body is, and have no part in how the program moves it there.
  const auto rigid_of = [&](btRigidBody& body) {
    return is_in_world(body) && !obstacles.is_moved_by_place(body) ? obstacles.rigid_of(body)
                                                                   : JointRow::kWorld;
  };
  for (btTypedConstraint* const joint : joints_) {
    btRigidBody &a = joint->getRigidBodyA(), &b = joint->getRigidBodyB();
    if (is_reached(a) || is_reached(b))
      add_joint_rows(*joint, rigid_of(a), rigid_of(b), world.getSolverInfo(), step, rows_);
  }
  return {touches_, rows_};
}

bool BulletLinks::is_reached(const btCollisionObject& object) {
  return is_in_world(object) && is_reached_[joined_.find(index_of(object))];
}

/// Marks an object as reached, with all that is joined to it.
void BulletLinks::reach(const btCollisionObject& object) {
  if (is_dynamic(object)) is_reached_[joined_.find(index_of(object))] = true;
}

/// Adds the contacts of all that is reached and marks what it touches. @return whether there is something new
bool BulletLinks::add_reached(BulletObstacles& obstacles,
                              const std::function<bool(const btCollisionObject&)>& is_attached) {
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

void BulletLinks::add(const btPersistentManifold& manifold, BulletObstacles& obstacles) {
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
