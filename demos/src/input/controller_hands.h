#pragma once
// The user's two hands on a game controller: each has a trigger and a stick.

#include <SDL.h>

#include <Eigen/Core>
#include <array>
#include <type_traits>
#include <vector>

#include "input_event.h"
#include "mouse_hand.h"
#include "mouse_reach.h"
#include "scene/look.h"

namespace softcell::demos {

/// The deflection of a controller's stick, -1..1; 0 if nobody touches it.
float stick_share(Sint16 value);

/// Touching a trigger shows its hand, which the stick of the same side moves over the window. Pressing the trigger makes the hand take what
/// is there; letting it go throws that. In three dimensions the directional pad moves the held thing farther and nearer. One thread uses
/// it.
template <int Dimension>
class ControllerHands {
 public:
  using Pointer = std::conditional_t<Dimension == 2, MouseHand, MouseReach>;

  static constexpr float kTouched = 0.05f, kTakes = 0.6f, kLetsGo = 0.4f;  ///< fractions of the travel
  /// Window heights per frame when the stick is pushed all the way.
  static constexpr float kSpeed = 1.2f / 60;

  /// @param mouse  how a pointer takes and moves things
  explicit ControllerHands(const Pointer& mouse);

  /// @return true: a hand has used the event
  bool handle(const SDL_Event& event);
  /// Appends what the hands do in this frame, and shows them in `look`.
  void next_frame(Look& look, std::vector<InputEvent<Dimension>>& events);
  /// Each hand that holds something pins it.
  void pin(std::vector<InputEvent<Dimension>>& events) const;

 private:
  struct Hand {
    Pointer pointer;
    Eigen::Vector2f begins;  // where it appears, in fractions of the window
    Eigen::Vector2f at;
    Eigen::Vector2f stick{0, 0};
    float trigger = 0;
    bool is_closed = false;
  };
  bool handle_axis(const SDL_ControllerAxisEvent& axis);
  bool handle_pad(const SDL_ControllerButtonEvent& button);
  void move(Hand& hand, const Look& look, std::vector<InputEvent<Dimension>>& events) const;

  std::array<Hand, 2> hands_;       // left, right
  float farther_ = 0, nearer_ = 0;  // 1: this side of the pad is pressed
};

extern template class ControllerHands<2>;
extern template class ControllerHands<3>;

}  // namespace softcell::demos
