#include "ppu/bullet/seen_object.h"

#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>

#include "ppu/bullet/bullet_vector.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

SeenObject::SeenObject(const btDiscreteDynamicsWorld& world, int place) : place_(place) {
  SC_ASSERT(place >= 0 && place < world.getNumCollisionObjects(), "object {} of {} is seen", place,
            world.getNumCollisionObjects());
  object_ = world.getCollisionObjectArray()[place];
  pose_ = object_->getWorldTransform();
  look_ = look_at(*object_);
}

bool SeenObject::has_changed(const btDiscreteDynamicsWorld& world, const Eigen::Vector3f& point, float far) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  // Bullet moves the last object of its list to the place of a removed one.
  if (place_ >= objects.size() || objects[place_] != object_) place_ = place_of(world, object_);
  if (place_ < 0 || look_at(*object_) != look_) return true;
  const btVector3 here = to_bullet(point), there = object_->getWorldTransform() * pose_.invXform(here);
  return there.distance2(here) > far * far;
}

int SeenObject::place_of(const btDiscreteDynamicsWorld& world, const btCollisionObject* object) {
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  for (int i = 0; i < objects.size(); ++i)
    if (objects[i] == object) return i;
  return -1;
}

SeenObject::Look SeenObject::look_at(const btCollisionObject& object) {
  const btCollisionShape& shape = *object.getCollisionShape();
  const btBroadphaseProxy& proxy = *object.getBroadphaseHandle();
  Look look;
  look.shape = &shape;
  look.kind = shape.getShapeType();
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  look.box = {low.x(), low.y(), low.z(), high.x(), high.y(), high.z()};
  if (look.kind == COMPOUND_SHAPE_PROXYTYPE)
    look.revision = static_cast<const btCompoundShape&>(shape).getUpdateRevision();
  if (look.kind == STATIC_PLANE_PROXYTYPE) {  // its box is infinite
    const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
    const btVector3& normal = plane.getPlaneNormal();
    look.plane = {normal.x(), normal.y(), normal.z(), plane.getPlaneConstant()};
  }
  look.group = proxy.m_collisionFilterGroup;
  look.mask = proxy.m_collisionFilterMask;
  look.keeps_out = object.hasContactResponse();
  return look;
}

}  // namespace softcell::ppu
