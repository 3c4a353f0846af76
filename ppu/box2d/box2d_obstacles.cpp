#include "ppu/box2d/box2d_obstacles.h"

#include <box2d/b2_chain_shape.h>
#include <box2d/b2_circle_shape.h>
#include <box2d/b2_edge_shape.h>
#include <box2d/b2_polygon_shape.h>
#include <box2d/b2_world_callbacks.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "ppu/box2d/box2d_body.h"
#include "ppu/numbers/hash_of_numbers.h"
#include "ppu/numbers/keep_each_once.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

Vector3f lifted(const b2Vec2& v, float z = 0) { return {v.x, v.y, z}; }

bool may_touch(const b2Fixture& fixture, const CollisionFilter& filter) {
  const b2Filter& own = fixture.GetFilterData();
  return fixture.GetBody()->IsEnabled() &&
         filter.may_touch({static_cast<int>(own.categoryBits), static_cast<int>(own.maskBits)});
}

/// The ends of an edge fixture, or of one edge of a chain, in its body's frame.
struct Ends {
  b2Vec2 from, to;
};
Ends ends_of(const b2Fixture& fixture, int child) {
  if (fixture.GetType() == b2Shape::e_edge) {
    const auto& edge = static_cast<const b2EdgeShape&>(*fixture.GetShape());
    return {edge.m_vertex1, edge.m_vertex2};
  }
  SC_ASSERT(fixture.GetType() == b2Shape::e_chain, "a fixture of type {}",
            static_cast<int>(fixture.GetType()));
  b2EdgeShape edge;
  static_cast<const b2ChainShape&>(*fixture.GetShape()).GetChildEdge(&edge, child);
  return {edge.m_vertex1, edge.m_vertex2};
}

/// A face of a polygon, in its body's frame; counterclockwise, so the inside lies to the left.
Ends face_of(const b2PolygonShape& polygon, int face) {
  return {polygon.m_vertices[face], polygon.m_vertices[(face + 1) % polygon.m_count]};
}

/// How far a polygon reaches behind one of its faces, metres.
float depth_behind(const b2PolygonShape& polygon, int face) {
  float least = 0;
  for (int i = 0; i < polygon.m_count; ++i)
    least = std::min(least, b2Dot(polygon.m_normals[face], polygon.m_vertices[i] - polygon.m_vertices[face]));
  return -least;
}

/// The hash of how a shape looks.
class LookHash {
 public:
  void add(std::uint32_t number) { hash_.add(number); }
  void add(float number) { add(std::bit_cast<std::uint32_t>(number)); }
  void add(std::span<const b2Vec2> points) {
    for (const b2Vec2& point : points) add(point.x), add(point.y);
  }
  std::uint64_t value() const { return hash_.value(); }

 private:
  NumberHash hash_;
};

void add_shape(const b2Shape& shape, LookHash& hash) {
  hash.add(shape.m_radius);
  switch (shape.GetType()) {
    case b2Shape::e_circle:
      return hash.add({&static_cast<const b2CircleShape&>(shape).m_p, 1});
    case b2Shape::e_polygon: {
      const auto& polygon = static_cast<const b2PolygonShape&>(shape);
      return hash.add({polygon.m_vertices, static_cast<std::size_t>(polygon.m_count)});
    }
    case b2Shape::e_edge: {
      const auto& edge = static_cast<const b2EdgeShape&>(shape);
      hash.add({&edge.m_vertex1, 1});
      return hash.add({&edge.m_vertex2, 1});
    }
    case b2Shape::e_chain: {
      const auto& chain = static_cast<const b2ChainShape&>(shape);
      return hash.add({chain.m_vertices, static_cast<std::size_t>(chain.m_count)});
    }
    default:
      return;
  }
}

