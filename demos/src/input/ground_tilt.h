#pragma once
// The ways in which the user tilts the ground of a scene in three dimensions: arrow keys, a controller's left stick, and its motion sensor.
// They add up.

#include <SDL.h>

#include <Eigen/Core>
#include <optional>

namespace softcell::demos {

/// Angles are in radians: about x (below 0: the far side is lower) and about z (below 0: the right side is).
class GroundTilt {
 public:
  static constexpr float kMost = 0.35f;          ///< about either axis: 20 degrees
  static constexpr float kMostInAFrame = 0.03f;  ///< limits how fast the tilt changes

  void handle(const SDL_Event& event);

  /// Call it when the stick starts to do something else.
  void let_go_of_stick() { stick_.setZero(); }

  /// Makes the ground level again, until the user does something.
  void forget();

  /// (about x, 0, about z) for the frame that begins. None: unchanged since the previous frame, or the scene's own.
  std::optional<Eigen::Vector3f> next_frame();

 private:
  void handle_key(const SDL_KeyboardEvent& key);
  void handle_axis(const SDL_ControllerAxisEvent& axis);
  void handle_sensor(const SDL_ControllerSensorEvent& sensor);

  struct Arrows {
    float left = 0, right = 0, away = 0, near = 0;
  } held_;                        // 1: the key is down
  Eigen::Vector2f stick_{0, 0};   // -1..1: to the right, towards the user
  Eigen::Vector2f sensor_{0, 0};  // angles
  Eigen::Vector2f angles_{0, 0};  // about x, about z
};

}  // namespace softcell::demos
