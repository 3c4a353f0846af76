#pragma once
// Finds the part of a scene in two dimensions that has moved since the last picture: only that part is redrawn.

#include <Eigen/Geometry>
#include <vector>

#include "scene/scene_2d.h"
#include "simulation/shown.h"

namespace softcell::demos {

/// Used by one thread.
class Moved2d {
 public:
  using Box = Eigen::AlignedBox2f;

  /// @param scene  the scene whose moments are passed to since_last()
  explicit Moved2d(const Scene2d& scene);

  /// A box around everything that has moved since the last call, at its old and at its new place; empty if nothing has. Soft bodies and
  /// hands always count as moving. The first call compares with all bodies at the world's origin.
  /// @param soft_bodies  a box around all soft bodies as they are drawn now; empty: there are none
  Box since_last(const Shown2d& now, const Box& soft_bodies);

 private:
  std::vector<float> radii_;  // of rigid bodies, about their positions
  std::vector<Pose2d> poses_;
  Box restless_;
};

}  // namespace softcell::demos