/// Computes the hash that Box2dObstacles::look() returns.
std::uint64_t look_of(const b2Body& body) {
  LookHash hash;
  hash.add(std::uint32_t{body.IsEnabled()});
  for (const b2Fixture* fixture = body.GetFixtureList(); fixture != nullptr; fixture = fixture->GetNext()) {
    hash.add(std::uint32_t{fixture->IsSensor()});
    hash.add(std::uint32_t{fixture->GetFilterData().categoryBits} << 16 | fixture->GetFilterData().maskBits);
    hash.add(static_cast<std::uint32_t>(fixture->GetType()));
    add_shape(*fixture->GetShape(), hash);
  }
  return hash.value();
}

/// A disabled body stands still, whatever its velocity, and its fixtures have no boxes.
bool is_under_way(const b2Body& body) {
  return body.IsEnabled() && body.IsAwake() &&
         (body.GetLinearVelocity().LengthSquared() > 0 || body.GetAngularVelocity() != 0);
}

/// Whether nothing moves a body but the program by its place.
bool may_be_moved_by_place(const b2Body& body) {
  return body.IsEnabled() && body.GetType() != b2_dynamicBody &&
         body.GetLinearVelocity().LengthSquared() == 0 && body.GetAngularVelocity() == 0;
}

Pose as_pose(const b2Transform& pose) {
  Pose made;
  made.position = lifted(pose.p);
  made.rotation.topLeftCorner<2, 2>() << pose.q.c, -pose.q.s, pose.q.s, pose.q.c;
  return made;
}

/// Metres, along the longer axis of the box around all its fixtures.
float size_of(const b2Body& body) {
  b2AABB all{b2Vec2(b2_maxFloat, b2_maxFloat), b2Vec2(-b2_maxFloat, -b2_maxFloat)};
  bool is_empty = true;
  for (const b2Fixture* fixture = body.GetFixtureList(); fixture != nullptr; fixture = fixture->GetNext())
    for (int child = 0; child < fixture->GetShape()->GetChildCount(); ++child, is_empty = false)
      all.Combine(fixture->GetAABB(child));
  return is_empty ? 0 : std::max(all.GetExtents().x, all.GetExtents().y) * 2;
}

}  // namespace

class Box2dObstacles::Collector final : public b2QueryCallback {
 public:
  Collector(const CollisionFilter& filter, const b2AABB& box, const Box2dObstacles& of,
            std::vector<Found>& found)
      : filter_(filter), box_(box), of_(of), found_(found) {}
  /// Adds each child whose box is near. Fixtures that move are looked up apart.
  bool ReportFixture(b2Fixture* fixture) override {
    const KnownBody& body = of_.known_bodies_.at(fixture->GetBody());
    if (body.moves || !of_.wants(*fixture) || !may_touch(*fixture, filter_)) return true;
    for (int child = 0; child < fixture->GetShape()->GetChildCount(); ++child)
      if (b2TestOverlap(fixture->GetAABB(child), box_))
        found_.push_back({body.number, Box2dObstacles::number(*fixture), child, fixture});
    return true;
  }

 private:
  const CollisionFilter& filter_;
  const b2AABB& box_;
  const Box2dObstacles& of_;
  std::vector<Found>& found_;
};

void Box2dObstacles::begin(b2World& world, float step, float layer) {
  SC_ASSERT(step > 0 && layer > 0, "a substep of {} s, of bodies {} m above and below the plane", step,
            layer);
  world_ = &world;
  ++steps_;
  step_ = step;
  layer_ = layer;
  obstacles_.clear();
  fixtures_.clear();
  rigids_.clear();
  before_.clear();
  bodies_.clear();
  known_.clear();
  shapes_used_ = 0;
  number_bodies();
  if (wanted_ == Fixtures::kSolid) find_moved_by_place();
  moving_.clear();
  for (b2Body* body = world.GetBodyList(); body != nullptr; body = body->GetNext()) {
    KnownBody& known = known_bodies_.at(body);
    known.moves = known.motion || is_under_way(*body);
    if (known.moves) add_moving(*body, known);
  }
}

