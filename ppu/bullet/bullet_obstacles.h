#pragma once
// Converts the rigid bodies near soft ones from Bullet to plain data.

#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "ppu/bullet/convex_hull.h"
#include "ppu/obstacles/moved_by_place.h"
#include "ppu/obstacles/obstacle.h"
#include "softcell/soft_bodies/mesh.h"

class btCompoundShape;

namespace softcell::ppu {

/// The rigid bodies of a world that are near some boxes. Used by one thread. Allocates when there are more of them than ever before.
///
/// Knows planes, spheres, boxes, capsules, cylinders, cones, compounds, triangle meshes and height fields. Any other convex shape is
/// replaced by its hull.
class BulletObstacles {
 public:
  /// Which objects of the world are taken.
  enum class Objects {
    kSolid,    ///< those that keep others out
    kTriggers  ///< trigger volumes: objects without contact response in Bullet
  };
  explicit BulletObstacles(Objects objects) : role_(objects) {}

  /// Forgets what was near before. The broad phase still has the boxes of the step before, as Bullet updates them later in its step. So
  /// this looks for moving objects that leave their boxes.
  void begin(const btDiscreteDynamicsWorld& world, float step);

  /// Appends the indices of all obstacles that are in a box, or enter it in the substep.
  /// @param group, mask  Bullet's collision filter of the soft body in the box
  /// @throws std::runtime_error  a shape that is neither convex nor made of triangles; the message names it.
  void add_near(const Bounds<3>& box, int group, int mask, std::vector<std::uint32_t>& indices);

  /// The index of an object's rigid body, near or not. @pre begin() was called
  std::uint32_t rigid_of(btCollisionObject& object);

  /// Whether the program moves an object by its place in this substep.
  bool is_moved_by_place(const btCollisionObject& object) const {
    return moved_by_place_of(object) != nullptr;
  }
  /// Where an object is when the substep begins: where it was before, if the program has moved it by its place since.
  btTransform pose_of(const btCollisionObject& object) const;

  std::span<const Obstacle> obstacles() const { return obstacles_; }
  std::span<ContactRigid> rigids() { return rigids_; }
  /// The objects that rigids() stand for. A collision object that is not a rigid body never moves.
  std::span<btCollisionObject* const> objects() const { return objects_; }

  /// Sets the velocities of rigid bodies to those that contacts have given their ContactRigid.
  /// @param at_rest  for each: what touches it is at rest, so Bullet may let it fall asleep, or sleep on
  void apply(const std::vector<bool>& at_rest);

 private:
  /// An object's motion in a substep, metres.
  struct Way {
    Eigen::Vector3f along{0, 0, 0};
    float turn = 0;  ///< how far its spin moves any point at most
  };
  using Triangle = std::array<Eigen::Vector3f, 3>;
  /// An object that only the program moves.
  struct Followed {
    const btCollisionObject* object = nullptr;
    int id = 0;  ///< in the broad phase
    FollowedPlace place{{}};
    std::optional<MovedByPlace> motion = {};  ///< in this substep
  };
  /// An object that leaves its box in the broad phase during the substep.
  struct Leaving {
    const btBroadphaseProxy* proxy;
    Bounds<3> box;  ///< around its motion
  };

  void find_moved_by_place();
  const MovedByPlace* moved_by_place_of(const btCollisionObject& object) const;
  Way way_of(const btCollisionObject& object) const;
  static Bounds<3> ahead(const Bounds<3>& box, const Way& way);
  static Bounds<3> behind(const Bounds<3>& box, const Way& way);
  void find_leaving(const btCollisionObject& object);
  void add_object(btCollisionObject& object, const Bounds<3>& box, std::vector<std::uint32_t>& indices);
  /// @param part  the number of the shape, which no other shape of the rigid body has
  void add_shape(const btCollisionShape& shape, const btTransform& pose, std::uint32_t rigid,
                 std::uint32_t part, const Bounds<3>& box, std::vector<std::uint32_t>& indices);
  /// Adds the shapes of a compound, which may be compounds.
  void add_compound(const btCompoundShape& compound, const btTransform& pose, std::uint32_t rigid,
                    std::uint32_t part, const Bounds<3>& box, std::vector<std::uint32_t>& indices);
  void add_triangles(const btCollisionShape& shape, Obstacle obstacle, const Bounds<3>& box,
                     std::vector<std::uint32_t>& indices);
  std::vector<ObstacleEdge>& more_edges();
  std::vector<Triangle>& more_triangles();
  void push(const Obstacle& obstacle, std::vector<std::uint32_t>& indices);

  Objects role_;
  const btDiscreteDynamicsWorld* world_ = nullptr;
  float step_ = 0;
  std::vector<Obstacle> obstacles_;
  std::vector<ContactRigid> rigids_, before_;
  std::vector<btCollisionObject*> objects_;
  std::vector<std::uint32_t> rigid_of_;     // of each object of the world; kNone: not known yet
  std::vector<std::uint32_t> obstacle_of_;  // of each object without triangles; kNone: not known yet
  std::map<const btCollisionShape*, ConvexHull> hulls_;
  // The first lists are in use in this substep; the others are kept for reuse.
  std::vector<std::vector<ObstacleEdge>> edges_;
  std::vector<std::vector<Triangle>> triangles_;
  std::size_t edges_used_ = 0, triangles_used_ = 0;
  std::vector<Leaving> leaving_;
  std::vector<Followed> followed_;  // for each object of the world; of one that others move, nothing
  std::vector<const btBroadphaseProxy*> found_;
};

}  // namespace softcell::ppu
