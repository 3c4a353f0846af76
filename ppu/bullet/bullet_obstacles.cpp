#include "ppu/bullet/bullet_obstacles.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btCompoundShape.h>
#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <BulletCollision/CollisionShapes/btConeShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "ppu/bullet/bullet_vector.h"
#include "ppu/bullet/may_move.h"
#include "ppu/bullet/mesh_triangles.h"
#include "ppu/numbers/deterministic_math.h"
#include "ppu/numbers/keep_each_once.h"
#include "ppu/obstacles/round_edges.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Matrix3f;
using Eigen::Vector3f;

constexpr int kRimPoints = 24;  // on the circles of cylinders and cones
constexpr std::uint32_t kNone = ~0u;

/// Turns the y axis into Bullet's axis of a capsule, cylinder or cone.
Matrix3f from_y_to(int axis) {
  SC_ASSERT(axis >= 0 && axis < 3, "axis {} of a shape", axis);
  Matrix3f turn = Matrix3f::Identity();
  if (axis == 0) turn << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  if (axis == 2) turn << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return turn;
}

/// Turns the y axis into a plane's normal.
Matrix3f from_y_to(const Vector3f& normal) {
  return Eigen::Quaternionf::FromTwoVectors(Vector3f::UnitY(), normal).toRotationMatrix();
}

void add_edges_of_box(const Vector3f& half, std::vector<ObstacleEdge>& edges) {
  for (int d = 0; d < 3; ++d) {
    for (unsigned i = 0; i < 4; ++i) {
      Vector3f from = -half;
      if ((i & 1u) != 0) from[(d + 1) % 3] = half[(d + 1) % 3];
      if ((i & 2u) != 0) from[(d + 2) % 3] = half[(d + 2) % 3];
      Vector3f to = from;
      to[d] = half[d];
      edges.push_back({from, to});
    }
  }
}

/// The corners of a rim of radius 1; the first one comes again at the end.
const std::array<Eigen::Vector2f, kRimPoints + 1>& unit_rim() {
  static const auto rim = [] {
    std::array<Eigen::Vector2f, kRimPoints + 1> corners;
    for (int i = 0; i <= kRimPoints; ++i) {
      const double angle = 2 * std::numbers::pi * i / kRimPoints;
      corners[static_cast<std::size_t>(i)] = {static_cast<float>(cosine(angle)),
                                              static_cast<float>(sine(angle))};
    }
    return corners;
  }();
  return rim;
}

void add_rim(float radius, float height, std::vector<ObstacleEdge>& edges) {
  const auto point = [&](std::size_t i) {
    return Vector3f(radius * unit_rim()[i].x(), height, radius * unit_rim()[i].y());
  };
  for (std::size_t i = 0; i < kRimPoints; ++i) edges.push_back({point(i), point(i + 1)});
}

/// Half of a shape's length; a thickness if it is tiny compared with the longest half.
float with_thickness(float half, float longest) {
  return half < kNoLength * longest ? kThickness * longest : half;
}
Vector3f extent_of(const btBoxShape& box) {
  const Vector3f extent = to_eigen(box.getHalfExtentsWithMargin());
  return extent.unaryExpr([&](float half) { return with_thickness(half, extent.maxCoeff()); });
}

// What an obstacle of a shape is. The obstacle has the shape's place already.

void set_plane(const btStaticPlaneShape& plane, Obstacle& obstacle) {
  const Vector3f normal = to_eigen(plane.getPlaneNormal());
  obstacle.kind = ObstacleKind::kPlane;
  obstacle.position += obstacle.rotation * (plane.getPlaneConstant() * normal);
  obstacle.rotation = obstacle.rotation * from_y_to(normal);
}

void set_sphere(const btSphereShape& sphere, Obstacle& obstacle, std::vector<ObstacleEdge>& edges) {
  obstacle.kind = ObstacleKind::kBox;
  obstacle.rounding = sphere.getRadius();
  edges.push_back({Vector3f::Zero(), Vector3f::Zero()});
  obstacle.edges = edges;
}

