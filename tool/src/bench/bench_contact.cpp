// Whole frames in which bodies touch: with our contacts of the drawn surfaces, with rigid spheres at particles, and with Bullet's own soft
// bodies.

#include <fmt/format.h>
#include <time.h>

#include <chrono>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "benchmarks.h"
#include "ppu/bullet/bullet_vector.h"
#include "ppu/bullet/bullet_world.h"
#include "scene_file/scene_library.h"
#include "simulation/simulation_3d.h"
#include "softcell/base/assert.h"
#include "softcell/bullet/bullet_soft_bodies.h"
#include "softcell/spe_bodies/spe_runtime.h"

// Included after the others: see bullet_links.h.
#include <BulletSoftBody/btSoftBodyRigidBodyCollisionConfiguration.h>
#include <BulletSoftBody/btSoftRigidDynamicsWorld.h>
#include <btBulletDynamicsCommon.h>

#include "bullet_links.h"

namespace softcell::tool {
namespace {

using demos::kFrameSeconds;
using ppu::to_bullet;

constexpr int kFramesOfRun = 10;

/// A scene, the number of its bodies that are used, and the frames that are measured.
struct ContactCase {
  const char* name;
  const char* scene;
  std::size_t most_bodies;
  int first_frame, last_frame;
};

// In `fall` penguins fall through bars, in `rest` four bodies lie side by side, in `pile` twenty in a heap, in `self` a long
// body lies on itself; in `mesh` and `coarse_mesh` a body lies on triangles.
constexpr ContactCase kCases[] = {{"fall", "penguins", 150, 60, 120},
                                  {"rest", "pile", 4, 120, 240},
                                  {"pile", "pile", 20, 120, 240},
                                  {"self", "knot", 1, 60, 240}};

demos::Scene scene_of(const ContactCase& of) {
  demos::Scene scene = demos::load_scene_3d(of.scene);
  SC_ASSERT(scene.soft_bodies.size() >= of.most_bodies, "{} bodies of {} in {}", of.most_bodies,
            scene.soft_bodies.size(), of.scene);
  scene.soft_bodies.resize(of.most_bodies);
  return scene;
}

/// A scene that is simulated in frames of 1/60 s.
class Frames {
 public:
  virtual ~Frames() = default;
  virtual void step() = 0;
  virtual std::size_t particles() const = 0;
};

/// A scene as `softcell demo 3d` simulates it, skinning included.
class OurFrames final : public Frames {
 public:
  OurFrames(demos::Scene scene, ppu::ContactMethod contacts)
      : scene_(std::move(scene)), simulation_(scene_, {.contacts = contacts}) {}
  void step() override { simulation_.step(); }
  std::size_t particles() const override { return simulation_.particles(); }

 private:
  demos::Scene scene_;
  demos::Simulation3d simulation_;
};

/// The same scene with Bullet's soft bodies: a node for each particle, links along edges and across faces of cells, the whole body's pose,
/// and contacts of clusters with rigid bodies and other soft bodies.
class BulletFrames final : public Frames {
 public:
  explicit BulletFrames(const demos::Scene& scene) : substeps_(scene.substeps) {
    world_.setGravity({0, -scene.gravity, 0});
    info_.m_gravity = world_.getGravity();
    info_.m_broadphase = &broadphase_;
    info_.m_dispatcher = &dispatcher_;
    info_.m_sparsesdf.Initialize();
    for (const demos::RigidBox& box : scene.boxes)
      add_rigid(std::make_unique<btBoxShape>(to_bullet(box.size / 2)), box.mass, box.position,
                scene.friction);
    for (const demos::Obstacle& obstacle : scene.obstacles) {
      auto hull = std::make_unique<btConvexHullShape>();
      for (const Eigen::Vector3f& p : obstacle.mesh.positions) hull->addPoint(to_bullet(p), false);
      hull->recalcLocalAabb();
      add_rigid(std::move(hull), 0, obstacle.position, scene.friction);
    }
    for (const demos::SoftBodyPlacement& placement : scene.soft_bodies) add_soft(placement);
  }
  ~BulletFrames() override {
    for (const auto& soft : softs_) world_.removeSoftBody(soft.get());
    for (const auto& rigid : rigids_) world_.removeRigidBody(rigid.get());
  }
  BulletFrames(const BulletFrames&) = delete;
  BulletFrames& operator=(const BulletFrames&) = delete;

