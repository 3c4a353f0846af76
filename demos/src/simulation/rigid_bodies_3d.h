#pragma once
// The rigid bodies of a scene in its Bullet world.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "ppu/bullet/bullet_world.h"
#include "scene/attachment_placement.h"
#include "scene/beginning.h"
#include "scene/scene.h"

namespace softcell::demos {

/// Numbers from 0 on are those of Scene::boxes, then of Scene::rigid_bodies. Bullet's world numbers them differently, and it also has the
/// scene's obstacles, which have no number here. One thread uses it.
class RigidBodies3d {
 public:
  /// Adds all boxes, rigid bodies, joints and obstacles of the scene. @param scene,world  must outlive this object
  RigidBodies3d(const Scene& scene, ppu::BulletWorld& world);

  std::size_t size() const { return in_world_.size(); }
  /// @param in_world  a number in Bullet's world   @return  the body's number, or size() for an obstacle
  std::size_t number_of(std::size_t in_world) const;
  /// The number of those with a mass above 0.
  std::size_t with_mass() const;

  // Of one of them. @pre body < size()
  float mass(std::size_t body) const;     ///< kg
  float opacity(std::size_t body) const;  ///< 0..1
  btRigidBody& bullet_body(std::size_t body) const { return world_.rigid_body(in_world_[body]); }
  Eigen::Matrix4f pose(std::size_t body) const { return world_.pose(in_world_[body]); }

  /// The rigid body that an attachment ends at; null: it ends at the world or a soft body.
  btRigidBody* of_attachment(const AttachmentPlacement<3>& placement) const;
  /// For the user: "a wall", "box 2", the scene's name of a body, "an obstacle". @param in_world  a number in Bullet's world
  std::string name_of(std::size_t in_world) const;

  /// Moves the bodies that the scene moves so that they arrive at the end of the next substep. @param time  seconds, of that moment
  void move_to(double time);
  /// Puts the bodies that the scene moves where they are at `time` seconds.
  void put_to(double time);

  /// Where the bodies are that physics moves, and how they move.
  std::vector<Beginning<3>::RigidBody> state() const;
  /// Puts them there. @pre the scene has a beginning  @throws std::runtime_error  its state is of other bodies
  void set_beginning();

 private:
  void add(const RigidBody& body);
  template <class Place>
  void for_each_moved(double time, const Place& place) const;

  const Scene& scene_;
  ppu::BulletWorld& world_;
  std::vector<std::size_t> in_world_;  // of each, its number there
};

}  // namespace softcell::demos
