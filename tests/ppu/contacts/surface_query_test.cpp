// Rays, spheres and distances against deformed surfaces, and what bodies of a world are told of their contacts.

#include "softcell/soft_bodies/surface_query.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <vector>

#include "contact_world.h"
#include "ppu/mesh/solid.h"
#include "ppu/surfaces/triangle_distance.h"
#include "softcell/spe_bodies/spe_runtime.h"
#include "support/first_touch.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;

/// A cube of 1 m whose middle is at the origin.
SoftBody<3> unit_cube() {
  return SoftBody<3>(make_soft_body_model(make_box({1, 1, 1}, 0.25f), settings_of(0.25f)), Vector3f(0, 0, 0));
}

TEST(SurfaceQuery, ARayMeetsTheNearestFace) {
  const SurfaceQuery cube(unit_cube());
  const auto hit = cube.cast_ray({-2, 0.1f, 0.2f}, {2, 0.1f, 0.2f});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->share, 1.5f / 4, 1e-5f);
  EXPECT_TRUE(hit->position.isApprox(Vector3f(-0.5f, 0.1f, 0.2f), 1e-4f));
  EXPECT_TRUE(hit->normal.isApprox(Vector3f(-1, 0, 0), 1e-4f));
  // From within it meets the other side, whose normal still points outwards.
  const auto from_within = cube.cast_ray({0, 0, 0}, {0, 3, 0});
  ASSERT_TRUE(from_within);
  EXPECT_NEAR(from_within->share, 0.5f / 3, 1e-5f);
  EXPECT_TRUE(from_within->normal.isApprox(Vector3f::UnitY(), 1e-4f));
  EXPECT_FALSE(cube.cast_ray({-2, 0.1f, 0.2f}, {-0.6f, 0.1f, 0.2f})) << "it ends before";
  EXPECT_FALSE(cube.cast_ray({-2, 0.6f, 0}, {2, 0.6f, 0})) << "it passes by";
  EXPECT_FALSE(cube.cast_ray({1, 1, 1}, {1, 1, 1})) << "a point outside";
}

TEST(SurfaceQuery, ARayAtAnEdgeOfTwoTrianglesFallsThroughNowhere) {
  const SurfaceQuery cube(unit_cube());
  for (int i = -8; i <= 8; ++i)
    for (int j = -8; j <= 8; ++j)
      EXPECT_TRUE(cube.cast_ray({0.0625f * static_cast<float>(i), 0.0625f * static_cast<float>(j), 2},
                                {0.0625f * static_cast<float>(i), 0.0625f * static_cast<float>(j), 0}))
          << i << " " << j;
}

TEST(SurfaceQuery, DistancesAreThoseOfABox) {
  const SurfaceQuery cube(unit_cube());
  std::mt19937 engine(3);
  std::uniform_real_distribution<float> coordinate(-1, 1);
  for (int i = 0; i < 500; ++i) {
    const Vector3f p(coordinate(engine), coordinate(engine), coordinate(engine));
    const Vector3f beyond = p.cwiseAbs() - Vector3f::Constant(0.5f);
    const float expected = beyond.maxCoeff() <= 0 ? beyond.maxCoeff() : beyond.cwiseMax(0.0f).norm();
    EXPECT_NEAR(cube.distance(p), expected, 1e-4f) << p.transpose();
  }
}

TEST(SurfaceQuery, AMovedSphereStopsWhereItTouches) {
  const SurfaceQuery cube(unit_cube());
  const auto hit = cube.cast_sphere({0, 3, 0}, {0, -3, 0}, 0.25f);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->share, (3 - 0.75f) / 6, 1e-3f);
  EXPECT_TRUE(hit->normal.isApprox(Vector3f::UnitY(), 1e-3f));
  // Past a corner: nearer than its radius, or not.
  EXPECT_TRUE(cube.cast_sphere({0.6f, 0.6f, -3}, {0.6f, 0.6f, 3}, 0.2f));
  EXPECT_FALSE(cube.cast_sphere({0.6f, 0.6f, -3}, {0.6f, 0.6f, 3}, 0.12f));
  const auto at_once = cube.cast_sphere({0, 0.6f, 0}, {5, 0.6f, 0}, 0.2f);
  ASSERT_TRUE(at_once);
  EXPECT_EQ(at_once->share, 0);
}