  void step() override {
    for (int i = 0; i < substeps_; ++i)
      world_.stepSimulation(kFrameSeconds / static_cast<float>(substeps_), 0);
  }
  std::size_t particles() const override { return nodes_; }
  btDynamicsWorld& world() { return world_; }

 private:
  void add_rigid(std::unique_ptr<btCollisionShape> shape, float mass, const Eigen::Vector3f& position,
                 float friction) {
    SC_ASSERT(mass >= 0 && friction >= 0, "a rigid body of {} kg with friction {}", mass, friction);
    btVector3 inertia(0, 0, 0);
    if (mass > 0) shape->calculateLocalInertia(mass, inertia);
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shape.get(), inertia);
    info.m_startWorldTransform.setOrigin(to_bullet(position));
    info.m_friction = friction;
    shapes_.push_back(std::move(shape));
    world_.addRigidBody(rigids_.emplace_back(std::make_unique<btRigidBody>(info)).get());
  }

  void add_soft(const demos::SoftBodyPlacement& placement) {
    constexpr int kClusters = 8, kIterations = 4;
    const auto model = ppu::make_soft_body_model(placement.mesh, placement.settings);
    const ppu::Lattice<3>& lattice = model->lattice();
    std::vector<btVector3> at;
    for (std::size_t i = 0; i < lattice.particles.size(); ++i)
      at.push_back(to_bullet(placement.position + lattice.rest_position(i)));
    auto soft =
        std::make_unique<btSoftBody>(&info_, static_cast<int>(at.size()), at.data(), model->masses().data());
    append_links(lattice, *soft);
    soft->m_cfg.collisions = btSoftBody::fCollision::CL_SS | btSoftBody::fCollision::CL_RS;
    soft->m_cfg.kDP = placement.settings.damping;
    soft->m_cfg.kMT = placement.settings.alpha;
    soft->m_cfg.kDF = placement.settings.friction;
    soft->m_cfg.piterations = kIterations;
    soft->setPose(false, true);
    soft->generateClusters(kClusters);
    nodes_ += at.size();
    world_.addSoftBody(soft.get());
    softs_.push_back(std::move(soft));
  }

  btSoftBodyRigidBodyCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btSoftRigidDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  btSoftBodyWorldInfo info_;
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> rigids_;
  std::vector<std::unique_ptr<btSoftBody>> softs_;
  std::size_t nodes_ = 0;
  int substeps_;
};

std::chrono::nanoseconds processor_time_of_all_threads() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec);
}

/// A floor of triangles, of which about 0.6 m x 0.6 m are near a body.
class TriangleFloor {
 public:
  /// @param edge  metres, of the squares, each of which is two triangles
  explicit TriangleFloor(float edge) {
    constexpr float kHalf = 1.2f;  // metres
    const int count = static_cast<int>(2 * kHalf / edge);
    const auto at = [&](int i, int j) {
      return btVector3(edge * static_cast<float>(i) - kHalf, 0, edge * static_cast<float>(j) - kHalf);
    };
    for (int i = 0; i < count; ++i) {
      for (int j = 0; j < count; ++j) {
        triangles_.addTriangle(at(i, j), at(i, j + 1), at(i + 1, j + 1));
        triangles_.addTriangle(at(i, j), at(i + 1, j + 1), at(i + 1, j));
      }
    }
    shape_ = std::make_unique<btBvhTriangleMeshShape>(&triangles_, true);
    btRigidBody::btRigidBodyConstructionInfo info(0, nullptr, shape_.get());
    info.m_friction = 1;
    body_ = std::make_unique<btRigidBody>(info);
  }
  btRigidBody& body() { return *body_; }

 private:
  btTriangleMesh triangles_;
  std::unique_ptr<btBvhTriangleMeshShape> shape_;
  std::unique_ptr<btRigidBody> body_;
};

demos::Scene one_penguin() {
  demos::Scene scene = demos::load_scene_3d("penguins");
  scene.soft_bodies.resize(1);
  scene.soft_bodies[0].position = {0, 0.6f, 0};
  scene.boxes.clear();
  scene.obstacles.clear();
  return scene;
}

