#pragma once
// The user's two hands at a game controller: each has a trigger and a stick.

#include <SDL.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "input_event.h"
#include "mouse_hand.h"
#include "mouse_reach.h"
#include "scene/look.h"

namespace softcell::demos {

/// Where a controller's stick is, -1..1; 0 if nobody touches it.
float stick_share(Sint16 value);

/// A trigger that is touched shows its hand, which the stick of the same side moves over the window. Pressed, it takes what is there;
/// let go, it throws it. In three dimensions the directional pad moves what is held farther and nearer. One thread uses it.
template <int Dimension>
class ControllerHands {
 public:
  using Pointer = std::conditional_t<Dimension == 2, MouseHand, MouseReach>;

  static constexpr float kTouched = 0.05f, kTakes = 0.6f, kLetsGo = 0.4f;  ///< shares of a trigger's way
  /// Heights of the window in a frame, when the stick is pushed all the way.
  static constexpr float kSpeed = 1.2f / 60;

  /// @param mouse  how a pointer takes and moves things
  explicit ControllerHands(const Pointer& mouse);

  /// @return true: the event is a hand's
  bool handle(const SDL_Event& event);
  /// Appends what the hands do in a frame, and shows them.
  void next_frame(Look& look, std::vector<InputEvent<Dimension>>& events);
  /// Each hand that holds something pins it.
  void pin(std::vector<InputEvent<Dimension>>& events) const;

 private:
  struct Hand {
    Pointer pointer;
    Eigen::Vector2f begins;  // shares of the window, where it appears
    Eigen::Vector2f at;
    Eigen::Vector2f stick{0, 0};
    float trigger = 0;
    bool is_closed = false;
  };
  bool handle_axis(const SDL_ControllerAxisEvent& axis);
  bool handle_pad(const SDL_ControllerButtonEvent& button);
  void move(Hand& hand, const Look& look, std::vector<InputEvent<Dimension>>& events) const;

  std::array<Hand, 2> hands_;       // left, right
  float farther_ = 0, nearer_ = 0;  // 1: the pad is pressed so
};

extern template class ControllerHands<2>;
extern template class ControllerHands<3>;

}  // namespace softcell::demos