void set_box(const btBoxShape& box, Obstacle& obstacle, std::vector<ObstacleEdge>& edges) {
  obstacle.kind = ObstacleKind::kBox;
  obstacle.extent = extent_of(box);
  add_edges_of_box(obstacle.extent, edges);
  obstacle.edges = edges;
}

void set_capsule(const btCapsuleShape& capsule, Obstacle& obstacle, std::vector<ObstacleEdge>& edges) {
  obstacle.kind = ObstacleKind::kBox;
  obstacle.rotation = obstacle.rotation * from_y_to(capsule.getUpAxis());
  obstacle.extent = {0, capsule.getHalfHeight(), 0};
  obstacle.rounding = capsule.getRadius();
  edges.push_back({-obstacle.extent, obstacle.extent});
  obstacle.edges = edges;
}

void set_cylinder(const btCylinderShape& cylinder, Obstacle& obstacle, std::vector<ObstacleEdge>& edges) {
  const int axis = cylinder.getUpAxis();
  obstacle.kind = ObstacleKind::kCylinder;
  obstacle.rotation = obstacle.rotation * from_y_to(axis);
  obstacle.extent = {cylinder.getRadius(),
                     with_thickness(cylinder.getHalfExtentsWithMargin()[axis], cylinder.getRadius()), 0};
  for (const float height : {-obstacle.extent.y(), obstacle.extent.y()})
    add_rim(obstacle.extent.x(), height, edges);
  add_axis_of_cylinder(obstacle.extent.x(), obstacle.extent.y(), edges);
  obstacle.edges = edges;
}

void set_cone(const btConeShape& cone, Obstacle& obstacle, std::vector<ObstacleEdge>& edges) {
  obstacle.kind = ObstacleKind::kCone;
  obstacle.rotation = obstacle.rotation * from_y_to(cone.getConeUpIndex());
  obstacle.extent = {cone.getRadius(), cone.getHeight() / 2, 0};
  add_axis_of_cone(obstacle.extent.x(), obstacle.extent.y(), edges);
  add_rim(obstacle.extent.x(), -obstacle.extent.y(), edges);
  obstacle.edges = edges;
}

void set_multi_sphere(const btMultiSphereShape& shape, Obstacle& obstacle, std::vector<ObstacleEdge>& edges) {
  set_sphere_or_capsule(shape, obstacle);
  edges.push_back({-obstacle.extent, obstacle.extent});
  obstacle.edges = edges;
}

bool is_under_way(const btCollisionObject& object) { return may_move(object) && object.isActive(); }

/// The velocity without contacts: Bullet adds forces, gravity among them, later in its step.
Vector3f velocity_in(float step, const btRigidBody& body) {
  const Vector3f velocity = to_eigen(velocity_of(body));
  if (body.isStaticOrKinematicObject()) return velocity;
  return velocity + step * body.getInvMass() * to_eigen(body.getTotalForce());
}

/// The spin without contacts: Bullet adds torques later in its step.
Vector3f spin_in(float step, const btRigidBody& body) {
  const Vector3f spin = to_eigen(spin_of(body));
  if (body.isStaticOrKinematicObject()) return spin;
  return spin + step * (to_eigen(body.getInvInertiaTensorWorld()) * to_eigen(body.getTotalTorque()));
}

/// As in Bullet's own solver, the factors multiply what impulses do along the world's axes, and about them.
void set_mobility(const btRigidBody& body, ContactRigid& rigid) {
  const Vector3f linear = to_eigen(body.getLinearFactor()), angular = to_eigen(body.getAngularFactor());
  if (linear.isZero(0) && angular.isZero(0)) return;  // no impulse moves it
  rigid.inverse_mass = body.getInvMass();
  rigid.inverse_inertia =
      angular.asDiagonal() * to_eigen(body.getInvInertiaTensorWorld()) * angular.asDiagonal();
  if (linear == Vector3f::Ones()) return;
  rigid.held = HeldMobility{.linear = (rigid.inverse_mass * linear).asDiagonal(),
                            .coupling = Eigen::Matrix3f::Zero(),
                            .angular = rigid.inverse_inertia};
}

