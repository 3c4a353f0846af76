#pragma once
// Hands that hold particles of soft bodies, in either dimension, and pull them.

#include <Eigen/Core>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "input_event.h"
#include "softcell/base/assert.h"

namespace softcell::demos {

/// One thread uses it. `Bodies` has size() and operator[], which returns a SoftBody<Dimension>.
template <int Dimension>
class Hands {
 public:
  using Event = InputEvent<Dimension>;
  using Vector = typename Event::Vector;

  template <class Bodies>
  void grab(const Event& event, const Bodies& bodies) {
    release(event.hand);
    if (const auto nearest = nearest_particle(event, bodies))
      held_.push_back({event.hand, nearest->body, nearest->particle, event.value});
  }

  struct Particle {
    std::size_t body, particle;
  };
  /// The particle of the event's body, or of every body, that is nearest to the event's value. None: there is no such body.
  template <class Bodies>
  static std::optional<Particle> nearest_particle(const Event& event, const Bodies& bodies) {
    std::optional<Particle> nearest;
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (event.body != kEveryBody && event.body != b) continue;
      const auto positions = bodies[b].positions();
      for (std::size_t i = 0; i < positions.size(); ++i) {
        const float distance = (positions[i] - event.value).squaredNorm();
        if (distance < least) least = distance, nearest = Particle{b, i};
      }
    }
    return nearest;
  }

  void move(const Event& event) {
    for (Held& held : held_) {
      if (held.hand == event.hand) held.target = event.value;
    }
  }

  void release(std::uint32_t hand) {
    std::erase_if(held_, [hand](const Held& held) { return held.hand == hand; });
  }
  void release_all() { held_.clear(); }
  /// Call it when the body has broken or is gone, because its particles are then others.
  void forget_body(std::size_t body) {
    std::erase_if(held_, [body](const Held& held) { return held.body == body; });
  }

  /// Call it when bodies have broken. @param follow  takes a held body and particle, changes them to the present ones, and returns whether
  /// they still exist: a hand lets go of what has vanished
  template <class Follow>
  void follow_particles(const Follow& follow) {
    for (auto held = held_.begin(); held != held_.end();)
      held = follow(held->body, held->particle) ? held + 1 : held_.erase(held);
  }

  /// A held particle. `target` is where the hand is.
  struct Held {
    std::uint32_t hand;
    std::size_t body, particle;
    Vector target;
  };
  const std::vector<Held>& held() const { return held_; }

  /// Sets the velocity of each held particle so that it reaches its hand in kReachSeconds. Call it before each step, because the rest of
  /// the body pulls the particle back meanwhile.
  template <class Bodies>
  void pull(Bodies& bodies) const {
    for (const Held& held : held_) {
      SC_ASSERT(held.body < bodies.size(), "hand {} holds body {} of {}", held.hand, held.body,
                bodies.size());
      auto& body = bodies[held.body];
      SC_ASSERT(held.particle < body.positions().size(), "hand {} holds particle {} of {}", held.hand,
                held.particle, body.positions().size());
      const Vector wanted = (held.target - body.positions()[held.particle]) / kReachSeconds;
      body.add_particle_velocity(held.particle, wanted - body.velocities()[held.particle]);
    }
  }

 private:
  static constexpr float kReachSeconds = 0.05f;

  std::vector<Held> held_;
};

}  // namespace softcell::demos
