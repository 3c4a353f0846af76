#include "orbit.h"

#include <algorithm>
#include <cmath>

namespace softcell::demos {
namespace {

constexpr float kRadiansPerUnit = 0.006f;
constexpr float kMostRise = 1.5f;
constexpr float kPerNotch = 0.9f, kNearest = 0.3f, kFarthest = 3;

}  // namespace

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

}  // namespace softcell::demos