TEST(SurfaceQuery, SeesTheBodyAsItIsDeformed) {
  SoftBody<3> body = unit_cube();
  for (std::size_t i = 0; i < body.positions().size(); ++i) {
    const Vector3f x = body.position(i);
    body.set_particle(i, {2 * x.x(), 0.5f * x.y(), x.z() + 0.3f * x.x()}, {0, 0, 0});
  }
  const SurfaceQuery surface(body);
  EXPECT_NEAR(surface.bounds().high.x(), 1, 1e-4f);
  const auto hit = surface.cast_ray({0, 2, 0}, {0, -2, 0});
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->position.y(), 0.25f, 1e-4f);
  EXPECT_NEAR(surface.distance({0.5f, 0.45f, 0.1f}), 0.2f, 1e-4f);
}

TEST(SurfaceQuery, IsTheSameAsLookingAtEachTriangle) {
  const SoftBody<3> body(make_soft_body_model(make_penguin(0.9f), settings_of(0.1f)),
                         Vector3f(0.1f, 0.2f, 0.3f));
  const SurfaceQuery surface(body);
  std::vector<Vector3f> positions(body.model().mesh().positions.size()), normals(positions.size());
  skin(body, positions, normals);
  std::mt19937 engine(5);
  std::uniform_real_distribution<float> coordinate(-1, 1);
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    const Vector3f from =
        body.centre_of_mass() + 2 * Vector3f(coordinate(engine), coordinate(engine), coordinate(engine));
    const Vector3f to =
        body.centre_of_mass() + 0.5f * Vector3f(coordinate(engine), coordinate(engine), coordinate(engine));
    float nearest = std::numeric_limits<float>::max(), best = 2;
    for (const auto& t : body.model().mesh().triangles) {
      const std::array<Vector3f, 3> triangle{positions[t[0]], positions[t[1]], positions[t[2]]};
      nearest = std::min(nearest, (nearest_point(triangle, from) - from).norm());
      // By its plane, and then whether the point lies in it.
      const Vector3f normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
      const float share = normal.dot(triangle[0] - from) / normal.dot(to - from);
      const Vector3f at = from + share * (to - from);
      if (share >= 0 && share <= 1 && (nearest_point(triangle, at) - at).norm() < 1e-5f)
        best = std::min(best, share);
    }
    EXPECT_NEAR(std::abs(surface.distance(from)), nearest, 1e-5f);
    const auto hit = surface.cast_ray(from, to);
    EXPECT_EQ(hit.has_value(), best <= 1) << i;
    if (!hit) continue;
    EXPECT_NEAR(hit->share, best, 1e-4f);
    ++hits;
  }
  EXPECT_GT(hits, 50);
}

/// The mesh of a body as it is drawn.
TriangleMesh drawn_mesh(const SoftBody<3>& body) {
  TriangleMesh mesh = body.model().mesh();
  mesh.positions = ContactWorld::drawn(body);
  return mesh;
}

/// A cube whose upper half has been pressed through its lower half.
SoftBody<3> folded_cube() {
  SoftBody<3> body = unit_cube();
  for (std::size_t i = 0; i < body.positions().size(); ++i) {
    const Vector3f x = body.position(i);
    body.set_particle(i, {x.x(), x.y() > 0.01f ? -0.8f * x.y() : x.y(), x.z()}, {0, 0, 0});
  }
  return body;
}

/// A crushed cube: each particle lies somewhere within a cell of where it was.
SoftBody<3> crumpled_cube() {
  SoftBody<3> body = unit_cube();
  std::mt19937 engine(11);
  std::uniform_real_distribution<float> coordinate(-0.25f, 0.25f);
  for (std::size_t i = 0; i < body.positions().size(); ++i)
    body.set_particle(i,
                      body.position(i) + Vector3f(coordinate(engine), coordinate(engine), coordinate(engine)),
                      {0, 0, 0});
  return body;
}

