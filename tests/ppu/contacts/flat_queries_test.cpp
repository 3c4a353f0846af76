// Rays, circles and distances against drawn edges, and what a program in two dimensions is told of contacts.
#include <gtest/gtest.h>

#include <box2d/b2_chain_shape.h>
#include <box2d/b2_circle_shape.h>
#include <box2d/b2_edge_shape.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "../soft_body_2d_scenes.h"
#include "ppu/lattice/outline_distance.h"
#include "softcell/soft_bodies/skin_2d.h"
#include "softcell/soft_bodies/surface_query.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Kind = ContactEvent2d::Kind;

/// 1 m high.
std::shared_ptr<const SoftBodyModel<2>> model(int cells_wide = 4) {
  return rectangle_model({cells_wide, 4},
                         {.cell_size = 0.25f, .half_width = 2, .density = 5, .alpha = 0.5f, .damping = 0.3f});
}

/// Where the edge of a square of 1 m around the origin is drawn: half a cell outside of it, rounded to a 64th of a cell.
constexpr float kEdge = 0.5f + 0.125f, kRounding = 0.02f * 0.25f;
SoftBody<2> square() { return SoftBody<2>(model(), Vector2f(0, -0.5f)); }
Skin2d drawn(const SoftBody<2>& body) { return make_skin_2d(body.model().lattice(), 0.5f); }

TEST(EdgeQuery, ARayMeetsTheNearestEdge) {
  const SoftBody<2> body = square();
  const SurfaceQuery query(body, drawn(body));
  const auto hit = query.cast_ray({-2, 0.1f}, {2, 0.1f});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->position.x(), -kEdge, kRounding);
  EXPECT_NEAR(hit->share, (2 - kEdge) / 4, kRounding);
  EXPECT_TRUE(hit->normal.isApprox(Vector2f(-1, 0), 1e-4f));
  const auto from_within = query.cast_ray({0, 0}, {0, 3});
  ASSERT_TRUE(from_within);
  EXPECT_NEAR(from_within->position.y(), kEdge, kRounding);
  EXPECT_TRUE(from_within->normal.isApprox(Vector2f(0, 1), 1e-4f)) << "out of the body, not towards the ray";
  EXPECT_FALSE(query.cast_ray({-2, 0.1f}, {-0.7f, 0.1f})) << "it ends before";
  EXPECT_FALSE(query.cast_ray({-2, 0.7f}, {2, 0.7f})) << "it passes by";
  EXPECT_FALSE(query.cast_ray({1, 1}, {1, 1})) << "a point outside";
}

TEST(EdgeQuery, FallsThroughNoCornerOfTwoEdges) {
  const SoftBody<2> body = square();
  const Skin2d skin = drawn(body);
  const SurfaceQuery query(body, skin);
  std::vector<Vector2f> positions(skin.rest.size()), slopes(skin.rest.size());
  deform(skin, body.positions(), positions, slopes);
  for (const auto& loop : skin.outlines)
    for (const std::uint32_t vertex : loop)
      EXPECT_TRUE(query.cast_ray(3 * positions[vertex], Vector2f::Zero())) << positions[vertex].transpose();
}

TEST(EdgeQuery, DistancesAreThoseToTheOutline) {
  SoftBody<2> body = square();
  for (std::size_t i = 0; i < body.positions().size(); ++i) {
    const Vector2f x = body.position(i);
    body.set_particle(i, {1.5f * x.x() + 0.2f * x.y(), 0.8f * x.y()}, {0, 0});
  }
  Skin2d skin = drawn(body);
  const SurfaceQuery query(body, skin);
  std::vector<Vector2f> positions(skin.rest.size()), slopes(skin.rest.size());
  deform(skin, body.positions(), positions, slopes);
  for (std::size_t i = 0; i < positions.size(); ++i) skin.rest[i] = positions[i];
  const OutlineDistance outline(skin);
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> coordinate(-1.5f, 1.5f);
  int inside = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector2f p(coordinate(engine), coordinate(engine));
    EXPECT_NEAR(query.distance(p), outline.signed_distance(p), 1e-4f) << p.transpose();
    if (query.distance(p) < 0) ++inside;
  }
  EXPECT_GT(inside, 100);
  EXPECT_LT(inside, 400);
}

TEST(EdgeQuery, AMovedCircleStopsWhereItTouches) {
  const SoftBody<2> body = square();
  const SurfaceQuery query(body, drawn(body));
  const auto hit = query.cast_sphere({0, 3}, {0, -3}, 0.25f);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->share, (3 - kEdge - 0.25f) / 6, kRounding);
  EXPECT_TRUE(hit->normal.isApprox(Vector2f::UnitY(), 1e-3f));
  EXPECT_FALSE(query.cast_sphere({0.9f, -3}, {0.9f, 3}, 0.2f));
  EXPECT_TRUE(query.cast_sphere({0.8f, -3}, {0.8f, 3}, 0.2f));
  const auto at_once = query.cast_sphere({0, 0.7f}, {5, 0.7f}, 0.2f);
  ASSERT_TRUE(at_once);
  EXPECT_EQ(at_once->share, 0);
}

