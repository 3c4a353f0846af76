#include "user_input.h"

#include <algorithm>

#include "softcell/base/assert.h"

namespace softcell::demos {

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
    case Command::kMenu:
      look_.menu = !look_.menu;
      return true;
    case Command::kScenesCamera:
      look_ = look_.with_scenes_camera();
      return true;
    case Command::kFollow:
      look_.follows = !look_.follows;
      return true;
    case Command::kKnife:
      look_.knife = !look_.knife;
      return true;
    case Command::kSaveScene:
      save_ = true;
      return true;
    case Command::kRemove:
      remove_ = true;
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
  if (hands_.handle(event)) return;
  if constexpr (Dimension == 3) {
    if (pointing_.knife.handle(event, look_, coming_) || pointing_.hand.handle(event, look_, coming_) ||
        pointing_.camera.handle(event, look_))
      return;
    pointing_.tilt.handle(event);
  } else {
    if (pointing_.knife.handle(event, look_, coming_)) return;
    pointing_.hand.handle(event, look_, coming_);
  }
  if (const auto command = command_of(event, Dimension); command && !handle_command(*command))
    do_command(*command);
}

template <int Dimension>
void UserInput<Dimension>::change(Action action, std::uint32_t body, float value) {
  const NumberRange* const range = number_of(action);
  SC_ASSERT(range != nullptr, "action {} has no number", static_cast<int>(action));
  std::erase_if(coming_, [&](const Event& event) { return event.action == action && event.body == body; });
  Event event;
  event.action = action;
  event.body = body;
  event.value[0] = std::clamp(value, range->low, range->high);
  coming_.push_back(event);
}

template <int Dimension>
std::span<const InputEvent<Dimension>> UserInput<Dimension>::next_frame() {
  hands_.next_frame(look_, coming_);
  frame_.swap(coming_);
  coming_.clear();
  if constexpr (Dimension == 3) {
    if (look_.hands[0]) pointing_.tilt.let_go_of_stick();
    pointing_.camera.next_frame(look_);
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
    case Command::kPin:
      pin_or_unpin();
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
      break;  // WindowInput handles it
  }
}

template <int Dimension>
void UserInput<Dimension>::pin_or_unpin() {
  const std::size_t before = coming_.size();
  if (pointing_.hand.holds()) pointing_.hand.pin(coming_);
  hands_.pin(coming_);
  if (coming_.size() > before)
    pinned_ = true;
  else
    coming_.push_back({.action = Action::kUnpin, .body = kEveryBody});
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
