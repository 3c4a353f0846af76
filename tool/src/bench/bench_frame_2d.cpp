// Frames of the 2D demo without pictures, compared with circles in Box2D alone.

#include <box2d/b2_body.h>
#include <box2d/b2_circle_shape.h>
#include <box2d/b2_fixture.h>
#include <box2d/b2_polygon_shape.h>
#include <box2d/b2_world.h>

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "benchmarks.h"
#include "scene_file/scene_library.h"
#include "scene_frames.h"
#include "simulation/simulation_2d.h"
#include "softcell/base/assert.h"

namespace softcell::tool {
namespace {

constexpr int kFramesBefore2d = 300;  // so that everything is on the floor when measuring begins
constexpr int kFrames2d = 20;         // in one measurement
using demos::kFrameSeconds;

using SoftFrames2d = SceneFrames<demos::Scene2d, demos::Simulation2d>;

/// A scene of walls and soft bodies, in which a loose circle replaces each particle: the cost of Box2D alone when all of them collide.
class CircleFrames {
 public:
  explicit CircleFrames(const std::string& name) {
    const demos::Scene2d scene = demos::load_scene_2d(name);
    SC_ASSERT(scene.substeps > 0, "{} substeps in a frame of {}", scene.substeps, name);
    substeps_ = scene.substeps;
    world_.SetGravity({0, -scene.gravity});
    world_.SetAllowSleeping(false);
    for (const demos::RigidBody2d& wall : scene.rigid_bodies) add_wall(wall);
    for (const demos::SoftBody2dPlacement& placement : scene.soft_bodies) {
      const auto model =
          ppu::make_soft_body_model(placement.lattice(), placement.settings, placement.contact_radius);
      for (std::size_t i = 0; i < model->particles(); ++i)
        add_circle(model->lattice().rest_position(i) + placement.position, model->contact_radius());
    }
    for (int i = 0; i < kFramesBefore2d; ++i) step();
  }

  void step() {
    for (int i = 0; i < substeps_; ++i) world_.Step(kFrameSeconds / static_cast<float>(substeps_), 8, 3);
  }

 private:
  void add_wall(const demos::RigidBody2d& wall) {
    b2BodyDef definition;
    definition.position = {wall.position.x(), wall.position.y()};
    SC_ASSERT(std::holds_alternative<demos::Box2dShape>(wall.shape), "a wall of shape {} at ({}, {})",
              wall.shape.index(), wall.position.x(), wall.position.y());
    const Eigen::Vector2f half = std::get<demos::Box2dShape>(wall.shape).size / 2;
    b2PolygonShape shape;
    shape.SetAsBox(half.x(), half.y());
    world_.CreateBody(&definition)->CreateFixture(&shape, 0);
  }
  void add_circle(const Eigen::Vector2f& position, float radius) {
    b2BodyDef definition;
    definition.type = b2_dynamicBody;
    definition.position = {position.x(), position.y()};
    b2CircleShape shape;
    SC_ASSERT(radius > 0, "a circle with a radius of {} m", radius);
    shape.m_radius = radius;
    world_.CreateBody(&definition)->CreateFixture(&shape, 1);
  }

  int substeps_ = 1;
  b2World world_{{0, 0}};
};

template <typename Frames>
Work work_of(const std::shared_ptr<Frames>& frames) {
  return {kFrames2d, [=] {
            for (int i = 0; i < kFrames2d; ++i) frames->step();
          }};
}

}  // namespace

void add_frame_2d_benchmarks(std::vector<Benchmark>& all) {
  const Shared<SoftFrames2d> man(
      [] { return std::make_shared<SoftFrames2d>(demos::load_scene_2d("man"), kFramesBefore2d); });
  all.push_back({"frame/man", [=] { return work_of(man.get()); }});
  all.push_back({"frame/man/ppu", [=] {
                   Work work = work_of(man.get());
                   work.spent = [frames = man.get()] { return frames->ppu_time(); };
                   return work;
                 }});
  all.push_back({"frame/man/circles", [] { return work_of(std::make_shared<CircleFrames>("man")); }});
}

}  // namespace softcell::tool