TEST(EdgeQuery, WithoutASkinIsTheEdgeThatTouches) {
  SoftBody<2> body = square();
  EXPECT_NEAR(SurfaceQuery(body).distance({0, 2}), 2 - 0.5f - body.model().contact_radius(), kRounding);
  body.set_particle(3, Vector2f::Constant(std::numeric_limits<float>::quiet_NaN()), {0, 0});
  EXPECT_THROW(SurfaceQuery{body}, std::runtime_error);
}

TEST(EdgeQuery, RefusesTheSkinOfAnotherModelAndCirclesWithoutARadius) {
  const SoftBody<2> body = square();
  EXPECT_THROW(SurfaceQuery(body, make_skin_2d(model(9)->lattice(), 0.5f)), std::invalid_argument);
  const SurfaceQuery query(body, drawn(body));
  for (const float radius : {0.0f, -1.0f, std::nanf("")})
    EXPECT_THROW(static_cast<void>(query.cast_sphere({0, 3}, {0, -3}, radius)), std::invalid_argument)
        << radius;
  const auto inside = query.cast_sphere({0, 0}, {0, -3}, 0.1f);
  ASSERT_TRUE(inside);
  EXPECT_EQ(inside->share, 0);
}

/// What is told of bodies that touch with their edges.
class ToldIn2d : public testing::Test {
 protected:
  ToldIn2d() { w_.soft.watch_contacts(true); }
  SoftBody<2>& add(const Vector2f& position, int cells_wide = 4) {
    return w_.soft.add(model(cells_wide), position);
  }
  std::vector<ContactEvent2d> after(float seconds) {
    w_.run(seconds);
    return w_.soft.poll_contact_events();
  }
  /// A body that has fallen asleep on a floor.
  SoftBody<2>& add_sleeper() {
    w_.add_box({0, -1}, {10, 1});
    SoftBody<2>& body = add({0, 0.13f});
    w_.soft.let_sleep(SleepSettings{});
    for (int i = 0; i < 1200 && !body.asleep(); ++i) w_.run(1.0f / 120);
    w_.soft.poll_contact_events();
    return body;
  }
  b2Fixture* add_sensor(const b2Shape& shape) {
    b2FixtureDef definition;
    definition.shape = &shape;
    definition.isSensor = true;
    b2BodyDef body;
    return w_.box2d.CreateBody(&body)->CreateFixture(&definition);
  }

  World2d w_{9.81f, ContactMethod::kSurface};
};

TEST_F(ToldIn2d, ContactsBeginGoOnAndEnd) {
  b2Body* const floor = w_.add_box({0, -1}, {10, 1});
  SoftBody<2>& lower = add({0, 0.15f}, 8);
  SoftBody<2>& upper = add({0, 1.45f});
  std::vector<ContactEvent2d> events;
  while (events.empty()) events = after(1.0f / 120);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::kBegin);
  EXPECT_EQ(events[0].body, &lower);
  EXPECT_EQ(events[0].rigid, floor);
  EXPECT_EQ(events[0].other, nullptr);
  EXPECT_EQ(events[0].sensor, nullptr);
  EXPECT_NEAR(events[0].position.y(), 0, 0.05f);
  EXPECT_GT(events[0].normal.y(), 0.99f);
  after(6);
  events = after(1);
  ASSERT_EQ(events.size(), 2u);
  const ContactEvent2d &between = events[0], &below = events[1];
  EXPECT_EQ(between.kind, Kind::kPersist);
  EXPECT_EQ(between.body, &lower);
  EXPECT_EQ(between.other, &upper);
  EXPECT_LT(between.normal.y(), -0.95f) << "from the other one to the body";
  const float weight = 9.81f * upper.model().mass();
  EXPECT_NEAR(between.impulse, weight, 0.03f * weight) << "of a second";
  EXPECT_NEAR(below.impulse, weight + 9.81f * lower.model().mass(), 0.09f * weight);
  upper.add_velocity({0, 5});
  std::vector<ContactEvent2d> ended;
  for (int i = 0; i < 3; ++i)
    for (const ContactEvent2d& event : after(0.1f))
      if (event.kind == Kind::kEnd && event.other == &upper) ended.push_back(event);
  ASSERT_EQ(ended.size(), 1u);
  EXPECT_EQ(ended[0].impulse, 0);
  w_.soft.watch_contacts(false);
  EXPECT_TRUE(after(0.1f).empty());
}

