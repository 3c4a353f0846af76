#include "controller_hands.h"

#include <algorithm>
#include <cmath>

namespace softcell::demos {
namespace {

using Eigen::Vector2f;
using Eigen::Vector2i;

constexpr float kNotchesPerFrame = 0.25f;  // of the mouse's wheel

}  // namespace

float stick_share(Sint16 value) {
  constexpr float kDeadZone = 0.15f;  // of a stick that nobody touches
  const float share = std::clamp(static_cast<float>(value) / 32767, -1.0f, 1.0f);
  return std::abs(share) < kDeadZone ? 0 : share;
}

template <int Dimension>
ControllerHands<Dimension>::ControllerHands(const Pointer& mouse)
    : hands_{Hand{.pointer = mouse.for_hand(kUsersLeftHand), .begins = {0.4f, 0.5f}, .at = {0.4f, 0.5f}},
             Hand{.pointer = mouse.for_hand(kUsersRightHand), .begins = {0.6f, 0.5f}, .at = {0.6f, 0.5f}}} {}

template <int Dimension>
bool ControllerHands<Dimension>::handle(const SDL_Event& event) {
  switch (event.type) {
    case SDL_CONTROLLERAXISMOTION:
      return handle_axis(event.caxis);
    case SDL_CONTROLLERBUTTONDOWN:
    case SDL_CONTROLLERBUTTONUP:
      return handle_pad(event.cbutton);
    case SDL_CONTROLLERDEVICEREMOVED:
      for (Hand& hand : hands_) hand.stick.setZero(), hand.trigger = 0;
      farther_ = nearer_ = 0;
      return false;
    case SDL_WINDOWEVENT: {
      std::vector<InputEvent<Dimension>> none;  // a window's size makes no event of a hand
      for (Hand& hand : hands_) hand.pointer.handle(event, {}, none);
      return false;
    }
    default:
      return false;
  }
}

template <int Dimension>
bool ControllerHands<Dimension>::handle_axis(const SDL_ControllerAxisEvent& axis) {
  Hand &left = hands_[0], &right = hands_[1];
  switch (axis.axis) {
    case SDL_CONTROLLER_AXIS_TRIGGERLEFT:
      left.trigger = static_cast<float>(axis.value) / 32767;
      return true;
    case SDL_CONTROLLER_AXIS_TRIGGERRIGHT:
      right.trigger = static_cast<float>(axis.value) / 32767;
      return true;
    case SDL_CONTROLLER_AXIS_LEFTX:
      left.stick.x() = stick_share(axis.value);
      return left.trigger > kTouched;  // otherwise it tilts the ground
    case SDL_CONTROLLER_AXIS_LEFTY:
      left.stick.y() = stick_share(axis.value);
      return left.trigger > kTouched;
    case SDL_CONTROLLER_AXIS_RIGHTX:
      right.stick.x() = stick_share(axis.value);
      return true;
    case SDL_CONTROLLER_AXIS_RIGHTY:
      right.stick.y() = stick_share(axis.value);
      return true;
    default:
      return false;
  }
}

/// In two dimensions the pad sets the direction of gravity instead.
template <int Dimension>
bool ControllerHands<Dimension>::handle_pad(const SDL_ControllerButtonEvent& button) {
  if (Dimension == 2) return false;
  const float pressed = button.type == SDL_CONTROLLERBUTTONDOWN ? 1 : 0;
  if (button.button == SDL_CONTROLLER_BUTTON_DPAD_UP) farther_ = pressed;
  if (button.button == SDL_CONTROLLER_BUTTON_DPAD_DOWN) nearer_ = pressed;
  return button.button == SDL_CONTROLLER_BUTTON_DPAD_UP || button.button == SDL_CONTROLLER_BUTTON_DPAD_DOWN;
}

template <int Dimension>
void ControllerHands<Dimension>::next_frame(Look& look, std::vector<InputEvent<Dimension>>& events) {
  for (std::size_t side = 0; side < hands_.size(); ++side) {
    Hand& hand = hands_[side];
    if (hand.trigger > kTouched) {
      move(hand, look, events);
    } else {
      hand.at = hand.begins;
    }
    if (hand.trigger < kLetsGo) {
      hand.is_closed = false;
      if (hand.pointer.holds()) hand.pointer.let_go(events);
    }
    look.hands[side].reset();
    if (hand.trigger > kTouched)
      look.hands[side] = PointingHand{.at = hand.at, .holds = hand.pointer.holds()};
  }
}

template <int Dimension>
void ControllerHands<Dimension>::move(Hand& hand, const Look& look,
                                      std::vector<InputEvent<Dimension>>& events) const {
  const Vector2f size = hand.pointer.window_size().template cast<float>();
  const Vector2f step = kSpeed * hand.stick.cwiseProduct(Vector2f(size.y() / size.x(), 1));
  hand.at = (hand.at + step).cwiseMax(0.0f).cwiseMin(1.0f);
  const Vector2i pixel = hand.at.cwiseProduct(size).template cast<int>();
  if (hand.trigger >= kTakes && !hand.is_closed) {
    hand.is_closed = true;  // so that it does not take what passes by later
    hand.pointer.grab(pixel.x(), pixel.y(), look, events);
  } else if (hand.pointer.holds()) {
    hand.pointer.move_to(pixel.x(), pixel.y(), look, events);
    if constexpr (Dimension == 3) {
      const float notches = kNotchesPerFrame * (farther_ - nearer_);
      if (notches != 0) hand.pointer.move_away(notches, look, events);
    }
  }
}

template <int Dimension>
void ControllerHands<Dimension>::pin(std::vector<InputEvent<Dimension>>& events) const {
  for (const Hand& hand : hands_)
    if (hand.pointer.holds()) hand.pointer.pin(events);
}

template class ControllerHands<2>;
template class ControllerHands<3>;

}  // namespace softcell::demos
