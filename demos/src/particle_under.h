#pragma once

#include <Eigen/Core>
#include <optional>

#include "scene_camera.h"
#include "simulation_3d.h"

namespace softcell::demos {

/// The particle that one sees along a ray: of those that it passes within 0.6 cells, so that it cannot slip
/// through a body, the nearest to its beginning. None: the ray meets no soft body.
std::optional<Eigen::Vector3f> particle_under(const Ray& ray, const Simulation3d& simulation);

}  // namespace softcell::demos