/// Bodies with parts that reach into each other, and bodies that reach into themselves.
TEST(SurfaceQuery, KnowsWhatIsInsideWhereTheSurfaceLiesWithinTheBody) {
  const auto at_rest = [](const TriangleMesh& mesh, float cell) {
    return SoftBody<3>(make_soft_body_model(mesh, settings_of(cell)), Vector3f(0.1f, 0.2f, 0.3f));
  };
  const SoftBody<3> bodies[] = {at_rest(make_penguin(0.9f), 0.1f), at_rest(make_car(2), 0.1f), unit_cube(),
                                folded_cube(), crumpled_cube()};
  for (const SoftBody<3>& body : bodies) {
    const SurfaceQuery surface(body);
    const Solid solid(drawn_mesh(body));
    std::mt19937 engine(7);
    std::uniform_real_distribution<float> share(-0.05f, 1.05f);
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
      const Bounds<3>& box = surface.bounds();
      const Vector3f point =
          box.low + Vector3f(share(engine), share(engine), share(engine)).cwiseProduct(box.high - box.low);
      const float distance = surface.distance(point);
      if (std::abs(distance) < 1e-4f) continue;
      ASSERT_EQ(distance < 0, solid.contains(point))
          << body.model().particles() << " particles, " << point.transpose();
      inside += distance < 0 ? 1 : 0;
    }
    EXPECT_GT(inside, 200);
  }
}

TEST(SurfaceQuery, AMovedSphereStopsWhereItTouchesPiecesOfABody) {
  ContactWorld w({0, 0, 0});
  SoftBody<3>& body =
      w.add(make_box({0.6f, 0.6f, 0.6f}, 0.2f), {.cell_size = 0.12f, .fracture = Fracture{}}, {0, 1, 0});
  std::mt19937 random(5);
  const auto number = [&](float half) { return std::uniform_real_distribution<float>(-half, half)(random); };
  const auto vector = [&](float half) { return Vector3f(number(half), number(half), number(half)); };
  for (int i = 0; i < 4; ++i) w.bodies.cut(body, Cut::plane(Vector3f(0, 1, 0) + vector(0.2f), vector(1)));
  ASSERT_GT(w.bodies.size(), 1u);
  int hits = 0, misses = 0;
  for (std::size_t i = 0; i < w.bodies.size(); ++i) {
    const TriangleMesh mesh = drawn_mesh(w.bodies[i]);
    const SurfaceQuery query(w.bodies[i]);
    for (int k = 0; k < 40; ++k) {
      const Vector3f middle = 0.5f * (query.bounds().low + query.bounds().high);
      const Vector3f aside = vector(1).normalized();
      const Vector3f from = middle + 1.2f * aside, to = middle - 1.2f * aside + vector(1);
      const float radius = k % 2 == 0 ? 0.01f : 0.1f;
      const double touch = tests::first_touch(mesh, from, to, radius),
                   beyond = tests::first_touch(mesh, from, to, 0.98f * radius);
      const auto hit = query.cast_sphere(from, to, radius);
      if (hit) {
        EXPECT_NEAR(hit->share, touch, 0.005f) << "piece " << i << ", sphere " << k;
        ++hits;
      } else {
        EXPECT_GT(beyond, 1) << "piece " << i << ", sphere " << k;
        ++misses;
      }
    }
  }
  EXPECT_GT(hits, 20);
  EXPECT_GT(misses, 20);
}

TEST(SurfaceQuery, OfABodyWithoutAMeshIsTheLatticesBoundary) {
  const Lattice<3> lattice = voxelize(make_box({1, 1, 1}, 0.25f), 0.25f);
  const SoftBody<3> body(make_soft_body_model(lattice, settings_of(0.25f)), Vector3f(0, 0, 0));
  const SurfaceQuery surface(body);
  const Vector3f middle = body.centre_of_mass();
  EXPECT_NEAR(surface.distance(middle), -0.5f, 1e-3f);
  EXPECT_TRUE(surface.cast_ray(middle + Vector3f(0, 3, 0), middle));
}

