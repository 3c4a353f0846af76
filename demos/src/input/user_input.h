#pragma once
// Turns the events of a window into events of the next frame, a view, and requests (quit, next scene). Works without a window, for tests.

#include <SDL.h>

#include <span>
#include <utility>
#include <vector>

#include "camera_control.h"
#include "controller_hands.h"
#include "ground_tilt.h"
#include "input_event.h"
#include "key_bindings.h"
#include "knife.h"
#include "mouse_hand.h"
#include "mouse_reach.h"
#include "scene/look.h"
#include "scene/scene_2d.h"
#include "softcell/base/assert.h"

namespace softcell::demos {

/// The part that does not depend on the number of dimensions. Used by one thread.
class WindowInput {
 public:
  explicit WindowInput(int views) : views_(views) { SC_ASSERT(views > 0, "{} views", views); }
  virtual ~WindowInput() = default;

  virtual void handle(const SDL_Event& event) = 0;
  /// Does what the command's key would do.
  virtual void do_now(Command command) = 0;
  /// Appends an action with a number: see kNumbers. If one thing changes several times in a frame, the last change counts.
  virtual void change(Action action, std::uint32_t body, float value) = 0;
  /// Keeps the direction of gravity. @param strength  m/s^2, not negative
  virtual void set_strength_of_gravity(float strength) = 0;

  const Look& look() const { return look_; }
  void set_look(const Look& look) { look_ = look; }
  /// Moves a camera that follows a body nearer to where it should be. @param wanted  metres, value of Look::followed
  void follow_body(const Eigen::Vector3f& wanted) {
    constexpr float kPartOfWay = 0.12f;  // per frame: the picture does not shake when the body does
    look_.followed += kPartOfWay * (wanted - look_.followed);
  }
  bool wants_to_quit() const { return quit_; }
  bool wants_next_scene() const { return next_scene_; }
  /// Whether the user has asked to save the scene. Reading it clears the request.
  bool poll_save() { return std::exchange(save_, false); }
  /// Whether the user has asked to remove the body that was held last. Reading it clears the request.
  bool poll_remove() { return std::exchange(remove_, false); }
  /// Whether hands have pinned what they hold. Reading it clears this.
  bool poll_pinned() { return std::exchange(pinned_, false); }

 protected:
  /// Handles a command that concerns the window. @return  whether it did.
  bool handle_command(Command command);

  Look look_;
  bool pinned_ = false;

 private:
  int views_;
  bool quit_ = false, next_scene_ = false, save_ = false, remove_ = false;
};

/// The pointing devices: the mouse, which is a hand or a knife, and in three dimensions the controls that tilt the ground. There the mouse
/// moves the camera while it holds nothing.
template <int Dimension>
struct Pointing;
template <>
struct Pointing<2> {
  MouseHand hand;
  Knife<2> knife = {};
};
template <>
struct Pointing<3> {
  GroundTilt tilt;
  Knife<3> knife;
  MouseReach hand;
  CameraControl camera;
};

template <int Dimension>
class UserInput final : public WindowInput {
 public:
  using Event = InputEvent<Dimension>;
  using Vector = typename Event::Vector;

  static constexpr float kJumpSpeed = 5;         ///< m/s
  static constexpr float kGravityStep = 1;       ///< m/s^2 per key press
  static constexpr float kMostGravity = 1000;    ///< m/s^2
  static constexpr float kUsualGravity = 9.81f;  ///< m/s^2, when gravity is switched on and there was none

  UserInput(int views, const Pointing<Dimension>& pointing)
      : WindowInput(views), pointing_(pointing), hands_(pointing.hand) {}

  /// Takes over the state of the simulation: keys that change gravity or pause start from there.
  void follow(const Vector& gravity, bool paused);

  void handle(const SDL_Event& event) override;
  void do_now(Command command) override {
    if (!handle_command(command)) do_command(command);
  }
  void change(Action action, std::uint32_t body, float value) override;
  void set_strength_of_gravity(float strength) override {
    set_gravity(gravity_when_on_.normalized() * strength);
  }

  /// The events since the previous frame. Valid until the next call.
  std::span<const Event> next_frame();

 private:
  void do_command(Command command);
  void pin_or_unpin();
  void set_gravity(const Vector& gravity);
  void add_gravity(float more);

  Pointing<Dimension> pointing_;
  ControllerHands<Dimension> hands_;
  Vector gravity_ = Vector::Unit(1) * -kUsualGravity;
  Vector gravity_when_on_ = gravity_;  // not 0: gravity when it is switched on again
  bool paused_ = false;
  std::vector<Event> coming_, frame_;
};

extern template class UserInput<2>;
extern template class UserInput<3>;

}  // namespace softcell::demos
