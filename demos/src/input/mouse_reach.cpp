#include "mouse_reach.h"

#include <algorithm>
#include <utility>

#include "softcell/base/assert.h"

namespace softcell::demos {

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
      if (!taken_) return false;
      move(event.motion, look, events);
      return true;
    case SDL_MOUSEBUTTONUP:
      if (event.button.button != SDL_BUTTON_LEFT || !taken_) return false;
      taken_.reset();
      events.push_back({.action = Action::kRelease, .hand = kUsersHand});
      return true;
    default:
      return false;
  }
}

bool MouseReach::grab(const SDL_MouseButtonEvent& button, const Look& look,
                      std::vector<InputEvent<3>>& events) {
  if (!pick_) return false;
  taken_ = pick_(ray_through(eye_(look), button.x, button.y, width_, height_));
  if (!taken_) return false;
  events.push_back({.action = Action::kGrab, .hand = kUsersHand, .body = kEveryBody, .value = *taken_});
  return true;
}

void MouseReach::move(const SDL_MouseMotionEvent& motion, const Look& look,
                      std::vector<InputEvent<3>>& events) const {
  SC_ASSERT(taken_, "the mouse moves nothing to ({}, {})", motion.x, motion.y);
  const render::Camera camera = eye_(look);
  const Ray ray = ray_through(camera, motion.x, motion.y, width_, height_);
  const Eigen::Vector3f forward = camera.target - camera.eye;
  const float depth = (*taken_ - ray.from).dot(forward) / ray.along.dot(forward);
  if (events.empty() || events.back().action != Action::kMoveHand)
    events.push_back({.action = Action::kMoveHand, .hand = kUsersHand});
  events.back().value = ray.from + depth * ray.along;
}

}  // namespace softcell::demos
