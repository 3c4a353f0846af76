#include "mouse_reach.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

constexpr float kFartherPerNotch = 1.05f;  // per notch of the wheel, turned away from the user

}  // namespace

MouseReach::MouseReach(Eye eye, Pick pick, int width, int height)
    : eye_(std::move(eye)), pick_(std::move(pick)), window_{width, height} {
  SC_ASSERT(eye_ && width > 0 && height > 0, "a picture of {} by {} pixels, {} an eye", width, height,
            eye_ ? "with" : "without");
}

bool MouseReach::handle(const SDL_Event& event, const Look& look, std::vector<InputEvent<3>>& events) {
  if (window_.follow(event)) return false;
  switch (event.type) {
    case SDL_MOUSEBUTTONDOWN:
      return event.button.button == SDL_BUTTON_LEFT && grab(event.button.x, event.button.y, look, events);
    case SDL_MOUSEMOTION:
      if (!depth_) return false;
      move_to(event.motion.x, event.motion.y, look, events);
      return true;
    case SDL_MOUSEWHEEL:
      if (!depth_) return false;
      move_away(event.wheel.preciseY, look, events);
      return true;
    case SDL_MOUSEBUTTONUP:
      if (event.button.button != SDL_BUTTON_LEFT || !depth_) return false;
      let_go(events);
      return true;
    default:
      return false;
  }
}

MouseReach MouseReach::for_hand(std::uint32_t hand) const {
  MouseReach other(*this);
  other.hand_ = hand;
  other.depth_.reset();
  return other;
}

bool MouseReach::grab(int x, int y, const Look& look, std::vector<InputEvent<3>>& events) {
  if (!pick_) return false;
  const render::Camera camera = eye_(look);
  auto taken = pick_(ray_through(camera, x, y, window_.width, window_.height));
  if (!taken) return false;
  x_ = x;
  y_ = y;
  depth_ = (taken->value - camera.eye).dot((camera.target - camera.eye).normalized());
  taken->hand = hand_;
  events.push_back(*taken);
  return true;
}

void MouseReach::move_to(int x, int y, const Look& look, std::vector<InputEvent<3>>& events) {
  x_ = x;
  y_ = y;
  move(look, events);
}

void MouseReach::move_away(float notches, const Look& look, std::vector<InputEvent<3>>& events) {
  SC_ASSERT(depth_, "hand {} is moved away by {} notches but holds no body", hand_, notches);
  depth_ = std::max(*depth_ * std::pow(kFartherPerNotch, notches), eye_(look).near_plane);
  move(look, events);
}

void MouseReach::pin(std::vector<InputEvent<3>>& events) const {
  SC_ASSERT(depth_, "hand {} pins but holds no body", hand_);
  events.push_back({.action = Action::kPin, .hand = hand_});
}

void MouseReach::let_go(std::vector<InputEvent<3>>& events) {
  SC_ASSERT(depth_, "hand {} lets go but holds no body", hand_);
  depth_.reset();
  events.push_back({.action = Action::kRelease, .hand = hand_});
}

void MouseReach::move(const Look& look, std::vector<InputEvent<3>>& events) const {
  SC_ASSERT(depth_, "hand {} is moved to ({}, {}) but holds no body", hand_, x_, y_);
  const render::Camera camera = eye_(look);
  const Ray ray = ray_through(camera, x_, y_, window_.width, window_.height);
  const Eigen::Vector3f forward = (camera.target - camera.eye).normalized();
  if (events.empty() || events.back().action != Action::kMoveHand || events.back().hand != hand_)
    events.push_back({.action = Action::kMoveHand, .hand = hand_});
  events.back().value = ray.from + *depth_ / ray.along.dot(forward) * ray.along;
}

}  // namespace softcell::demos
