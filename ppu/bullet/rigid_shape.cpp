#include "ppu/bullet/rigid_shape.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>

#include <algorithm>
#include <stdexcept>

#include "ppu/bullet/bullet_vector.h"
#include "ppu/numbers/deterministic_math.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {

bool is_in_the_middle(const RigidShape& shape) {
  return shape.position.isZero(0) && shape.rotation.vec().isZero(0);
}

float volume_of(const RigidShape& shape) {
  const auto pi = static_cast<float>(kPi);
  const float circle = pi * shape.radius * shape.radius;
  const float ball = circle * shape.radius * 4 / 3;
  switch (shape.kind) {
    case RigidShapeKind::kBox:
      return shape.size.prod();
    case RigidShapeKind::kSphere:
      return ball;
    case RigidShapeKind::kCylinder:
      return circle * shape.height;
    case RigidShapeKind::kCapsule:
      return circle * (shape.height - 2 * shape.radius) + ball;
    case RigidShapeKind::kCone:
      return circle * shape.height / 3;
  }
  SC_ASSERT(false, "a rigid shape of kind {}", static_cast<int>(shape.kind));
  return 0;
}

std::unique_ptr<btCollisionShape> make_bullet_shape(const RigidShape& shape) {
  const bool is_box = shape.kind == RigidShapeKind::kBox;
  if (is_box && !(shape.size.minCoeff() > 0)) throw std::invalid_argument("a rigid box needs edges above 0");
  if (!is_box && !(shape.radius > 0))
    throw std::invalid_argument("a round rigid shape needs a radius above 0");
  if (!is_box && shape.kind != RigidShapeKind::kSphere && !(shape.height > 0))
    throw std::invalid_argument("a rigid cylinder, capsule or cone needs a height above 0");
  if (shape.kind == RigidShapeKind::kCapsule && !(shape.height > 2 * shape.radius))
    throw std::invalid_argument("a rigid capsule needs a height of more than twice its radius");
  switch (shape.kind) {
    case RigidShapeKind::kBox:
      return std::make_unique<btBoxShape>(to_bullet(shape.size / 2));
    case RigidShapeKind::kSphere:
      return std::make_unique<btSphereShape>(shape.radius);
    case RigidShapeKind::kCylinder:
      return std::make_unique<btCylinderShape>(btVector3(shape.radius, shape.height / 2, shape.radius));
    case RigidShapeKind::kCapsule:
      return std::make_unique<btCapsuleShape>(shape.radius, shape.height - 2 * shape.radius);
    case RigidShapeKind::kCone: {
      auto cone = std::make_unique<btConeShape>(shape.radius, shape.height);
      // Bullet adds its margin outside of a cone, so the cone's lengths would not be as stated.
      constexpr float kMargin = 0.005f;
      cone->setMargin(kMargin * std::min(shape.radius, shape.height));
      return cone;
    }
  }
  SC_ASSERT(false, "a rigid shape of kind {}", static_cast<int>(shape.kind));
  return nullptr;
}

}  // namespace softcell::ppu
