#include "user_input.h"
#include "softcell/base/assert.h"

#include <algorithm>
#include <cmath>

namespace softcell::demos {
namespace {

constexpr float kRadiansPerUnit = 0.006f;
constexpr float kMostRise = 1.5f;
constexpr float kPerNotch = 0.9f, kNearest = 0.3f, kFarthest = 3;

/// The mouse moves the camera of three dimensions: dragging turns it about the scene, the wheel takes it
/// nearer.
void move_camera(const SDL_Event& event, Look& look) {
  if (event.type == SDL_MOUSEMOTION && event.motion.state != 0) {
    look.turn =
        std::remainder(look.turn - kRadiansPerUnit * static_cast<float>(event.motion.xrel), 6.2831853f);
    look.rise = std::clamp(look.rise + kRadiansPerUnit * static_cast<float>(event.motion.yrel), -kMostRise,
                           kMostRise);
  } else if (event.type == SDL_MOUSEWHEEL) {
    look.distance =
        std::clamp(look.distance * std::pow(kPerNotch, event.wheel.preciseY), kNearest, kFarthest);
  }
}

}  // namespace

bool WindowInput::handle_command(Command command) {
  switch (command) {
    case Command::kNextView:
      SC_ASSERT(look_.view >= 0 && look_.view < views_, "view {} of {}", look_.view, views_);
      look_.view = (look_.view + 1) % views_;
      return true;
    case Command::kNextScene:
      next_scene_ = true;
      return true;
    case Command::kStatistics:
      look_.statistics = !look_.statistics;
      return true;
    case Command::kHelp:
      look_.help = !look_.help;
      return true;
    case Command::kQuit:
      quit_ = true;
      return true;
    default:
      return false;
  }
}

template <int Dimension>
void UserInput<Dimension>::follow(const Vector& gravity, bool paused) {
  gravity_ = gravity;
  if (!gravity.isZero(0)) gravity_when_on_ = gravity;
  paused_ = paused;
}

template <int Dimension>
void UserInput<Dimension>::handle(const SDL_Event& event) {
  if (const auto command = command_of(event, Dimension); command && !handle_command(*command))
    do_command(*command);
  if constexpr (Dimension == 2) {
    pointing_.hand.handle(event, coming_);
  } else {
    if (!pointing_.hand.handle(event, look_, coming_)) move_camera(event, look_);
    pointing_.tilt.handle(event);
  }
}

template <int Dimension>
std::span<const InputEvent<Dimension>> UserInput<Dimension>::next_frame() {
  frame_.swap(coming_);
  coming_.clear();
  if constexpr (Dimension == 3) {
    if (const auto tilt = pointing_.tilt.next_frame())
      frame_.push_back({.action = Action::kTilt, .value = *tilt});
  }
  return frame_;
}

template <int Dimension>
void UserInput<Dimension>::do_command(Command command) {
  const float strength = std::max(gravity_when_on_.norm(), kGravityStep);
  switch (command) {
    case Command::kJump:
      coming_.push_back({.action = Action::kPush, .body = kEveryBody, .value = Vector::Unit(1) * kJumpSpeed});
      break;
    case Command::kHome:
      coming_.push_back({.action = Action::kHome, .body = kEveryBody});
      break;
    case Command::kReset:
      coming_.push_back({.action = Action::kReset});
      if constexpr (Dimension == 3) pointing_.tilt.forget();
      break;
    case Command::kPause:
      paused_ = !paused_;
      coming_.push_back({.action = paused_ ? Action::kPause : Action::kResume});
      break;
    case Command::kSingleStep:
      coming_.push_back({.action = Action::kSingleStep});
      break;
    case Command::kGravityOnOff:
      set_gravity(gravity_.isZero(0) ? gravity_when_on_ : Vector::Zero());
      break;
    case Command::kMoreGravity:
      add_gravity(kGravityStep);
      break;
    case Command::kLessGravity:
      add_gravity(-kGravityStep);
      break;
    case Command::kGravityLeft:
      set_gravity(Vector::Unit(0) * -strength);
      break;
    case Command::kGravityRight:
      set_gravity(Vector::Unit(0) * strength);
      break;
    case Command::kGravityUp:
      set_gravity(Vector::Unit(1) * strength);
      break;
    case Command::kGravityDown:
      set_gravity(Vector::Unit(1) * -strength);
      break;
    default:
      break;  // the window's
  }
}

template <int Dimension>
void UserInput<Dimension>::set_gravity(const Vector& gravity) {
  gravity_ = gravity;
  if (!gravity.isZero(0)) gravity_when_on_ = gravity;
  coming_.push_back({.action = Action::kGravity, .value = gravity});
}

template <int Dimension>
void UserInput<Dimension>::add_gravity(float more) {
  const float strength = std::clamp(gravity_.norm() + more, 0.0f, kMostGravity);
  set_gravity(gravity_when_on_.normalized() * strength);
}

template class UserInput<2>;
template class UserInput<3>;

}  // namespace softcell::demos
