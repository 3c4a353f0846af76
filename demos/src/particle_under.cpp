#include "particle_under.h"

#include <limits>

namespace softcell::demos {

std::optional<Eigen::Vector3f> particle_under(const Ray& ray, const Simulation3d& simulation) {
  constexpr float kReachInCells = 0.6f;
  std::optional<Eigen::Vector3f> found;
  float nearest = std::numeric_limits<float>::infinity();
  for (std::size_t b = 0; b < simulation.soft_bodies(); ++b) {
    const float reach = kReachInCells * simulation.model(b).lattice().spacing;
    for (const Eigen::Vector3f& particle : simulation.soft_body(b).positions()) {
      const float along = (particle - ray.from).dot(ray.along);
      const float squared = (particle - ray.from - along * ray.along).squaredNorm();
      if (along > 0 && along < nearest && squared < reach * reach) {
        nearest = along;
        found = particle;
      }
    }
  }
  return found;
}

}  // namespace softcell::demos