/// The boxes of all that moves are made once, not once for each soft body.
void Box2dObstacles::add_moving(b2Body& body, const KnownBody& known) {
  std::uint32_t behind = 0;
  for (const b2Fixture* next = body.GetFixtureList(); next != nullptr; next = next->GetNext()) ++behind;
  for (b2Fixture* fixture = body.GetFixtureList(); fixture != nullptr; fixture = fixture->GetNext()) {
    --behind;
    if (!wants(*fixture)) continue;
    for (int child = 0; child < fixture->GetShape()->GetChildCount(); ++child)
      moving_.push_back({box_of_step(known, *fixture, child), Found{known.number, behind, child, fixture}});
  }
}

/// Moved bodies lie where the program has put them in Box2D's tree, too.
void Box2dObstacles::find_moved_by_place() {
  for (b2Body* body = world_->GetBodyList(); body != nullptr; body = body->GetNext()) {
    KnownBody& known = known_bodies_.at(body);
    if (!may_be_moved_by_place(*body)) {
      known.place.reset();
      known.motion.reset();
      continue;
    }
    known.motion.reset();
    const Pose pose = as_pose(body->GetTransform());
    if (!known.place) {
      known.place.emplace(pose);
    } else if (known.place->stands(pose)) {
      known.place->stand();
    } else {
      known.motion = known.place->follow(pose, size_of(*body), step_);
    }
  }
}

void Box2dObstacles::forget_places() {
  for (auto& [body, known] : known_bodies_) known.place.reset(), known.motion.reset();
}

/// Box2D moves bodies and its tree, but not the boxes of fixtures (b2Fixture::GetAABB()) until a body moves.
void Box2dObstacles::shift(b2World& world, const Vector2f& by) {
  for (auto& [body, known] : known_bodies_)
    if (known.place) known.place->shift({by.x(), by.y(), 0});
  for (b2Body* body = world.GetBodyList(); body != nullptr; body = body->GetNext())
    body->SetTransform(body->GetPosition(), body->GetAngle());
}

const MovedByPlace* Box2dObstacles::moved_by_place_of(const b2Body& body) const {
  const std::optional<MovedByPlace>& motion = known_bodies_.at(&body).motion;
  return motion ? &*motion : nullptr;
}

b2Transform Box2dObstacles::pose_of(const b2Body& body) const {
  const MovedByPlace* const moved = moved_by_place_of(body);
  if (moved == nullptr) return body.GetTransform();
  b2Transform pose;
  pose.p = {moved->from.position.x(), moved->from.position.y()};
  pose.q.c = moved->from.rotation(0, 0);
  pose.q.s = moved->from.rotation(1, 0);
  return pose;
}

/// What Box2D will add to a body's velocities later in its step, where it touches nothing.
VelocityGain Box2dObstacles::gain_of(const b2Body& body) const {
  return body.IsAwake() ? velocity_gain(body, world_->GetGravity(), step_) : VelocityGain{};
}

/// Box2D has a box around the fixture's last place; for a body that moves, this also covers its motion.
b2AABB Box2dObstacles::box_of_step(const KnownBody& known, const b2Fixture& fixture, int child) const {
  b2AABB box = fixture.GetAABB(child);
  const b2Body& body = *fixture.GetBody();
  const std::optional<MovedByPlace>& moved = known.motion;
  const VelocityGain gain = gain_of(body);
  // It has come from there already.
  const b2Vec2 way = moved ? -step_ * b2Vec2(moved->velocity.x(), moved->velocity.y())
                           : step_ * (body.GetLinearVelocity() + gain.linear);
  const float spin = moved ? moved->spin.z() : body.GetAngularVelocity() + gain.angular;
  const b2Vec2 centre = body.GetWorldCenter();
  const b2Vec2 arm = b2Max(b2Abs(box.lowerBound - centre), b2Abs(box.upperBound - centre));
  const float turn = step_ * std::abs(spin) * arm.Length();
  box.lowerBound += b2Min(way, b2Vec2_zero) - b2Vec2(turn, turn);
  box.upperBound += b2Max(way, b2Vec2_zero) + b2Vec2(turn, turn);
  return box;
}