/// Cuts leave triangles so narrow that rounding says which way they look.
TEST(SurfaceQuery, KnowsHowFarPiecesOfABodyAre) {
  ContactWorld w({0, 0, 0});
  SoftBody<3>& body =
      w.add(make_box({0.6f, 0.6f, 0.6f}, 0.2f), {.cell_size = 0.12f, .fracture = Fracture{}}, {0, 1, 0});
  std::mt19937 random(5);
  const auto number = [&](float half) { return std::uniform_real_distribution<float>(-half, half)(random); };
  const auto vector = [&](float half) { return Vector3f(number(half), number(half), number(half)); };
  for (int i = 0; i < 4; ++i) w.bodies.cut(body, Cut::plane(Vector3f(0, 1, 0) + vector(0.2f), vector(1)));
  ASSERT_GT(w.bodies.size(), 1u);
  for (std::size_t i = 0; i < w.bodies.size(); ++i) {
    const SoftBody<3>& piece = w.bodies[i];
    const SurfaceQuery query(piece);
    const std::vector<Vector3f> drawn = ContactWorld::drawn(piece);
    const Bounds<3> box = piece.bounds();
    for (int k = 0; k < 300; ++k) {
      const Vector3f point = 0.5f * (box.low + box.high) + vector(0.6f);
      double nearest = 1e9;
      for (const auto& t : piece.model().mesh().triangles) {
        const std::array<Eigen::Vector3d, 3> corners = {
            drawn[t[0]].cast<double>(), drawn[t[1]].cast<double>(), drawn[t[2]].cast<double>()};
        const double far =
            (nearest_point<double>(corners, point.cast<double>()) - point.cast<double>()).norm();
        if (far < nearest) nearest = far;  // not where a triangle is a line
      }
      const float distance = query.distance(point);
      ASSERT_NEAR(std::abs(distance), nearest, 1e-3) << "piece " << i;
      const bool is_outside =
          ((point - box.low).array() < -0.01f).any() || ((box.high - point).array() < -0.01f).any();
      if (is_outside) {
        ASSERT_GT(distance, 0) << "piece " << i;
      }
    }
  }
}

TEST(SurfaceQuery, RefusesWhatIsNotFinite) {
  SoftBody<3> body = unit_cube();
  body.set_particle(3, Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()), {0, 0, 0});
  EXPECT_THROW(SurfaceQuery{body}, std::runtime_error);
}

TEST(SoftBodiesInBullet, ARayMeetsTheNearestBodyThatItsFilterLets) {
  ContactWorld w({0, 0, 0});
  const SoftBody<3>& near = w.add(make_box({1, 1, 1}, 0.25f), settings_of(0.25f), {0, 0, 0});
  const SoftBody<3>& far = w.add(make_box({1, 1, 1}, 0.25f), settings_of(0.25f), {3, 0, 0});
  const auto hit = w.bodies.cast_ray({-5, 0, 0}, {5, 0, 0});
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->body, &near);
  EXPECT_NEAR(hit->hit.share, 0.45f, 1e-4f);
  w.bodies.set_filter(near, {.group = 4, .mask = -1});
  EXPECT_EQ(w.bodies.cast_ray({-5, 0, 0}, {5, 0, 0}, {.group = 1, .mask = ~4})->body, &far);
  EXPECT_FALSE(w.bodies.cast_ray({-5, 2, 0}, {5, 2, 0}));
  for (const float far_away : {1e3f, 1e6f, 1e10f}) {
    const auto long_ray = w.bodies.cast_ray({-5, 0, 0}, {far_away, 0, 0});
    ASSERT_TRUE(long_ray) << far_away;
    EXPECT_EQ(long_ray->body, hit->body);
  }
  const SoftBody<3> stranger = unit_cube();
  EXPECT_THROW(w.bodies.set_filter(stranger, {}), std::invalid_argument);
}

TEST(SoftBodiesInBullet, FiltersSayWhatTouches) {
  // Two pass through each other, and one of them through the floor; the other one rests on it.
  for (const ContactMethod method : {ContactMethod::kSurface, ContactMethod::kSpheres}) {
    ContactWorld w;
    BulletSoftBodies other(w.world, method);
    w.add_floor();
    const auto model = make_soft_body_model(make_box({0.5f, 0.5f, 0.5f}, 0.125f), settings_of(0.125f));
    const SoftBody<3>& falls = other.add(model, {0, 0.3f, 0});
    const SoftBody<3>& rests = other.add(model, {0.1f, 0.9f, 0});
    other.set_filter(falls, {.group = 4, .mask = ~(2 | 8)});  // 2: what stands still
    other.set_filter(rests, {.group = 8, .mask = -1});
    w.run(240);
    EXPECT_LT(falls.centre_of_mass().y(), -5) << static_cast<int>(method);
    EXPECT_NEAR(rests.centre_of_mass().y(), 0.25f, 0.1f) << static_cast<int>(method);
    other.remove(falls), other.remove(rests);
  }
}