/// Without the components along, or about, the axes that a factor of 0 keeps still.
btVector3 where_it_moves(const btVector3& change, const btVector3& factor) {
  return {factor.x() == 0 ? 0 : change.x(), factor.y() == 0 ? 0 : change.y(),
          factor.z() == 0 ? 0 : change.z()};
}

/// Whether nothing moves an object but the program by its place. Bullet gives kinematic bodies a velocity, unless they are asleep, but not
/// other kinematic objects.
bool may_be_moved_by_place(const btCollisionObject& object) {
  const btRigidBody* const body = btRigidBody::upcast(&object);
  if (body == nullptr) return true;
  return body->isKinematicObject() ? body->getActivationState() == ISLAND_SLEEPING : body->isStaticObject();
}

Pose as_pose(const btTransform& pose) { return {to_eigen(pose.getOrigin()), to_eigen(pose.getBasis())}; }

/// Metres, along its longest axis.
float size_of(const btCollisionShape& shape) {
  btVector3 low, high;
  shape.getAabb(btTransform::getIdentity(), low, high);
  return to_eigen(high - low).maxCoeff();
}

/// How far any point of a shape is from its origin at most, metres.
float reach_of(const btCollisionShape& shape) {
  btVector3 centre;
  btScalar radius = 0;
  shape.getBoundingSphere(centre, radius);
  return centre.length() + radius;
}

/// Collects the objects that the broad phase finds.
struct Collector final : btBroadphaseAabbCallback {
  Collector(int its_group, int its_mask, std::vector<const btBroadphaseProxy*>& list)
      : group(its_group), mask(its_mask), found(list) {}
  int group, mask;
  std::vector<const btBroadphaseProxy*>& found;
  bool process(const btBroadphaseProxy* proxy) override {
    if ((proxy->m_collisionFilterGroup & mask) != 0 && (proxy->m_collisionFilterMask & group) != 0)
      found.push_back(proxy);
    return true;
  }
};

/// The next list, emptied: it keeps its allocated room from one substep to the next.
template <typename T>
std::vector<T>& next_list(std::vector<std::vector<T>>& lists, std::size_t& used) {
  if (used == lists.size()) lists.emplace_back();
  lists[used].clear();
  return lists[used++];
}

}  // namespace

BulletObstacles::Way BulletObstacles::way_of(const btCollisionObject& object) const {
  if (const MovedByPlace* const moved = moved_by_place_of(object))
    return {step_ * moved->velocity, step_ * moved->spin.norm() * reach_of(*object.getCollisionShape())};
  const btRigidBody* const body = btRigidBody::upcast(&object);
  if (body == nullptr || !is_under_way(object)) return {};
  return {step_ * velocity_in(step_, *body),
          step_ * spin_in(step_, *body).norm() * reach_of(*body->getCollisionShape())};
}

/// The box around a box with that motion.
Bounds<3> BulletObstacles::ahead(const Bounds<3>& box, const Way& way) {
  return {box.low + way.along.cwiseMin(0.0f) - Vector3f::Constant(way.turn),
          box.high + way.along.cwiseMax(0.0f) + Vector3f::Constant(way.turn)};
}

/// The box around everything that enters a box with that motion.
Bounds<3> BulletObstacles::behind(const Bounds<3>& box, const Way& way) {
  return ahead(box, {-way.along, way.turn});
}

const MovedByPlace* BulletObstacles::moved_by_place_of(const btCollisionObject& object) const {
  const auto place = static_cast<std::size_t>(object.getWorldArrayIndex());
  if (place >= followed_.size() || followed_[place].object != &object) return nullptr;
  const std::optional<MovedByPlace>& motion = followed_[place].motion;
  return motion ? &*motion : nullptr;
}

btTransform BulletObstacles::pose_of(const btCollisionObject& object) const {
  const MovedByPlace* const moved = moved_by_place_of(object);
  if (moved == nullptr) return object.getWorldTransform();
  const Matrix3f& m = moved->from.rotation;
  const btMatrix3x3 rotation(m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2));
  return btTransform(rotation, to_bullet(moved->from.position));
}

