#pragma once
// How the ground of a scene in three dimensions is tilted. The ground does not move; gravity and the observer turn against it.

#include <Eigen/Core>

#include "scene/scene.h"

namespace softcell::demos {

/// The rotation from the ground's frame to the observer's: first about x, then about z. Radians.
Eigen::Matrix3f tilted_by(double about_x, double about_z);

/// The same for the tilt that a scene's script has reached. @param time  seconds
Eigen::Matrix3f tilt_at(const TiltScript& script, double time);

}  // namespace softcell::demos
