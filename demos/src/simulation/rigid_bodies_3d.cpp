#include "rigid_bodies_3d.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <stdexcept>

#include "beginning_of.h"
#include "ppu/bullet/rigid_shape.h"
#include "softcell/base/assert.h"

namespace softcell::demos {

RigidBodies3d::RigidBodies3d(const Scene& scene, ppu::BulletWorld& world) : scene_(scene), world_(world) {
  for (const RigidBox& box : scene.boxes) {
    in_world_.push_back(
        world.add_box(box.size, box.mass, box.position, scene.friction, scene.restitution, box.rotation));
  }
  for (const RigidBody& body : scene.rigid_bodies) add(body);
  for (const Joint& joint : scene.joints) {
    world.add_hinge({.a = in_world_[scene.boxes.size() + joint.a],
                     .b = in_world_[scene.boxes.size() + joint.b],
                     .point = joint.point,
                     .axis = joint.axis,
                     .speed = joint.speed,
                     .torque = joint.torque});
  }
  for (const Obstacle& obstacle : scene.obstacles)
    world.add_convex(obstacle.mesh, obstacle.position, scene.friction, scene.restitution);
}

void RigidBodies3d::add(const RigidBody& body) {
  std::vector<ppu::RigidShape> shapes;
  for (const RigidPart& part : body.parts) shapes.push_back(part.shape);
  const Placement start =
      body.motion ? placement_at(body, 0) : Placement{.position = body.position, .rotation = body.rotation};
  in_world_.push_back(world_.add_body(shapes, {.mass = body.mass,
                                               .position = start.position,
                                               .rotation = start.rotation,
                                               .friction = body.friction.value_or(scene_.friction),
                                               .restitution = scene_.restitution,
                                               .is_moved = body.motion.has_value()}));
}

std::size_t RigidBodies3d::number_of(std::size_t in_world) const {
  return static_cast<std::size_t>(std::ranges::find(in_world_, in_world) - in_world_.begin());
}

std::size_t RigidBodies3d::with_mass() const {
  std::size_t count = 0;
  for (std::size_t body = 0; body < size(); ++body)
    if (mass(body) > 0) ++count;
  return count;
}

float RigidBodies3d::mass(std::size_t body) const {
  SC_ASSERT(body < size(), "rigid body {} of {}", body, size());
  const std::size_t boxes = scene_.boxes.size();
  return body < boxes ? scene_.boxes[body].mass : scene_.rigid_bodies[body - boxes].mass;
}

float RigidBodies3d::opacity(std::size_t body) const {
  SC_ASSERT(body < size(), "rigid body {} of {}", body, size());
  const std::size_t boxes = scene_.boxes.size();
  return body < boxes ? scene_.boxes[body].opacity : scene_.rigid_bodies[body - boxes].opacity;
}

btRigidBody* RigidBodies3d::of_attachment(const AttachmentPlacement<3>& placement) const {
  if (placement.rigid) return &bullet_body(scene_.boxes.size() + *placement.rigid);
  return placement.box ? &bullet_body(*placement.box) : nullptr;
}

std::string RigidBodies3d::name_of(std::size_t in_world) const {
  const std::size_t body = number_of(in_world), boxes = scene_.boxes.size();
  const auto walls = static_cast<std::size_t>(std::ranges::count_if(scene_.boxes, &RigidBox::wall));
  const std::size_t of_framework = walls > 0 ? walls + 1 : 0;
  if (body < of_framework) return scene_.boxes[body].wall ? "a wall" : "the floor";
  if (body < boxes) return fmt::format("box {}", body - of_framework + 1);
  if (body < size()) return scene_.rigid_bodies[body - boxes].name;
  return "an obstacle";
}

/// Calls `place(its number in the world, where it is at the time)` for each body that the scene moves.
template <class Place>
void RigidBodies3d::for_each_moved(double time, const Place& place) const {
  for (std::size_t i = 0; i < scene_.rigid_bodies.size(); ++i) {
    if (!scene_.rigid_bodies[i].motion) continue;
    place(in_world_[scene_.boxes.size() + i], placement_at(scene_.rigid_bodies[i], time));
  }
}

void RigidBodies3d::move_to(double time) {
  for_each_moved(time, [&](std::size_t in_world, const Placement& at) {
    world_.move_to(in_world, at.position, at.rotation);
  });
}

void RigidBodies3d::put_to(double time) {
  for_each_moved(time, [&](std::size_t in_world, const Placement& at) {
    world_.teleport(in_world, at.position, at.rotation);
  });
}

std::vector<Beginning<3>::RigidBody> RigidBodies3d::state() const {
  std::vector<Beginning<3>::RigidBody> state;
  for (std::uint32_t i = 0; i < world_.rigid_bodies(); ++i) {
    if (!world_.moves(i)) continue;
    const ppu::BulletWorld::Motion motion = world_.motion(i);
    state.push_back({.body = i,
                     .position = motion.position,
                     .rotation = motion.rotation,
                     .velocity = motion.velocity,
                     .angular_velocity = motion.angular_velocity});
  }
  return state;
}

void RigidBodies3d::set_beginning() {
  SC_ASSERT(scene_.begin, "the scene '{}' has no beginning", scene_.name);
  std::size_t moving = 0;
  for (std::size_t i = 0; i < world_.rigid_bodies(); ++i) moving += world_.moves(i) ? 1 : 0;
  check_moving_bodies(scene_, moving);
  for (const Beginning<3>::RigidBody& rigid : scene_.begin->rigid_bodies) {
    if (rigid.body >= world_.rigid_bodies() || !world_.moves(rigid.body))
      throw std::runtime_error(fmt::format("rigid body {} of the saved state does not move in the scene {}",
                                           rigid.body, scene_.name));
    world_.teleport(rigid.body, {.position = rigid.position,
                                 .rotation = rigid.rotation,
                                 .velocity = rigid.velocity,
                                 .angular_velocity = rigid.angular_velocity});
  }
}

}  // namespace softcell::demos
