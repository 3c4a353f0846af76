#pragma once
// What a soft body that sleeps knows of an object near it.

#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>

#include <Eigen/Core>
#include <array>

namespace softcell::ppu {

/// An object of a world as it was when it was seen: Bullet tells nobody who sleeps that the program has removed, moved or changed it.
/// It is not looked at without the world, as the program may have destroyed it.
class SeenObject {
 public:
  /// @param place  in the world's list of objects
  SeenObject(const btDiscreteDynamicsWorld& world, int place);

  bool is(const btCollisionObject& object) const { return object_ == &object; }

  /// Whether it is gone, touches others than it did, has another shape, or is elsewhere by more than `far` metres at a point.
  bool has_changed(const btDiscreteDynamicsWorld& world, const Eigen::Vector3f& point, float far);

  /// In the world's list of objects; -1: the world does not have it.
  static int place_of(const btDiscreteDynamicsWorld& world, const btCollisionObject* object);

 private:
  /// What decides who touches the object, and where. Of shapes whose points are changed behind Bullet's back it has the box only.
  struct Look {
    const btCollisionShape* shape = nullptr;
    int kind = 0;
    int revision = 0;               // of the list of a compound
    std::array<float, 6> box = {};  // of the shape, in its own frame
    std::array<float, 4> plane = {};
    int group = 0, mask = 0;
    bool keeps_out = false;  // no trigger volume
    bool operator==(const Look&) const = default;
  };
  static Look look_at(const btCollisionObject& object);

  const btCollisionObject* object_;
  int place_;
  btTransform pose_;
  Look look_;
};

}  // namespace softcell::ppu