/// Objects change their places in the world's list when one is removed: they are then seen for the first time again.
void BulletObstacles::find_moved_by_place() {
  if (role_ != Objects::kSolid) return;
  const btCollisionObjectArray& objects = world_->getCollisionObjectArray();
  followed_.resize(static_cast<std::size_t>(objects.size()));
  for (int i = 0; i < objects.size(); ++i) {
    const btCollisionObject& object = *objects[i];
    Followed& followed = followed_[static_cast<std::size_t>(i)];
    if (!may_be_moved_by_place(object)) {
      followed.object = nullptr;
      continue;
    }
    followed.motion.reset();
    const Pose pose = as_pose(object.getWorldTransform());
    const int id = object.getBroadphaseHandle()->m_uniqueId;
    if (followed.object != &object || followed.id != id) {
      followed = {&object, id, FollowedPlace(pose)};
    } else if (followed.place.stands(pose)) {
      followed.place.stand();
    } else {
      followed.motion = followed.place.follow(pose, size_of(*object.getCollisionShape()), step_);
      if (followed.motion) find_leaving(object);
    }
  }
}

void BulletObstacles::begin(const btDiscreteDynamicsWorld& world, float step) {
  SC_ASSERT(step > 0, "a substep of {} s", step);
  world_ = &world;
  step_ = step;
  obstacles_.clear();
  rigids_.clear();
  before_.clear();
  objects_.clear();
  obstacle_of_.clear();
  rigid_of_.assign(static_cast<std::size_t>(world.getNumCollisionObjects()), kNone);
  edges_used_ = triangles_used_ = 0;
  leaving_.clear();
  const btCollisionObjectArray& objects = world.getCollisionObjectArray();
  // The program moves trigger volumes, most of them without a velocity.
  const bool wants_triggers = role_ == Objects::kTriggers;
  find_moved_by_place();
  for (int i = 0; i < objects.size(); ++i)
    if (is_under_way(*objects[i]) || (wants_triggers && !objects[i]->hasContactResponse()))
      find_leaving(*objects[i]);
}

void BulletObstacles::find_leaving(const btCollisionObject& object) {
  const btBroadphaseProxy* const proxy = object.getBroadphaseHandle();
  btVector3 low, high;
  object.getCollisionShape()->getAabb(pose_of(object), low, high);
  const Bounds<3> box = ahead({to_eigen(low), to_eigen(high)}, way_of(object));
  const bool is_known = (box.low.array() >= to_eigen(proxy->m_aabbMin).array()).all() &&
                        (box.high.array() <= to_eigen(proxy->m_aabbMax).array()).all();
  if (!is_known) leaving_.push_back({proxy, box});
}

void BulletObstacles::add_near(const Bounds<3>& box, int group, int mask,
                               std::vector<std::uint32_t>& indices) {
  SC_ASSERT(world_ != nullptr, "obstacles for groups {} are looked for before begin()", mask);
  found_.clear();
  Collector near(group, mask, found_);
  // Broad phases are not const even for reading.
  const_cast<btBroadphaseInterface*>(world_->getBroadphase())
      ->aabbTest(to_bullet(box.low), to_bullet(box.high), near);
  // The tree may also find objects whose boxes do not overlap.
  std::erase_if(found_, [&](const btBroadphaseProxy* proxy) {
    return !overlap({to_eigen(proxy->m_aabbMin), to_eigen(proxy->m_aabbMax)}, box);
  });
  for (const Leaving& leaving : leaving_)
    if (overlap(leaving.box, box)) near.process(leaving.proxy);
  // Sorts by the order in which objects were added, so that the result does not depend on trees.
  keep_each_once(found_, [](const auto* a, const auto* b) { return a->m_uniqueId < b->m_uniqueId; });
  for (const btBroadphaseProxy* const proxy : found_) {
    auto& object = *static_cast<btCollisionObject*>(proxy->m_clientObject);
    if (object.getInternalType() == btCollisionObject::CO_SOFT_BODY) continue;  // one of Bullet's own
    if (object.hasContactResponse() == (role_ == Objects::kSolid))
      add_object(object, behind(box, way_of(object)), indices);
  }
}