/// Bounces had no events.
TEST_F(ToldIn2d, BouncesAreContacts) {
  b2Body* const floor = w_.add_box({0, -1}, {10, 1});
  for (b2Fixture* fixture = floor->GetFixtureList(); fixture != nullptr; fixture = fixture->GetNext())
    fixture->SetRestitution(0.8f);
  const SoftBody<2>& body = add({0, 1});
  const auto events = after(1);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].rigid, floor);
  const float fallen = 9.81f * body.model().mass();
  EXPECT_GT(events[0].impulse, 0.5f * fallen);
  EXPECT_NEAR(events[0].impulse, body.linear_momentum().y() + fallen, 0.02f * fallen);
}

TEST_F(ToldIn2d, SleepEndsNoContactAndRemovalDoes) {
  SoftBody<2>& body = add_sleeper();
  ASSERT_TRUE(body.asleep());
  EXPECT_TRUE(after(0.1f).empty());
  w_.soft.remove(body);
  const std::vector<ContactEvent2d> events = w_.soft.poll_contact_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::kEnd);
  EXPECT_TRUE(w_.soft.poll_contact_events().empty());
}

/// Sensors of all kinds below each other, through which a body falls.
TEST_F(ToldIn2d, SensorsHoldNothingUpAndSayWhatIsInThem) {
  b2CircleShape circle;
  circle.m_p = {0, -1};
  circle.m_radius = 0.2f;
  b2PolygonShape box;
  box.SetAsBox(0.1f, 0.1f, {0.1f, -4}, 0.3f);
  b2EdgeShape edge;
  edge.SetTwoSided({-3, -7}, {3, -7});
  b2ChainShape chain;
  const b2Vec2 corners[] = {{-3, -10}, {0, -10.1f}, {3, -10}};
  chain.CreateChain(corners, 3, {-4, -10}, {4, -10});
  const std::vector<b2Fixture*> sensors{add_sensor(circle), add_sensor(box), add_sensor(edge),
                                        add_sensor(chain)};
  SoftBody<2>& body = add({0, 0});
  std::vector<std::pair<const b2Fixture*, Kind>> told;
  for (int i = 0; i < 200; ++i)
    for (const ContactEvent2d& event : after(1.0f / 120)) {
      EXPECT_EQ(event.body, &body);
      EXPECT_EQ(event.rigid, event.sensor->GetBody());
      EXPECT_EQ(event.impulse, 0);
      EXPECT_NEAR(event.normal.norm(), 1, 1e-4f);
      if (event.kind != Kind::kPersist) told.emplace_back(event.sensor, event.kind);
    }
  std::vector<std::pair<const b2Fixture*, Kind>> expected;
  for (const b2Fixture* const sensor : sensors)
    expected.insert(expected.end(), {{sensor, Kind::kBegin}, {sensor, Kind::kEnd}});
  EXPECT_EQ(told, expected);
  EXPECT_NEAR(body.linear_momentum().y() / body.model().mass(), -9.81f * 200 / 120, 0.2f)
      << "it falls freely";
}

TEST_F(ToldIn2d, SensorsObeyFiltersAndMeetBodiesThatSleep) {
  SoftBody<2>& body = add_sleeper();
  ASSERT_TRUE(body.asleep());
  b2CircleShape circle;
  circle.m_p = {0, 0.6f};
  circle.m_radius = 0.2f;
  b2Fixture* const deaf = add_sensor(circle);
  b2Filter filter;
  filter.maskBits = 32;
  deaf->SetFilterData(filter);
  b2Fixture* const all = add_sensor(circle);
  const std::vector<ContactEvent2d> events = after(0.05f);
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].sensor, all);
  EXPECT_EQ(events[0].kind, Kind::kBegin);
  EXPECT_TRUE(body.asleep());
}

TEST(SoftBodiesInBox2d, ARayMeetsTheNearestBodyThatItsFilterLets) {
  for (const ContactMethod method : {ContactMethod::kSurface, ContactMethod::kSpheres}) {
    World2d w(0, method);
    const SoftBody<2>& near = w.soft.add(model(), {0, -0.5f});
    const SoftBody<2>& far = w.soft.add(model(), {3, -0.5f});
    const auto hit = w.soft.cast_ray({-5, 0}, {5, 0});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->body, &near);
    EXPECT_NEAR(hit->hit.position.x(), -0.5f - near.model().contact_radius(), kRounding);
    w.soft.set_filter(near, {.group = 4, .mask = -1});
    EXPECT_EQ(w.soft.cast_ray({-5, 0}, {5, 0}, {.group = 1, .mask = ~4})->body, &far);
    EXPECT_FALSE(w.soft.cast_ray({-5, 2}, {5, 2}));
  }
}

}  // namespace
}  // namespace softcell::ppu
