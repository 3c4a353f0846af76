#pragma once
// Small worlds for the tests of soft bodies.

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <vector>

#include "ppu/bullet/bullet_world.h"
#include "softcell/bullet/bullet_soft_bodies.h"
#include "softcell/soft_bodies/lattice.h"
#include "softcell/soft_bodies/soft_body.h"

namespace softcell::ppu {

inline constexpr float kFrame = 1.0f / 60;

/// A block of cells, its lowest particles at y = 0, centred on 0 in x and z. A block of n cells along each
/// edge has (n + 1)^3 particles.
inline std::shared_ptr<const SoftBodyModel<3>> block_model(const Eigen::Vector3i& cells,
                                                           const SoftBodySettings& settings) {
  std::vector<Eigen::Vector3i> all;
  for (int x = 0; x < cells.x(); ++x)
    for (int y = 0; y < cells.y(); ++y)
      for (int z = 0; z < cells.z(); ++z) all.push_back({x, y, z});
  const Eigen::Vector3f size = settings.cell_size * cells.cast<float>();
  const Eigen::Vector3f origin(-size.x() / 2, 0, -size.z() / 2);
  return make_soft_body_model(lattice_from_cells(all, settings.cell_size, origin), settings);
}

/// A Bullet world with soft bodies, and a floor whose top is at y = 0 when asked for.
struct World {
  explicit World(ContactMethod contacts = ContactMethod::kSpheres) : soft(bullet.world(), contacts) {}

  BulletWorld bullet;
  BulletSoftBodies soft;

  void add_floor(float friction = 0.6f) { bullet.add_box({20, 1, 20}, 0, {0, -0.5f, 0}, friction); }
  void run(float seconds, int substeps = 2) {
    const int frames = static_cast<int>(seconds / kFrame + 0.5f);
    for (int i = 0; i < frames; ++i) bullet.step(kFrame, substeps);
  }
};

inline float fastest(const SoftBody<3>& body) {
  float speed = 0;
  for (const Eigen::Vector3f& v : body.velocities()) speed = std::max(speed, v.norm());
  return speed;
}

}  // namespace softcell::ppu