std::uint32_t Box2dObstacles::number(const b2Fixture& fixture) {
  std::uint32_t behind = 0;
  for (const b2Fixture* next = fixture.GetNext(); next != nullptr; next = next->GetNext()) ++behind;
  return behind;
}

/// Bodies keep their numbers as long as they exist. The world lists the newest first.
void Box2dObstacles::number_bodies() {
  unknown_.clear();
  std::size_t count = 0;
  for (b2Body* body = world_->GetBodyList(); body != nullptr; body = body->GetNext(), ++count)
    if (!known_bodies_.contains(body)) unknown_.push_back(body);
  if (known_bodies_.size() + unknown_.size() != count) {
    std::unordered_map<const b2Body*, KnownBody> there;
    for (const b2Body* body = world_->GetBodyList(); body != nullptr; body = body->GetNext())
      if (const auto known = known_bodies_.find(body); known != known_bodies_.end()) there.insert(*known);
    known_bodies_ = std::move(there);
  }
  for (auto body = unknown_.rbegin(); body != unknown_.rend(); ++body)
    known_bodies_.emplace(*body, KnownBody{next_number_++});
}

bool Box2dObstacles::has(const b2Body* body) const {
  SC_ASSERT(world_ != nullptr, "one of {} bodies is looked for before begin()", known_bodies_.size());
  return known_bodies_.contains(body);
}

/// Computes the hash at most once in a step, as a chain may be long.
std::uint64_t Box2dObstacles::look(const b2Body& body) {
  SC_ASSERT(world_ != nullptr, "one of {} bodies is looked at before begin()", known_bodies_.size());
  KnownBody& known = known_bodies_.at(&body);
  if (known.looked != steps_) {
    known.looked = steps_;
    known.look = look_of(body);
  }
  return known.look;
}

void Box2dObstacles::add_near(const Bounds<3>& box, const Vector2f& middle, const CollisionFilter& filter,
                              std::vector<std::uint32_t>& indices) {
  SC_ASSERT(world_ != nullptr, "obstacles for groups {} are looked for before begin()", filter.mask);
  b2AABB query;
  query.lowerBound = {box.low.x(), box.low.y()};
  query.upperBound = {box.high.x(), box.high.y()};
  found_.clear();
  Collector near(filter, query, *this, found_);
  world_->QueryAABB(&near, query);
  for (const Moving& moving : moving_)
    if (b2TestOverlap(moving.box, query) && may_touch(*moving.found.there, filter))
      found_.push_back(moving.found);
  keep_each_once(found_);
  for (auto first = found_.begin(); first != found_.end();) {
    const bool is_chain = first->there->GetType() == b2Shape::e_chain;
    const auto end = is_chain ? std::find_if(first, found_.end(),
                                             [&](const Found& next) { return next.there != first->there; })
                              : first + 1;
    indices.push_back(is_chain ? obstacle_of_chain({first, end})
                               : obstacle_of(*first, face_before(*first, box, middle)));
    first = end;
  }
}

/// For a thin polygon: the face that the body as a whole is in front of.
int Box2dObstacles::face_before(const Found& found, const Bounds<3>& box, const Vector2f& middle) const {
  const b2Fixture& fixture = *found.there;
  if (fixture.GetType() != b2Shape::e_polygon || wanted_ == Fixtures::kSensors) return kWhole;
  const b2Transform pose = pose_of(*fixture.GetBody());
  const b2Vec2 at = b2MulT(pose, b2Vec2(middle.x(), middle.y()));
  const auto& polygon = static_cast<const b2PolygonShape&>(*fixture.GetShape());
  for (int face = 0; face < polygon.m_count; ++face) {
    const Ends ends = face_of(polygon, face);
    if (!(b2Dot(polygon.m_normals[face], at - ends.from) > 0)) continue;
    if (!(depth_behind(polygon, face) < kThin * 2 * layer_)) continue;
    const b2Vec2 along = ends.to - ends.from;
    const auto is_beside = [&](float x, float y) {
      const float place = b2Dot(along, b2MulT(pose, b2Vec2(x, y)) - ends.from);
      return place >= 0 && place <= along.LengthSquared();
    };
    if (is_beside(box.low.x(), box.low.y()) && is_beside(box.high.x(), box.low.y()) &&
        is_beside(box.low.x(), box.high.y()) && is_beside(box.high.x(), box.high.y()))
      return face;
  }
  return kWhole;
}

