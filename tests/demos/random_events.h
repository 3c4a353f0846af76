#pragma once
// What a wild user might do.

#include <algorithm>
#include <cstdint>
#include <random>
#include <vector>

#include "input/input_event.h"

namespace softcell::demos::test {

/// Any action; values of a few metres, metres a second or metres a second squared, and less than a right
/// angle.
template <int Dimension>
InputEvent<Dimension> random_event(std::mt19937& random) {
  using Event = InputEvent<Dimension>;
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  Event event;
  do {
    event.action = static_cast<Action>(below(kActions));
  } while (Dimension == 2 && (event.action == Action::kTilt || event.action == Action::kCut));
  const auto use_hand = [&] { event.hand = below(3) == 0 ? below(4) : kUsersHand - below(3); };
  const auto use_body = [&] { event.body = below(3) == 0 ? below(6) : kEveryBody; };
  const auto random_vector = [&](float size) {
    typename Event::Vector vector;
    for (int i = 0; i < Dimension; ++i)
      vector[i] = size * (static_cast<float>(random()) / static_cast<float>(random.max()) * 2 - 1);
    return vector;
  };
  const auto use_value = [&](float size) { event.value = random_vector(size); };
  switch (event.action) {
    case Action::kGrab:
    case Action::kHold:
    case Action::kHoldRigid:
      use_hand();
      use_body();
      use_value(3);
      break;
    case Action::kMoveHand:
      use_hand();
      use_value(3);
      break;
    case Action::kRelease:
    case Action::kPin:
      use_hand();
      break;
    case Action::kPush:
      use_body();
      use_value(4);
      break;
    case Action::kGravity:
      use_value(15);
      break;
    case Action::kHome:
    case Action::kUnpin:
      use_body();
      break;
    case Action::kTilt:
      use_value(0.5f);
      event.value[1] = 0;
      break;
    case Action::kTimeScale:
    case Action::kSubsteps:
    case Action::kAlpha:
    case Action::kFrequency:
    case Action::kModulus:
    case Action::kDamping:
    case Action::kFriction:
    case Action::kYield:
    case Action::kCreep: {
      const NumberRange& range = *number_of(event.action);
      if (event.action != Action::kTimeScale && event.action != Action::kSubsteps) use_body();
      event.value[0] = range.whole
                           ? range.low + static_cast<float>(below(4))
                           : range.low + (std::min(range.high, 300.0f) - range.low) *
                                             static_cast<float>(random()) / static_cast<float>(random.max());
      break;
    }
    case Action::kCut:
      use_body();
      use_value(2);
      event.edge = random_vector(3);
      event.way = random_vector(3);
      break;
    case Action::kReset:
    case Action::kPause:
    case Action::kResume:
    case Action::kSingleStep:
      break;
  }
  return event;
}

}  // namespace softcell::demos::test
