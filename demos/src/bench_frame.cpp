// Whole frames of scenes, and of the same scenes with loose Bullet spheres in the place of soft bodies.

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>
#include <vector>

#include "benchmarks.h"
#include "scene_file/scene_library.h"
#include "simulation_3d.h"
#include "softcell/ppu/bullet_world.h"

namespace softcell::demos {
namespace {

constexpr int kFramesBefore = 120;  // so that bodies lie on each other when measuring begins
constexpr float kFrameSeconds = 1.0f / 60;

/// A scene as it is simulated, skinning included.
class SoftFrames {
 public:
  explicit SoftFrames(const std::string& scene) : scene_(load_scene_3d(scene)), simulation_(scene_, {}) {
    for (int i = 0; i < kFramesBefore; ++i) step();
  }

  void step() { simulation_.step(); }

 private:
  Scene scene_;
  Simulation3d simulation_;
};

/// The scene's outer particles as rigid spheres of the size and mass that they have for Bullet.
class SphereFrames {
 public:
  explicit SphereFrames(const std::string& name) {
    const Scene scene = load_scene_3d(name);
    substeps_ = scene.substeps;
    for (const RigidBox& box : scene.boxes) world_.add_box(box.size, box.mass, box.position, scene.friction);
    for (const Obstacle& obstacle : scene.obstacles)
      world_.add_convex(obstacle.mesh, obstacle.position, scene.friction);
    for (const SoftBodyPlacement& placement : scene.soft_bodies) add_spheres(placement);
    for (int i = 0; i < kFramesBefore; ++i) step();
  }

  ~SphereFrames() {
    for (const auto& sphere : spheres_) world_.world().removeRigidBody(sphere.get());
  }

  void step() { world_.step(kFrameSeconds, substeps_); }

 private:
  void add_spheres(const SoftBodyPlacement& placement) {
    const auto model = ppu::make_soft_body_model(placement.mesh, placement.settings);
    shapes_.push_back(std::make_unique<btSphereShape>(model->soft_contact_radius()));
    for (const std::uint32_t particle : model->outer()) {
      btRigidBody::btRigidBodyConstructionInfo info(model->masses()[particle], nullptr, shapes_.back().get());
      const Eigen::Vector3f x = placement.position + model->lattice().rest_position(particle);
      info.m_startWorldTransform.setOrigin({x.x(), x.y(), x.z()});
      info.m_friction = placement.settings.friction;
      spheres_.push_back(std::make_unique<btRigidBody>(info));
      spheres_.back()->setActivationState(DISABLE_DEACTIVATION);
      world_.world().addRigidBody(spheres_.back().get());
    }
  }

  ppu::BulletWorld world_;
  std::vector<std::unique_ptr<btSphereShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> spheres_;
  int substeps_ = 1;
};

template <typename Frames>
Benchmark frames_of(const std::string& scene, const char* kind) {
  return {"frame/" + scene + kind, [=] {
            const auto frames = std::make_shared<Frames>(scene);
            return Work{1, [=] { frames->step(); }};
          }};
}

}  // namespace

void add_frame_benchmarks(std::vector<Benchmark>& all) {
  for (const char* scene : {"arena"}) {
    all.push_back(frames_of<SoftFrames>(scene, ""));
    all.push_back(frames_of<SphereFrames>(scene, "/spheres"));
  }
  all.push_back(frames_of<SoftFrames>("big", ""));  // nothing touches it
}

}  // namespace softcell::demos