std::uint32_t Box2dObstacles::rigid_of(b2Body& body) {
  KnownBody& known = known_bodies_.at(&body);
  if (known.rigid_of_step == steps_) return known.rigid;
  known.rigid_of_step = steps_;
  known.rigid = static_cast<std::uint32_t>(bodies_.size());
  ContactRigid rigid;
  rigid.number = known.number;
  rigid.centre = lifted(body.GetWorldCenter());
  if (body.IsEnabled()) {
    const VelocityGain gain = gain_of(body);
    rigid.velocity = lifted(body.GetLinearVelocity() + gain.linear);
    rigid.spin = {0, 0, body.GetAngularVelocity() + gain.angular};
  }
  if (const std::optional<MovedByPlace>& moved = known.motion) {
    rigid.centre = moved->from.position;
    rigid.velocity = moved->velocity;
    rigid.spin = moved->spin;
  }
  rigid.friction = 1;  // each fixture has its own
  if (is_simulated(body)) {
    rigid.inverse_mass = inverse_mass_of(body);
    rigid.inverse_inertia(2, 2) = inverse_inertia_of(body);
  }
  rigids_.push_back(rigid);
  before_.push_back(rigid);
  bodies_.push_back(&body);
  return known.rigid;
}

Box2dObstacles::Shape& Box2dObstacles::next_shape() {
  if (shapes_used_ == shapes_.size()) shapes_.emplace_back();
  Shape& shape = shapes_[shapes_used_++];
  shape.planes.clear();
  shape.edges.clear();
  shape.triangles.clear();
  return shape;
}

std::uint32_t Box2dObstacles::obstacle_of(const Found& found, int face) {
  b2Fixture& fixture = *found.there;
  const auto known = std::ranges::find_if(known_, [&](const Known& one) {
    return one.fixture == &fixture && one.child == found.child && one.face == face;
  });
  if (known != known_.end()) return known->obstacle;
  Obstacle obstacle = placed_with(fixture);
  Shape& shape = next_shape();
  switch (fixture.GetType()) {
    case b2Shape::e_circle:
      add_circle(fixture, obstacle, shape);
      break;
    case b2Shape::e_polygon:
      if (face == kWhole)
        add_polygon(fixture, obstacle, shape);
      else
        add_face(fixture, face, obstacle, shape);
      break;
    default:
      add_walls({&found, 1}, obstacle, shape);
      break;
  }
  known_.push_back({&fixture, found.child, face, add(obstacle, shape, fixture)});
  return known_.back().obstacle;
}

/// Makes one obstacle of several edges, because the space between two of them may be thinner than what presses into it. For another body
/// other edges may be near.
std::uint32_t Box2dObstacles::obstacle_of_chain(std::span<const Found> edges) {
  b2Fixture& fixture = *edges.front().there;
  Obstacle obstacle = placed_with(fixture);
  Shape& shape = next_shape();
  add_walls(edges, obstacle, shape);
  return add(obstacle, shape, fixture);
}

/// Sets everything but the shape.
Obstacle Box2dObstacles::placed_with(b2Fixture& fixture) {
  const b2Transform pose = pose_of(*fixture.GetBody());
  Obstacle obstacle;
  obstacle.rigid = rigid_of(*fixture.GetBody());
  obstacle.friction = std::sqrt(fixture.GetFriction());
  obstacle.restitution = fixture.GetRestitution();
  obstacle.position = lifted(pose.p);
  obstacle.rotation << pose.q.c, -pose.q.s, 0, pose.q.s, pose.q.c, 0, 0, 0, 1;
  return obstacle;
}

