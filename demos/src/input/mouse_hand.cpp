#include "mouse_hand.h"

#include "softcell/base/assert.h"

namespace softcell::demos {

void MouseHand::handle(const SDL_Event& event, const Look& look, std::vector<InputEvent<2>>& events) {
  if (window_.follow(event)) return;
  switch (event.type) {
    case SDL_MOUSEBUTTONDOWN:
      if (event.button.button == SDL_BUTTON_LEFT) grab(event.button.x, event.button.y, look, events);
      break;
    case SDL_MOUSEMOTION:
      if (holds_) move_to(event.motion.x, event.motion.y, look, events);
      break;
    case SDL_MOUSEBUTTONUP:
      if (event.button.button == SDL_BUTTON_LEFT && holds_) let_go(events);
      break;
    default:
      break;
  }
}

MouseHand MouseHand::for_hand(std::uint32_t hand) const {
  MouseHand other(*this);
  other.hand_ = hand;
  other.holds_ = false;
  return other;
}

bool MouseHand::grab(int x, int y, const Look&, std::vector<InputEvent<2>>& events) {
  auto taken = pick_(camera_.point_at(x, y, window_.width, window_.height));
  if (!taken) return false;
  taken->hand = hand_;
  events.push_back(*taken);
  holds_ = true;
  return true;
}

void MouseHand::move_to(int x, int y, const Look&, std::vector<InputEvent<2>>& events) {
  SC_ASSERT(holds_, "hand {} is moved to ({}, {}) but holds no body", hand_, x, y);
  if (events.empty() || events.back().action != Action::kMoveHand || events.back().hand != hand_)
    events.push_back({.action = Action::kMoveHand, .hand = hand_});
  events.back().value = camera_.point_at(x, y, window_.width, window_.height);
}

void MouseHand::let_go(std::vector<InputEvent<2>>& events) {
  SC_ASSERT(holds_, "hand {} lets go but holds no body", hand_);
  holds_ = false;
  events.push_back({.action = Action::kRelease, .hand = hand_});
}

void MouseHand::pin(std::vector<InputEvent<2>>& events) const {
  SC_ASSERT(holds_, "hand {} pins but holds no body", hand_);
  events.push_back({.action = Action::kPin, .hand = hand_});
}

}  // namespace softcell::demos
