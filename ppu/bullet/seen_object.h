#pragma once
// What a sleeping soft body knows about an object near it.

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <Eigen/Core>
#include <array>

namespace softcell::ppu {

/// An object of a world as it was when a sleeper saw it: Bullet does not tell sleepers that the program has removed, moved or changed it.
/// The class reads the object only if the world still has it, as the program may have destroyed it.
class SeenObject {
 public:
  /// @param place  the object's index in the world's list of objects
  SeenObject(const btDiscreteDynamicsWorld& world, int place);

  bool is(const btCollisionObject& object) const { return object_ == &object; }

  /// Whether the object is gone, touches others than it did, has another shape, or has moved by more than `far` metres at `point`.
  bool has_changed(const btDiscreteDynamicsWorld& world, const Eigen::Vector3f& point, float far);

  /// The object's index in the world's list of objects; -1: the world does not have it.
  static int place_of(const btDiscreteDynamicsWorld& world, const btCollisionObject* object);

 private:
  /// What decides who touches the object, and where. If the program changes points within a shape, only a change of its box shows here.
  struct Look {
    const btCollisionShape* shape = nullptr;
    int kind = 0;
    int revision = 0;               // of a compound's list of shapes
    std::array<float, 6> box = {};  // of the shape, in its own frame
    std::array<float, 4> plane = {};
    int group = 0, mask = 0;
    bool keeps_out = false;  // false: a trigger volume
    bool operator==(const Look&) const = default;
  };
  static Look look_at(const btCollisionObject& object);

  const btCollisionObject* object_;
  int place_;
  btTransform pose_;
  Look look_;
};

}  // namespace softcell::ppu
