// Whole frames of scenes, and of the same scenes with loose Bullet spheres instead of soft bodies.

#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletDynamics/Dynamics/btDiscreteDynamicsWorld.h>
#include <BulletDynamics/Dynamics/btRigidBody.h>

#include <memory>
#include <string>
#include <vector>

#include "benchmarks.h"
#include "kernel_runs/kernel_file.h"
#include "ppu/bullet/bullet_world.h"
#include "scene_file/scene_library.h"
#include "scene_frames.h"
#include "simulation/simulation_3d.h"
#include "softcell/base/assert.h"
#include "softcell/spe_bodies/spe_solver.h"

namespace softcell::tool {
namespace {

constexpr int kFramesBefore = 120;  // so that bodies lie on each other when measuring begins
using demos::kFrameSeconds;

using SoftFrames = SceneFrames<demos::Scene, demos::Simulation3d>;

/// Repeats a substep's shape matching and damping of a scene's bodies in their present state on one SPE.
class SolverSteps {
 public:
  explicit SolverSteps(const SoftFrames& frames)
      : step_(kFrameSeconds / static_cast<float>(frames.scene().substeps)) {
    for (std::size_t b = 0; b < frames.simulation().soft_bodies(); ++b)
      bodies_.push_back(frames.simulation().soft_body(b));
    SC_ASSERT(step_ > 0 && !bodies_.empty(), "{} bodies with steps of {} s", bodies_.size(), step_);
    for (ppu::SoftBody<3>& body : bodies_) pointers_.push_back(&body);
    solver_.kick(pointers_, step_);
    // One step is completed, so that rotations are known: a body in tiles does not keep those of a dropped step.
    solver_.finish();
  }

  void step() {
    solver_.kick(pointers_, step_);
    solver_.drop();
  }

 private:
  float step_;
  std::vector<ppu::SoftBody<3>> bodies_;  // copies
  std::vector<ppu::SoftBody<3>*> pointers_;
  dma::AddressSpace memory_;
  ls_sim::KernelImage match_ = load_kernel("match"), tiles_ = load_kernel("match_tiles"),
                      job_loop_ = load_kernel("job_loop");
  ppu::JobSystem jobs_{memory_, {.spes = 1}, job_loop_};
  ppu::SpeSolver<3> solver_{memory_, jobs_, {match_, tiles_}};
};

/// The scene's outer particles as rigid spheres of the size and mass that they have for Bullet.
class SphereFrames {
 public:
  explicit SphereFrames(const std::string& name) {
    const demos::Scene scene = demos::load_scene_3d(name);
    SC_ASSERT(scene.substeps > 0, "{} substeps in a frame of {}", scene.substeps, name);
    substeps_ = scene.substeps;
    for (const demos::RigidBox& box : scene.boxes)
      world_.add_box(box.size, box.mass, box.position, scene.friction);
    for (const demos::Obstacle& obstacle : scene.obstacles)
      world_.add_convex(obstacle.mesh, obstacle.position, scene.friction);
    for (const demos::SoftBodyPlacement& placement : scene.soft_bodies) add_spheres(placement);
    for (int i = 0; i < kFramesBefore; ++i) step();
  }

  ~SphereFrames() {
    for (const auto& sphere : spheres_) world_.world().removeRigidBody(sphere.get());
  }

  void step() { world_.step(kFrameSeconds, substeps_); }

 private:
  void add_spheres(const demos::SoftBodyPlacement& placement) {
    const auto model = ppu::make_soft_body_model(placement.mesh, placement.settings);
    SC_ASSERT(model->soft_contact_radius() > 0, "spheres of {} m", model->soft_contact_radius());
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

void add_scene(std::vector<Benchmark>& all, const std::string& scene) {
  const Shared<SoftFrames> shared(
      [=] { return std::make_shared<SoftFrames>(demos::load_scene_3d(scene), kFramesBefore); });
  const std::string name = "frame/" + scene;
  all.push_back({name, [=] {
                   const auto frames = shared.get();
                   return Work{1, [=] { frames->step(); }};
                 }});
  all.push_back({name + "/ppu", [=] {
                   const auto frames = shared.get();
                   return Work{1, [=] { frames->step(); }, [=] { return frames->ppu_time(); }};
                 }});
  all.push_back({name + "/solver", [=] {
                   const auto steps = std::make_shared<SolverSteps>(*shared.get());
                   return Work{1, [=] { steps->step(); }};
                 }});
}

}  // namespace

void add_frame_benchmarks(std::vector<Benchmark>& all) {
  add_scene(all, "arena");
  add_scene(all, "penguins");
  add_scene(all, "big");  // nothing touches its body
  all.push_back({"frame/arena/spheres", [] {
                   const auto frames = std::make_shared<SphereFrames>("arena");
                   return Work{1, [=] { frames->step(); }};
                 }});
}

}  // namespace softcell::tool
