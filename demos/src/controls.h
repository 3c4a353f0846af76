#pragma once
// What events have made of a run: its gravity, who holds what, whether time stands still.

#include <span>

#include "hands.h"
#include "input_event.h"

namespace softcell::demos {

/// Used by one thread. What only the simulation can do, it is asked to do: see take().
template <int Dimension>
class Controls {
 public:
  using Event = InputEvent<Dimension>;
  using Vector = typename Event::Vector;

  explicit Controls(const Vector& gravity) : initial_gravity_(gravity), gravity_(gravity) {}

  /// Does what the events say, in their order.
  /// @param bodies  the soft bodies: see Hands
  /// @param reset   reset() makes bodies and world what they were at the beginning
  template <class Bodies, class Reset>
  void take(std::span<const Event> events, Bodies& bodies, const Reset& reset) {
    for (const Event& event : events) {
      switch (event.action) {
        case Action::kGrab:
          hands_.grab(event, bodies);
          break;
        case Action::kMoveHand:
          hands_.move(event);
          break;
        case Action::kRelease:
          hands_.release(event.hand);
          break;
        case Action::kPush:
          for (std::size_t b = 0; b < bodies.size(); ++b) {
            if (event.body == kEveryBody || event.body == b) bodies[b].add_velocity(event.value);
          }
          break;
        case Action::kGravity:
          gravity_ = event.value;
          break;
        case Action::kReset:
          hands_.release_all();
          gravity_ = initial_gravity_;
          reset();
          break;
        case Action::kPause:
          paused_ = true;
          break;
        case Action::kResume:
          paused_ = false;
          break;
        case Action::kSingleStep:
          single_step_ = true;
          break;
      }
    }
  }

  /// Whether time goes on for a frame. A single step is used up by asking.
  bool advance() {
    const bool goes_on = !paused_ || single_step_;
    single_step_ = false;
    return goes_on;
  }

  const Vector& gravity() const { return gravity_; }  ///< m/s^2
  const Hands<Dimension>& hands() const { return hands_; }
  bool paused() const { return paused_; }

 private:
  Hands<Dimension> hands_;
  Vector initial_gravity_, gravity_;
  bool paused_ = false, single_step_ = false;
};

}  // namespace softcell::demos
