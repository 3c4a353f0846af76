#pragma once
// Does what a scene's script says, frame by frame. For soft bodies of either dimension.

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "scripted_input.h"

namespace softcell::demos {

/// Used by one thread; allocates nothing after construction.
template <int Dimension>
class ScriptPlayer {
 public:
  using Vector = Eigen::Matrix<float, Dimension, 1>;

  explicit ScriptPlayer(const ScriptedInput<Dimension>& script)
      : script_(script), impulse_given_(script.impulses.size()), held_(script.drags.size()) {}

  /// The gravity at `time`, in m/s^2: the last change's, or `initial` before the first.
  float gravity_at(double time, float initial) const {
    float gravity = initial;
    double latest = -1;
    for (const GravityChange& change : script_.gravity) {
      if (double{change.time} <= time && double{change.time} >= latest) {
        gravity = change.gravity;
        latest = double{change.time};
      }
    }
    return gravity;
  }

  /// What happens at the beginning of the frame at `time` seconds.
  /// @param body  body(number) is that soft body: it has positions(), velocities(), add_velocity() and
  /// add_particle_velocity().
  template <class BodyOf>
  void act(double time, BodyOf body) {
    for (std::size_t i = 0; i < script_.impulses.size(); ++i) {
      const auto& impulse = script_.impulses[i];
      if (impulse_given_[i] || time < double{impulse.time}) continue;
      impulse_given_[i] = true;
      body(impulse.body).add_velocity(impulse.velocity);
    }
    for (std::size_t i = 0; i < script_.drags.size(); ++i) drag(i, time, body);
  }

 private:
  static constexpr float kReach = 0.05f;  // seconds in which a held particle would be where the hand is

  struct Held {
    bool taken = false;
    std::size_t particle = 0;
  };

  template <class BodyOf>
  void drag(std::size_t i, double time, BodyOf body_of) {
    const auto& drag = script_.drags[i];
    if (time < double{drag.begin} || time >= double{drag.end}) return;
    auto& body = body_of(drag.body);
    Held& held = held_[i];
    if (!held.taken) held = {true, nearest(body.positions(), drag.from)};
    const auto share =
        static_cast<float>((time - double{drag.begin}) / (double{drag.end} - double{drag.begin}));
    const Vector hand = drag.from + share * (drag.to - drag.from);
    const Vector wanted = (hand - position(body.positions()[held.particle])) / kReach;
    body.add_particle_velocity(held.particle, wanted - Vector(body.velocities()[held.particle]));
  }

  /// Of a particle: in 3D it is a corner of the skinning job, in 2D a vector.
  template <class Particle>
  static Vector position(const Particle& p) {
    if constexpr (Dimension == 3) {
      return {p.x, p.y, p.z};
    } else {
      return p;
    }
  }

  template <class Positions>
  static std::size_t nearest(const Positions& positions, const Vector& point) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < positions.size(); ++i) {
      if ((position(positions[i]) - point).squaredNorm() < (position(positions[best]) - point).squaredNorm())
        best = i;
    }
    return best;
  }

  const ScriptedInput<Dimension>& script_;
  std::vector<bool> impulse_given_;
  std::vector<Held> held_;
};

}  // namespace softcell::demos