void BulletObstacles::add_object(btCollisionObject& object, const Bounds<3>& box,
                                 std::vector<std::uint32_t>& indices) {
  const std::uint32_t rigid = rigid_of(object);
  if (obstacle_of_[rigid] != kNone) return indices.push_back(obstacle_of_[rigid]);
  const btCollisionShape& shape = *object.getCollisionShape();
  // The triangles of a shape differ from box to box.
  if (!shape.isConcave() && !shape.isCompound())
    obstacle_of_[rigid] = static_cast<std::uint32_t>(obstacles_.size());
  add_shape(shape, pose_of(object), rigid, 0, box, indices);
}

std::uint32_t BulletObstacles::rigid_of(btCollisionObject& object) {
  SC_ASSERT(rigids_.size() == objects_.size() && obstacle_of_.size() == objects_.size(),
            "{} rigid bodies, {} with obstacles, of {} objects", rigids_.size(), obstacle_of_.size(),
            objects_.size());
  const int place = object.getWorldArrayIndex();
  SC_ASSERT(place >= 0 && static_cast<std::size_t>(place) < rigid_of_.size(), "object {} of a world of {}",
            place, rigid_of_.size());
  std::uint32_t& known = rigid_of_[static_cast<std::size_t>(place)];
  if (known != kNone) return known;
  known = static_cast<std::uint32_t>(objects_.size());
  ContactRigid rigid;
  rigid.number = static_cast<std::uint32_t>(object.getBroadphaseHandle()->m_uniqueId);
  rigid.centre = to_eigen(object.getWorldTransform().getOrigin());
  rigid.friction = object.getFriction();
  if (const MovedByPlace* const moved = moved_by_place_of(object)) {
    rigid.centre = moved->from.position;
    rigid.velocity = moved->velocity;
    rigid.spin = moved->spin;
  } else if (const btRigidBody* const body = btRigidBody::upcast(&object)) {
    rigid.velocity = velocity_in(step_, *body);
    rigid.spin = spin_in(step_, *body);
    if (!body->isStaticOrKinematicObject()) set_mobility(*body, rigid);
  }
  rigids_.push_back(rigid);
  before_.push_back(rigid);
  objects_.push_back(&object);
  obstacle_of_.push_back(kNone);
  return known;
}

std::vector<ObstacleEdge>& BulletObstacles::more_edges() { return next_list(edges_, edges_used_); }

std::vector<BulletObstacles::Triangle>& BulletObstacles::more_triangles() {
  return next_list(triangles_, triangles_used_);
}

void BulletObstacles::push(const Obstacle& obstacle, std::vector<std::uint32_t>& indices) {
  SC_ASSERT(obstacle.rigid < rigids_.size(), "an obstacle of rigid body {} of {}", obstacle.rigid,
            rigids_.size());
  indices.push_back(static_cast<std::uint32_t>(obstacles_.size()));
  obstacles_.push_back(obstacle);
}

void BulletObstacles::add_compound(const btCompoundShape& compound, const btTransform& pose,
                                   std::uint32_t rigid, std::uint32_t part, const Bounds<3>& box,
                                   std::vector<std::uint32_t>& indices) {
  const int children = compound.getNumChildShapes();
  for (int i = 0; i < children; ++i) {
    const btTransform place = pose * compound.getChildTransform(i);
    btVector3 low, high;
    compound.getChildShape(i)->getAabb(place, low, high);
    if (overlap({to_eigen(low), to_eigen(high)}, box))
      add_shape(*compound.getChildShape(i), place, rigid,
                part * static_cast<std::uint32_t>(children + 1) + static_cast<std::uint32_t>(i + 1), box,
                indices);
  }
}

