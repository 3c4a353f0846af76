#pragma once
// A Bullet world with attached soft bodies, which the PPU or SPEs solve. For tests of attachments.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "../particles_where.h"
#include "contact_world.h"
#include "softcell/soft_bodies/attachment.h"
#include "softcell/spe_bodies/spe_runtime.h"

namespace softcell::ppu::attached {

using Eigen::Vector3f;

inline constexpr float kCell = 0.1f;

inline TriangleMesh block(const Vector3f& size) { return make_box(size, kCell); }

inline Vector3f middle_of(const SoftBody<3>& body, const std::vector<std::uint32_t>& particles) {
  Vector3f sum = Vector3f::Zero();
  float mass = 0;
  for (const std::uint32_t i : particles) {
    sum += body.model().masses()[i] * body.position(i);
    mass += body.model().masses()[i];
  }
  return sum / mass;
}

inline Eigen::Vector3d momentum_of(const SoftBody<3>& body) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < body.model().particles(); ++i)
    sum += double{body.model().masses()[i]} * body.velocities()[i].cast<double>();
  return sum;
}

/// The top layer of a block.
inline std::vector<std::uint32_t> top_of(const SoftBody<3>& body) {
  float top = -1e9f;
  for (std::uint32_t i = 0; i < body.model().particles(); ++i)
    top = std::max(top, body.model().lattice().rest_position(i).y());
  return particles_where(body, [&](const Vector3f& p) { return p.y() > top - 0.5f * kCell; });
}

/// The whole body.
inline Patch<3> all_of(const SoftBody<3>& body) {
  return Patch<3>::of_particles(particles_where(body, [](const Vector3f&) { return true; }));
}

inline SoftBodySettings stiff() {
  SoftBodySettings settings = settings_of(kCell, 1, 0.3f);
  settings.half_width = 4;
  return settings;
}

/// The height of its centre, metres.
inline float height_of(const btRigidBody& body) { return body.getWorldTransform().getOrigin().y(); }

enum class Who { kPpu, kSpes };

/// A world whose attachments the PPU solves, or SPEs.
class AttachedWorld {
 public:
  explicit AttachedWorld(Who who, const Vector3f& gravity = {0, -9.81f, 0})
      : spes_(who == Who::kSpes ? std::make_unique<SpeRuntime>(SpeRuntimeOptions{.spes = 1}) : nullptr),
        own_(gravity, spes_.get()) {
    if (who == Who::kPpu) return;
    // Far away so many other attachments that they are worth a job.
    const auto model = make_soft_body_model(block({0.2f, 0.2f, 0.2f}), settings_of(kCell));
    for (int i = 0; i < 16; ++i) {
      SoftBody<3>& held = own_.bodies.add(model, {500 + static_cast<float>(i), 0, 0});
      own_.bodies.attach(held, Patch<3>::of_particles({0, 1, 2, 3}));
    }
  }
  SoftBody<3>& add(const TriangleMesh& mesh, const SoftBodySettings& settings, const Vector3f& position) {
    return own_.add(mesh, settings, position);
  }
  btRigidBody& add(std::unique_ptr<btCollisionShape> shape, float mass, const Vector3f& position) {
    return own_.add(std::move(shape), mass, position);
  }
  void run(int frames, int substeps = 2) { own_.run(frames, substeps); }

 private:
  std::unique_ptr<SpeRuntime> spes_;
  ContactWorld own_;

 public:
  btDiscreteDynamicsWorld& world = own_.world;
  BulletSoftBodies& bodies = own_.bodies;
};

/// Tests with both solvers.
class SolvedByBoth : public ::testing::TestWithParam<Who> {
 public:
  static std::string name(const ::testing::TestParamInfo<Who>& solver) {
    return solver.param == Who::kPpu ? "Ppu" : "Spes";
  }
};
inline const auto kBothSolvers = ::testing::Values(Who::kPpu, Who::kSpes);

}  // namespace softcell::ppu::attached