/// Events of a box that falls on the floor, is hit by another one, and is thrown off.
void expect_events(SolverFactory* solvers) {
  using Kind = ContactEvent::Kind;
  ContactWorld w({0, -9.81f, 0}, solvers);
  const btRigidBody& floor = w.add_floor();
  SoftBody<3>& lower =
      w.add(make_box({0.5f, 0.5f, 0.5f}, 0.125f), settings_of(0.125f, 0.5f, 0.3f), {0, 0.3f, 0});
  SoftBody<3>& upper =
      w.add(make_box({0.5f, 0.5f, 0.5f}, 0.125f), settings_of(0.125f, 0.5f, 0.3f), {0, 1.5f, 0});
  w.run(10);
  EXPECT_TRUE(w.bodies.poll_contact_events().empty()) << "nobody watches";
  w.bodies.watch_contacts(true);
  w.run(1);
  std::vector<ContactEvent> events = w.bodies.poll_contact_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, Kind::kBegin);
  EXPECT_EQ(events[0].body, &lower);
  EXPECT_EQ(events[0].object, &floor);
  EXPECT_EQ(events[0].other, nullptr);
  EXPECT_NEAR(events[0].position.y(), 0, 0.05f);
  EXPECT_GT(events[0].normal.y(), 0.99f);
  w.run(120);
  w.bodies.poll_contact_events();
  w.run(60);
  events = w.bodies.poll_contact_events();
  ASSERT_EQ(events.size(), 2u);
  // Those with soft bodies and those with objects, by the number of the first body.
  const ContactEvent& between = events[0].other != nullptr ? events[0] : events[1];
  const ContactEvent& below = events[0].other != nullptr ? events[1] : events[0];
  EXPECT_EQ(between.kind, Kind::kPersist);
  EXPECT_EQ(between.body, &lower);
  EXPECT_EQ(between.other, &upper);
  EXPECT_LT(between.normal.y(), -0.95f) << "from the other one to the body";
  EXPECT_NEAR(between.position.y(), 0.5f, 0.1f);
  // A second of weight.
  EXPECT_NEAR(between.impulse, 9.81f * upper.model().mass(), 0.03f * 9.81f * upper.model().mass());
  EXPECT_NEAR(below.impulse, 2 * 9.81f * upper.model().mass(), 0.06f * 9.81f * upper.model().mass());
  upper.add_velocity({0, 5, 0});
  events.clear();
  for (int i = 0; i < 3; ++i) {
    w.run(3);
    for (const ContactEvent& event : w.bodies.poll_contact_events())
      if (event.kind == Kind::kEnd) events.push_back(event);
  }
  const auto ended =
      std::find_if(events.begin(), events.end(), [&](const ContactEvent& e) { return e.other == &upper; });
  ASSERT_NE(ended, events.end());
  EXPECT_EQ(ended->impulse, 0);
  w.bodies.watch_contacts(false);
  EXPECT_TRUE(w.bodies.poll_contact_events().empty());
}

TEST(SoftBodiesInBullet, SleepEndsNoContactAndRemovalDoes) {
  ContactWorld w;
  w.add_floor();
  w.bodies.watch_contacts(true);
  w.bodies.let_sleep(SleepSettings{});
  SoftBody<3>& body =
      w.add(make_box({0.5f, 0.5f, 0.5f}, 0.125f), settings_of(0.125f, 0.5f, 0.3f), {0, 0.251f, 0});
  for (int i = 0; i < 600 && !body.asleep(); ++i) w.run(1);
  ASSERT_TRUE(body.asleep());
  w.bodies.poll_contact_events();
  w.run(10);
  EXPECT_TRUE(w.bodies.poll_contact_events().empty());
  w.bodies.remove(body);
  const std::vector<ContactEvent> events = w.bodies.poll_contact_events();
  ASSERT_EQ(events.size(), 1u);
  EXPECT_EQ(events[0].kind, ContactEvent::Kind::kEnd);
  EXPECT_TRUE(w.bodies.poll_contact_events().empty());
}

TEST(SoftBodiesInBullet, TellOfContacts) { expect_events(nullptr); }
TEST(SoftBodiesInBullet, TellOfContactsThatSpesSolve) {
  SpeRuntime spes({.spes = 2});
  expect_events(&spes);
}

}  // namespace
}  // namespace softcell::ppu
