#pragma once
// What is rigid near soft bodies in two dimensions, as plain data of contacts in three: shapes go on endlessly above and below.

#include <box2d/b2_body.h>
#include <box2d/b2_fixture.h>
#include <box2d/b2_world.h>

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <unordered_map>
#include <vector>

#include "ppu/surfaces/obstacle.h"
#include "softcell/soft_bodies/contact.h"

namespace softcell::ppu {

/// The fixtures of a world that are near some boxes: circles, polygons, edges and chains. Edges and chains have two sides, and keep out what
/// comes to either of them. A body in front of a face of a thin polygon has that face only before it: what is pressed into such a polygon
/// would leave it on the other side. Used by one thread. Allocates when there are more of them than ever before.
class Box2dObstacles {
 public:
  enum class Fixtures { kSolid, kSensors };
  explicit Box2dObstacles(Fixtures wanted) : wanted_(wanted) {}

  /// Forgets what was near before. @param layer  metres above and below z = 0 in which soft bodies are
  void begin(b2World& world, float step, float layer);

  /// Appends the indices of all obstacles that are in a box, or come there in the substep, those of one body behind each other, bodies in
  /// the order in which the world got them.
  /// @param middle  of the body in the box: says which face of a thin polygon is before it
  void add_near(const Bounds<3>& box, const Eigen::Vector2f& middle, const CollisionFilter& filter,
                std::vector<std::uint32_t>& indices);

  std::span<const Obstacle> obstacles() const { return obstacles_; }
  std::span<ContactRigid> rigids() { return rigids_; }
  /// Whose rigids() these are.
  std::span<b2Body* const> bodies() const { return bodies_; }
  /// Which of rigids() a body is; it is added if it is none yet. @pre begin() was called
  std::uint32_t rigid_of(b2Body& body);
  /// Of an obstacle.
  b2Fixture& fixture(std::uint32_t obstacle) const { return *fixtures_[obstacle]; }

  /// Whether the world has a body, which may be destroyed. @pre begin() was called
  bool has(const b2Body* body) const { return known_bodies_.contains(body); }

  /// Of a body of the world, for as long as it is there.
  std::uint32_t number(const b2Body& body) const { return known_bodies_.at(&body).number; }
  /// Of a body of the world: another number when it was enabled or disabled, or a fixture was added, destroyed, made a sensor or solid, or
  /// given another filter or shape. @pre begin() was called
  std::uint64_t look(const b2Body& body);
  /// How many fixtures a body has got before this one.
  static std::uint32_t number(const b2Fixture& fixture);

  /// Gives rigid bodies the velocities that contacts have given their ContactRigid.
  void apply();

 private:
  static constexpr int kWhole = -1;      // no face, but all of the fixture
  static constexpr float kThin = 0.25f;  // cells: as far as something may be pressed through a wall
  using Triangle = std::array<Eigen::Vector3f, 3>;
  /// The lists of one obstacle.
  struct Shape {
    std::vector<Eigen::Vector4f> planes;
    std::vector<ObstacleEdge> edges;
    std::vector<Triangle> triangles;
  };
  struct Found {
    std::uint32_t body;     // its number
    std::uint32_t fixture;  // how many the body has behind it
    int child;
    b2Fixture* there;
    auto operator<=>(const Found&) const = default;
  };
  /// An obstacle of this substep.
  struct Known {
    const b2Fixture* fixture;
    int child;
    int face;  // of a polygon, or kWhole
    std::uint32_t obstacle;
  };
  /// A body of the world.
  struct KnownBody {
    std::uint32_t number;
    std::uint64_t looked = 0;  // at the step of this number; 0: never
    std::uint64_t look = 0;
  };
  class Collector;

  void number_bodies();
  b2Vec2 velocity_of(const b2Body& body) const;
  b2AABB box_of_step(const b2Fixture& fixture, int child) const;
  int face_before(const Found& found, const Bounds<3>& box, const Eigen::Vector2f& middle) const;
  std::uint32_t obstacle_of(const Found& found, int face);
  std::uint32_t obstacle_of_chain(std::span<const Found> edges);
  Obstacle placed_with(b2Fixture& fixture);
  std::uint32_t add(Obstacle obstacle, const Shape& shape, b2Fixture& fixture);
  static void add_circle(const b2Fixture& fixture, Obstacle& obstacle, Shape& shape);
  static void add_polygon(const b2Fixture& fixture, Obstacle& obstacle, Shape& shape);
  void add_face(const b2Fixture& fixture, int face, Obstacle& obstacle, Shape& shape) const;
  void add_walls(std::span<const Found> edges, Obstacle& obstacle, Shape& shape) const;
  void add_wall(const b2Vec2& from, const b2Vec2& to, Obstacle& obstacle, Shape& shape) const;
  Shape& next_shape();

  Fixtures wanted_;
  b2World* world_ = nullptr;
  float step_ = 0, layer_ = 0;
  std::vector<Obstacle> obstacles_;
  std::vector<b2Fixture*> fixtures_;  // of each obstacle
  std::vector<ContactRigid> rigids_, before_;
  std::vector<b2Body*> bodies_;
  std::unordered_map<const b2Body*, KnownBody> known_bodies_;  // all that the world has
  std::uint64_t steps_ = 0;
  std::uint32_t next_number_ = 0;
  std::vector<b2Body*> unknown_;
  std::vector<b2Body*> moving_;  // in this substep
  std::vector<Found> found_;
  std::vector<Known> known_;
  std::deque<Shape> shapes_;  // obstacles point into them
  std::size_t shapes_used_ = 0;
};

}  // namespace softcell::ppu