/// @return  the obstacle's index
std::uint32_t Box2dObstacles::add(Obstacle obstacle, const Shape& shape, b2Fixture& fixture) {
  obstacle.planes = shape.planes;
  obstacle.edges = shape.edges;
  obstacle.triangles = shape.triangles;
  obstacles_.push_back(obstacle);
  fixtures_.push_back(&fixture);
  return static_cast<std::uint32_t>(obstacles_.size() - 1);
}

/// A ball: contacts lie at z = 0, so it acts as a circle.
void Box2dObstacles::add_circle(const b2Fixture& fixture, Obstacle& obstacle, Shape& shape) {
  const auto& circle = static_cast<const b2CircleShape&>(*fixture.GetShape());
  obstacle.kind = ObstacleKind::kBox;
  obstacle.position = obstacle.to_world(lifted(circle.m_p));
  obstacle.rounding = circle.m_radius;
  shape.edges.push_back({Vector3f::Zero(), Vector3f::Zero()});
}

/// Has no top and no bottom. Its corners may be sharper than the surface that they meet.
void Box2dObstacles::add_polygon(const b2Fixture& fixture, Obstacle& obstacle, Shape& shape) {
  const auto& polygon = static_cast<const b2PolygonShape&>(*fixture.GetShape());
  obstacle.kind = ObstacleKind::kHull;
  for (int i = 0; i < polygon.m_count; ++i) {
    const b2Vec2 &normal = polygon.m_normals[i], &corner = polygon.m_vertices[i];
    shape.planes.emplace_back(normal.x, normal.y, 0, b2Dot(normal, corner));
    shape.edges.push_back({lifted(corner), lifted(corner)});
  }
}

/// The outside is to the right when its corners are followed in order.
void Box2dObstacles::add_face(const b2Fixture& fixture, int face, Obstacle& obstacle, Shape& shape) const {
  const Ends ends = face_of(static_cast<const b2PolygonShape&>(*fixture.GetShape()), face);
  add_wall(ends.from, ends.to, obstacle, shape);
  obstacle.faces_bodies = true;
  obstacle.part = number(fixture);
}

/// @param edges  of one fixture
void Box2dObstacles::add_walls(std::span<const Found> edges, Obstacle& obstacle, Shape& shape) const {
  obstacle.part = edges.front().fixture;
  for (const Found& edge : edges) {
    const Ends ends = ends_of(*edge.there, edge.child);
    add_wall(ends.from, ends.to, obstacle, shape);
  }
}

/// The wall reaches twice as high as the layer. Its front is to the right when going from `from` to `to`.
void Box2dObstacles::add_wall(const b2Vec2& from, const b2Vec2& to, Obstacle& obstacle, Shape& shape) const {
  obstacle.kind = ObstacleKind::kTriangles;
  const float high = 2 * layer_;
  shape.triangles.push_back({lifted(from, -high), lifted(to, -high), lifted(to, high)});
  shape.triangles.push_back({lifted(from, -high), lifted(to, high), lifted(from, high)});
  for (const b2Vec2& end : {from, to, from, from, to, to}) shape.edges.push_back({lifted(end), lifted(end)});
}

void Box2dObstacles::apply() {
  for (std::size_t i = 0; i < rigids_.size(); ++i) {
    if (rigids_[i].inverse_mass == 0) continue;
    const Vector3f dv = rigids_[i].velocity - before_[i].velocity;
    const float dw = rigids_[i].spin.z() - before_[i].spin.z();
    if (dv.isZero(0) && dw == 0) continue;
    b2Body& body = *bodies_[i];
    body.SetLinearVelocity(body.GetLinearVelocity() + b2Vec2(dv.x(), dv.y()));
    body.SetAngularVelocity(body.GetAngularVelocity() + dw);
  }
}

}  // namespace softcell::ppu
