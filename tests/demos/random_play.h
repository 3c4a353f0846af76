#pragma once
// Ten seconds of somebody who does not spare the man: what he does, and whether anything left the framework.

#include <algorithm>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "input/input_event.h"
#include "scene/scene_2d.h"
#include "simulation/simulation_2d.h"

namespace softcell::demos::test {

inline constexpr int kTenSeconds = 600;  // frames

inline InputEvent<2> users_hand(Action action, const Eigen::Vector2f& at = {0, 0}) {
  return {.action = action, .hand = kUsersHand, .body = kEveryBody, .value = at};
}

/// The same input for the same seed, with every library.
class RandomPlay {
 public:
  /// @param gravity  m/s^2: downwards at first, and at most so much along each axis whenever it changes
  RandomPlay(std::uint32_t seed, float gravity) : random_(seed), gravity_(gravity) {}

  /// What happens at the beginning of the next frame.
  std::vector<InputEvent<2>> next_frame() {
    std::vector<InputEvent<2>> events;
    if (std::exchange(first_, false)) events.push_back({.action = Action::kGravity, .value = {0, -gravity_}});
    switch (random_() % 32) {
      case 0:
        events.push_back(users_hand(Action::kGrab, point()));
        break;
      case 1:
        events.push_back(users_hand(Action::kRelease));
        break;
      case 2:
        events.push_back({.action = Action::kGravity, .value = up_to(gravity_, gravity_)});
        break;
      case 3:
        events.push_back({.action = Action::kPush, .body = kEveryBody, .value = up_to(50, 50)});
        break;
      case 4:
        if (random_() % 8 == 0)
          events.push_back({.action = random_() % 2 == 0 ? Action::kReset : Action::kHome, .body = 0});
        break;
      default:
        if (random_() % 4 == 0) events.push_back(users_hand(Action::kMoveHand, point()));
    }
    return events;
  }

 private:
  Eigen::Vector2f up_to(float x_limit, float y_limit) {
    const auto share = [&] { return static_cast<float>(random_() >> 8) / float{1 << 23} - 1; };
    const float x = share(), y = share();
    return {x * x_limit, y * y_limit};
  }
  Eigen::Vector2f point() { return up_to(8, 6); }  // the hand goes outside, too

  std::mt19937 random_;
  float gravity_;
  bool first_ = true;
};

/// The farthest that any particle or rigid body's centre is outside of the room of the scene `man`, in
/// metres; below 0: inside.
inline float outside(const Simulation2d& simulation, const Scene2d& scene) {
  const Eigen::Vector2f room{4, 3};  // the framework's inner sides
  float farthest = -room.minCoeff();
  const auto look = [&](const Eigen::Vector2f& p) {
    farthest = std::max(farthest, (p.cwiseAbs() - room).maxCoeff());
  };
  for (std::size_t b = 0; b < simulation.soft_bodies(); ++b) {
    for (const Eigen::Vector2f& p : simulation.soft_body(b).positions()) look(p);
  }
  for (std::size_t b = 0; b < scene.rigid_bodies.size(); ++b) {
    if (scene.rigid_bodies[b].mass > 0) look(simulation.rigid_pose(b).position);
  }
  return farthest;
}

}  // namespace softcell::demos::test
