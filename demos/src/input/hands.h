#pragma once
// Hands that hold particles of soft bodies of either dimension, and draw them along.

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <vector>

#include "input_event.h"

namespace softcell::demos {

/// Used by one thread. Bodies: has size() and operator[], a SoftBody or a SoftBody<2>.
template <int Dimension>
class Hands {
 public:
  using Event = InputEvent<Dimension>;
  using Vector = typename Event::Vector;

  template <class Bodies>
  void grab(const Event& event, const Bodies& bodies) {
    release(event.hand);
    Held held{.hand = event.hand, .body = 0, .particle = 0, .target = event.value};
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      if (event.body != kEveryBody && event.body != b) continue;
      const auto positions = bodies[b].positions();
      for (std::size_t i = 0; i < positions.size(); ++i) {
        const float distance = (positions[i] - event.value).squaredNorm();
        if (distance < least) least = distance, held.body = b, held.particle = i;
      }
    }
    if (least < std::numeric_limits<float>::infinity()) held_.push_back(held);
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

  /// What is held: for pictures, and for who wants to know. `target` is where the hand is.
  struct Held {
    std::uint32_t hand;
    std::size_t body, particle;
    Vector target;
  };
  const std::vector<Held>& held() const { return held_; }

  /// Gives each held particle the velocity that takes it to its hand in kReachSeconds. Call it before each
  /// step: the rest of the body pulls it back in between.
  template <class Bodies>
  void pull(Bodies& bodies) const {
    for (const Held& held : held_) {
      auto& body = bodies[held.body];
      const Vector wanted = (held.target - body.positions()[held.particle]) / kReachSeconds;
      body.add_particle_velocity(held.particle, wanted - body.velocities()[held.particle]);
    }
  }

 private:
  static constexpr float kReachSeconds = 0.05f;

  std::vector<Held> held_;
};

}  // namespace softcell::demos
