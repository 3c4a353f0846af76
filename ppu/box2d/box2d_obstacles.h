#pragma once
// Converts the rigid bodies near soft ones from Box2D to plain data for contacts in three dimensions: shapes are infinitely high along z.

#include <box2d/b2_body.h>
#include <box2d/b2_fixture.h>
#include <box2d/b2_world.h>

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "ppu/box2d/box2d_body.h"
#include "ppu/obstacles/moved_by_place.h"
#include "ppu/obstacles/obstacle.h"
#include "softcell/soft_bodies/contact.h"

namespace softcell::ppu {

/// The fixtures of a world that are near some boxes: circles, polygons, edges and chains. Edges and chains have two sides and keep bodies
/// out on both. In front of a face of a thin polygon, a body sees that face only: otherwise points pressed into the polygon would leave it
/// on the other side. Used by one thread. Allocates when there are more fixtures than ever before.
class Box2dObstacles {
 public:
  enum class Fixtures { kSolid, kSensors };
  explicit Box2dObstacles(Fixtures wanted) : wanted_(wanted) {}

  /// Forgets what was near before. @param layer  soft bodies lie up to this far above and below z = 0, metres
  void begin(b2World& world, float step, float layer);

  /// Appends the indices of all obstacles that are in a box, or enter it in the substep, sorted by body; bodies come in the order in which
  /// they were added to the world.
  /// @param middle  of the soft body in the box: tells which face of a thin polygon it is in front of
  void add_near(const Bounds<3>& box, const Eigen::Vector2f& middle, const CollisionFilter& filter,
                std::vector<std::uint32_t>& indices);

  std::span<const Obstacle> obstacles() const { return obstacles_; }
  std::span<ContactRigid> rigids() { return rigids_; }
  /// The bodies that rigids() stand for.
  std::span<b2Body* const> bodies() const { return bodies_; }
  /// The index of a body in rigids(); adds it if it is missing. @pre begin() was called
  std::uint32_t rigid_of(b2Body& body);
  /// Whether the program moves a body by its place in this step.
  bool is_moved_by_place(const b2Body& body) const { return moved_by_place_of(body) != nullptr; }
  /// Forgets where bodies were: steps have passed in which nobody looked.
  void forget_places();
  /// The world's origin has moved, as in FollowedPlace::shift().
  void shift(b2World& world, const Eigen::Vector2f& by);
  /// Where a body is when the step begins: where it was before, if the program has moved it by its place since.
  b2Transform pose_of(const b2Body& body) const;
  /// The fixture of an obstacle.
  b2Fixture& fixture(std::uint32_t obstacle) const { return *fixtures_[obstacle]; }

  /// Whether the world has a body. It may have been destroyed. @pre begin() was called
  bool has(const b2Body* body) const;

  /// A number that a body of the world keeps as long as it exists.
  std::uint32_t number(const b2Body& body) const { return known_bodies_.at(&body).number; }
  /// A hash of what decides who touches a body of the world, and where. It changes when the body is enabled or disabled, and when a fixture
  /// is added, destroyed, made a sensor or solid, or gets another filter or shape. @pre begin() was called
  std::uint64_t look(const b2Body& body);
  /// The number of fixtures that the body had before this one.
  static std::uint32_t number(const b2Fixture& fixture);

  /// Sets the velocities of rigid bodies to those that contacts have given their ContactRigid.
  void apply();

 private:
  static constexpr int kWhole = -1;      // not a single face, but the whole fixture
  static constexpr float kThin = 0.25f;  // cells: as far as points may be pressed through a wall
  using Triangle = std::array<Eigen::Vector3f, 3>;
  /// The lists of one obstacle.
  struct Shape {
    std::vector<Eigen::Vector4f> planes;
    std::vector<ObstacleEdge> edges;
    std::vector<Triangle> triangles;
  };
  struct Found {
    std::uint32_t body;     // its number
    std::uint32_t fixture;  // how many fixtures the body had before
    int child;
    b2Fixture* there;
    auto operator<=>(const Found&) const = default;
  };
  /// What moves in this substep.
  struct Moving {
    b2AABB box;  // around it and its way
    Found found;
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
    std::uint64_t rigid_of_step = 0;  // the number of the step in which it has the index `rigid`
    std::uint32_t rigid = 0;
    std::uint64_t looked = 0;  // the number of the step that found `look`; 0: none has
    std::uint64_t look = 0;
    std::optional<FollowedPlace> place = {};  // if nothing moves it but the program by its place
    std::optional<MovedByPlace> motion = {};  // in this step
    bool moves = false;                       // likewise
  };
  class Collector;

  void number_bodies();
  void find_moved_by_place();
  void add_moving(b2Body& body, const KnownBody& known);
  bool wants(const b2Fixture& fixture) const { return fixture.IsSensor() == (wanted_ == Fixtures::kSensors); }
  const MovedByPlace* moved_by_place_of(const b2Body& body) const;
  VelocityGain gain_of(const b2Body& body) const;
  b2AABB box_of_step(const KnownBody& known, const b2Fixture& fixture, int child) const;
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
  std::vector<b2Fixture*> fixtures_;  // for each obstacle
  std::vector<ContactRigid> rigids_, before_;
  std::vector<b2Body*> bodies_;
  std::unordered_map<const b2Body*, KnownBody> known_bodies_;  // all bodies of the world
  std::uint64_t steps_ = 0;
  std::uint32_t next_number_ = 0;
  std::vector<b2Body*> unknown_;
  std::vector<Moving> moving_;
  std::vector<Found> found_;
  std::vector<Known> known_;
  std::deque<Shape> shapes_;  // obstacles point into them
  std::size_t shapes_used_ = 0;
};

}  // namespace softcell::ppu