/// A body that falls on the floor and lies there; nothing is skinned.
class OurMeshFrames final : public Frames {
 public:
  OurMeshFrames(float edge, ppu::ContactMethod contacts)
      : floor_(edge), soft_bodies_(world_.world(), spes_, contacts) {
    const demos::Scene scene = one_penguin();
    const demos::SoftBodyPlacement& placement = scene.soft_bodies[0];
    world_.world().addRigidBody(&floor_.body());
    soft_bodies_.add(ppu::make_soft_body_model(placement.mesh, placement.settings), placement.position);
  }
  ~OurMeshFrames() override { world_.world().removeRigidBody(&floor_.body()); }
  OurMeshFrames(const OurMeshFrames&) = delete;
  OurMeshFrames& operator=(const OurMeshFrames&) = delete;

  void step() override { world_.step(kFrameSeconds, 2); }
  std::size_t particles() const override { return soft_bodies_[0].model().particles(); }

 private:
  TriangleFloor floor_;
  ppu::SpeRuntime spes_;
  ppu::BulletWorld world_;
  ppu::BulletSoftBodies soft_bodies_;
};

/// The same with Bullet's soft body.
class BulletMeshFrames final : public Frames {
 public:
  explicit BulletMeshFrames(float edge) : floor_(edge), frames_(one_penguin()) {
    frames_.world().addRigidBody(&floor_.body());
  }
  ~BulletMeshFrames() override { frames_.world().removeRigidBody(&floor_.body()); }
  BulletMeshFrames(const BulletMeshFrames&) = delete;
  BulletMeshFrames& operator=(const BulletMeshFrames&) = delete;

  void step() override { frames_.step(); }
  std::size_t particles() const override { return frames_.particles(); }

 private:
  TriangleFloor floor_;
  BulletFrames frames_;
};

// About 1,000 triangles in the box around the body, and about 10.
constexpr float kFineEdge = 0.027f, kCoarseEdge = 0.6f;
constexpr ContactCase kMeshCases[] = {{"mesh", "", 1, 40, 160}, {"coarse_mesh", "", 1, 40, 160}};

using MakeFrames = std::function<std::unique_ptr<Frames>()>;

/// Runs the frames of a case again and again; only the measured frames count.
class Cycle {
 public:
  Cycle(const ContactCase& of, MakeFrames make) : case_(of), make_(std::move(make)) { begin(); }

  std::size_t particles() const { return frames_->particles(); }
  std::chrono::nanoseconds spent() const { return spent_; }
  void run() {
    if (frame_ + kFramesOfRun > case_.last_frame) begin();
    const auto before = processor_time_of_all_threads();
    for (int i = 0; i < kFramesOfRun; ++i) frames_->step();
    spent_ += processor_time_of_all_threads() - before;
    frame_ += kFramesOfRun;
  }

 private:
  void begin() {
    frames_.reset();
    frames_ = make_();
    for (frame_ = 0; frame_ < case_.first_frame; ++frame_) frames_->step();
  }

  ContactCase case_;
  MakeFrames make_;
  std::unique_ptr<Frames> frames_;
  int frame_ = 0;
  std::chrono::nanoseconds spent_{0};
};

void add_case(std::vector<Benchmark>& all, const ContactCase& of, const char* who, MakeFrames make) {
  all.push_back({fmt::format("contact/{}/{}", of.name, who), [=] {
                   const auto cycle = std::make_shared<Cycle>(of, make);
                   return Work{.items = cycle->particles() * kFramesOfRun,
                               .run = [=] { cycle->run(); },
                               .spent = [=] { return cycle->spent(); }};
                 }});
}

}  // namespace

void add_contact_benchmarks(std::vector<Benchmark>& all) {
  for (const ContactCase& of : kCases) {
    add_case(all, of, "ours",
             [=] { return std::make_unique<OurFrames>(scene_of(of), ppu::ContactMethod::kSurface); });
    add_case(all, of, "spheres",
             [=] { return std::make_unique<OurFrames>(scene_of(of), ppu::ContactMethod::kSpheres); });
    add_case(all, of, "btsoftbody", [=] { return std::make_unique<BulletFrames>(scene_of(of)); });
  }
  for (const ContactCase& of : kMeshCases) {
    const float edge = &of == &kMeshCases[0] ? kFineEdge : kCoarseEdge;
    add_case(all, of, "ours",
             [=] { return std::make_unique<OurMeshFrames>(edge, ppu::ContactMethod::kSurface); });
    add_case(all, of, "spheres",
             [=] { return std::make_unique<OurMeshFrames>(edge, ppu::ContactMethod::kSpheres); });
    add_case(all, of, "btsoftbody", [=] { return std::make_unique<BulletMeshFrames>(edge); });
  }
}

}  // namespace softcell::tool
