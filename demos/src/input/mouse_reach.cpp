#include "mouse_reach.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

constexpr float kFartherPerNotch = 1.05f;  // of the wheel, turned away from the user

}  // namespace

MouseReach::MouseReach(Eye eye, Pick pick, int width, int height)
    : eye_(std::move(eye)), pick_(std::move(pick)), width_(width), height_(height) {
  SC_ASSERT(eye_ && width > 0 && height > 0, "a picture of {} by {} pixels, {} an eye", width, height,
            eye_ ? "with" : "without");
}

bool MouseReach::handle(const SDL_Event& event, const Look& look, std::vector<InputEvent<3>>& events) {
  switch (event.type) {
    case SDL_WINDOWEVENT:
      if (event.window.event == SDL_WINDOWEVENT_SIZE_CHANGED) {
        width_ = std::max(event.window.data1, 1);  // a window may shrink to nothing
        height_ = std::max(event.window.data2, 1);
      }
      return false;
    case SDL_MOUSEBUTTONDOWN:
      return event.button.button == SDL_BUTTON_LEFT && grab(event.button, look, events);
    case SDL_MOUSEMOTION:
      if (!depth_) return false;
      x_ = event.motion.x;
      y_ = event.motion.y;
      move(look, events);
      return true;
    case SDL_MOUSEWHEEL:
      if (!depth_) return false;
      depth_ = std::max(*depth_ * std::pow(kFartherPerNotch, event.wheel.preciseY), eye_(look).near_plane);
      move(look, events);
      return true;
    case SDL_MOUSEBUTTONUP:
      if (event.button.button != SDL_BUTTON_LEFT || !depth_) return false;
      depth_.reset();
      events.push_back({.action = Action::kRelease, .hand = kUsersHand});
      return true;
    default:
      return false;
  }
}

bool MouseReach::grab(const SDL_MouseButtonEvent& button, const Look& look,
                      std::vector<InputEvent<3>>& events) {
  if (!pick_) return false;
  const render::Camera camera = eye_(look);
  auto taken = pick_(ray_through(camera, button.x, button.y, width_, height_));
  if (!taken) return false;
  x_ = button.x;
  y_ = button.y;
  depth_ = (taken->value - camera.eye).dot((camera.target - camera.eye).normalized());
  taken->hand = kUsersHand;
  events.push_back(*taken);
  return true;
}

void MouseReach::move(const Look& look, std::vector<InputEvent<3>>& events) const {
  SC_ASSERT(depth_, "the mouse moves nothing to ({}, {})", x_, y_);
  const render::Camera camera = eye_(look);
  const Ray ray = ray_through(camera, x_, y_, width_, height_);
  const Eigen::Vector3f forward = (camera.target - camera.eye).normalized();
  if (events.empty() || events.back().action != Action::kMoveHand)
    events.push_back({.action = Action::kMoveHand, .hand = kUsersHand});
  events.back().value = ray.from + *depth_ / ray.along.dot(forward) * ray.along;
}

}  // namespace softcell::demos
