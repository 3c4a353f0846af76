#pragma once
// What happens to a scene at times that its file states. Dimension: 2 or 3.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace softcell::demos {

/// Adds a velocity to all particles of a soft body at once.
template <int Dimension>
struct ScriptedImpulse {
  float time = 0;        ///< seconds
  std::size_t body = 0;  ///< number of the soft body
  Eigen::Matrix<float, Dimension, 1> velocity = Eigen::Matrix<float, Dimension, 1>::Zero();  ///< m/s, added
};

/// A hand takes the particle nearest to `from`, moves to `to` at constant speed, and lets go.
template <int Dimension>
struct ScriptedDrag {
  float begin = 0, end = 0;  ///< seconds
  std::size_t body = 0;      ///< number of the soft body
  Eigen::Matrix<float, Dimension, 1> from = Eigen::Matrix<float, Dimension, 1>::Zero();  ///< metres
  Eigen::Matrix<float, Dimension, 1> to = Eigen::Matrix<float, Dimension, 1>::Zero();    ///< metres
};

struct GravityChange {
  float time = 0;     ///< seconds
  float gravity = 0;  ///< m/s^2 downwards, from then on
};

/// Simulated time stands still; the time of the script goes on.
struct ScriptedPause {
  float begin = 0, end = 0;  ///< seconds
};

template <int Dimension>
struct ScriptedInput {
  std::vector<ScriptedImpulse<Dimension>> impulses;
  std::vector<ScriptedDrag<Dimension>> drags;
  std::vector<GravityChange> gravity;
  std::vector<ScriptedPause> pauses;
  std::vector<float> resets;  ///< seconds: everything is again as at the beginning; the script goes on
};

}  // namespace softcell::demos