void BulletObstacles::add_shape(const btCollisionShape& shape, const btTransform& pose, std::uint32_t rigid,
                                std::uint32_t part, const Bounds<3>& box,
                                std::vector<std::uint32_t>& indices) {
  Obstacle obstacle;
  obstacle.rigid = rigid;
  obstacle.restitution = objects_[rigid]->getRestitution();
  obstacle.part = part;
  obstacle.position = to_eigen(pose.getOrigin());
  obstacle.rotation = to_eigen(pose.getBasis());
  switch (shape.getShapeType()) {
    case COMPOUND_SHAPE_PROXYTYPE:
      return add_compound(static_cast<const btCompoundShape&>(shape), pose, rigid, part, box, indices);
    case STATIC_PLANE_PROXYTYPE:
      set_plane(static_cast<const btStaticPlaneShape&>(shape), obstacle);
      break;
    case SPHERE_SHAPE_PROXYTYPE:
      set_sphere(static_cast<const btSphereShape&>(shape), obstacle, more_edges());
      break;
    case BOX_SHAPE_PROXYTYPE:
      set_box(static_cast<const btBoxShape&>(shape), obstacle, more_edges());
      break;
    case CAPSULE_SHAPE_PROXYTYPE:
      set_capsule(static_cast<const btCapsuleShape&>(shape), obstacle, more_edges());
      break;
    case CYLINDER_SHAPE_PROXYTYPE:
      set_cylinder(static_cast<const btCylinderShape&>(shape), obstacle, more_edges());
      break;
    case CONE_SHAPE_PROXYTYPE:
      set_cone(static_cast<const btConeShape&>(shape), obstacle, more_edges());
      break;
    default:
      if (shape.isConcave()) return add_triangles(shape, obstacle, box, indices);
      if (!shape.isConvex())
        throw std::runtime_error(std::string("soft bodies cannot touch a shape of the kind ") +
                                 shape.getName() + "; it is neither convex nor made of triangles");
      if (is_sphere_or_capsule(shape)) {
        set_multi_sphere(static_cast<const btMultiSphereShape&>(shape), obstacle, more_edges());
        break;
      }
      ConvexHull& hull = hulls_[&shape];
      hull.follow(static_cast<const btConvexShape&>(shape));
      if (hull.planes().empty()) return;  // of no points, or of coinciding ones: it has no size
      obstacle.kind = ObstacleKind::kHull;
      obstacle.planes = hull.planes();
      obstacle.edges = hull.edges();
  }
  push(obstacle, indices);
}

void BulletObstacles::add_triangles(const btCollisionShape& shape, Obstacle obstacle, const Bounds<3>& box,
                                    std::vector<std::uint32_t>& indices) {
  std::vector<Triangle>& triangles = more_triangles();
  // The box, in the shape's frame.
  const Matrix3f turn = obstacle.rotation.transpose();
  const Vector3f centre = turn * (0.5f * (box.low + box.high) - obstacle.position);
  const Vector3f half = turn.cwiseAbs() * (0.5f * (box.high - box.low));
  find_triangles(static_cast<const btConcaveShape&>(shape), {centre - half, centre + half}, triangles);
  if (triangles.empty()) return;
  obstacle.kind = ObstacleKind::kTriangles;
  obstacle.triangles = triangles;
  push(obstacle, indices);
}

void BulletObstacles::apply(const std::vector<bool>& at_rest) {
  SC_ASSERT(at_rest.size() == rigids_.size(), "at_rest has {} entries for {} rigid bodies", at_rest.size(),
            rigids_.size());
  for (std::size_t i = 0; i < rigids_.size(); ++i) {
    if (rigids_[i].inverse_mass == 0 || (at_rest[i] && !objects_[i]->isActive())) continue;
    const Vector3f dv = rigids_[i].velocity - before_[i].velocity, dw = rigids_[i].spin - before_[i].spin;
    if (dv.isZero(0) && dw.isZero(0)) continue;
    SC_ASSERT(btRigidBody::upcast(objects_[i]) != nullptr, "object {} of {} has a mass and is no rigid body",
              i, objects_.size());
    btRigidBody& body = *btRigidBody::upcast(objects_[i]);
    body.setLinearVelocity(body.getLinearVelocity() + where_it_moves(to_bullet(dv), body.getLinearFactor()));
    body.setAngularVelocity(body.getAngularVelocity() +
                            where_it_moves(to_bullet(dw), body.getAngularFactor()));
    if (!at_rest[i]) body.activate();
  }
}

}  // namespace softcell::ppu
