#include "mouse_hand.h"

#include <algorithm>

#include "softcell/base/assert.h"

namespace softcell::demos {

void MouseHand::handle(const SDL_Event& event, std::vector<InputEvent<2>>& events) {
  switch (event.type) {
    case SDL_WINDOWEVENT:
      if (event.window.event == SDL_WINDOWEVENT_SIZE_CHANGED) {
        width_ = std::max(event.window.data1, 1);  // a window may shrink to nothing
        height_ = std::max(event.window.data2, 1);
      }
      break;
    case SDL_MOUSEBUTTONDOWN:
      if (event.button.button != SDL_BUTTON_LEFT) break;
      if (auto taken = pick_(camera_.point_at(event.button.x, event.button.y, width_, height_))) {
        taken->hand = kUsersHand;
        events.push_back(*taken);
        holds_ = true;
      }
      break;
    case SDL_MOUSEMOTION:
      if (holds_) move(event.motion, events);
      break;
    case SDL_MOUSEBUTTONUP:
      if (event.button.button != SDL_BUTTON_LEFT || !holds_) break;
      holds_ = false;
      events.push_back({.action = Action::kRelease, .hand = kUsersHand});
      break;
    default:
      break;
  }
}

void MouseHand::move(const SDL_MouseMotionEvent& motion, std::vector<InputEvent<2>>& events) const {
  SC_ASSERT(holds_, "the mouse moves nothing to ({}, {})", motion.x, motion.y);
  if (events.empty() || events.back().action != Action::kMoveHand)
    events.push_back({.action = Action::kMoveHand, .hand = kUsersHand});
  events.back().value = camera_.point_at(motion.x, motion.y, width_, height_);
}

}  // namespace softcell::demos
