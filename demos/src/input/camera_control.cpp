#include "camera_control.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "softcell/base/assert.h"

namespace softcell::demos {
namespace {

using Eigen::Vector3f;

constexpr float kRadiansPerUnit = 0.006f;
constexpr float kMostRise = 1.5f;
constexpr float kPerNotch = 0.9f, kNearest = 0.1f, kFarthest = 10;
constexpr float kFlightInFrame = 0.01f;  // of the distance to the target: 0.6 times that per second

/// Unit vectors to the right, upwards, and towards the viewer.
struct Axes {
  Vector3f right, up, back;

  explicit Axes(const render::Camera& camera) : back((camera.eye - camera.target).normalized()) {
    right = camera.up.cross(back).normalized();
    up = back.cross(right);
  }
};

void turn(const SDL_MouseMotionEvent& motion, Look& look) {
  look.turn = std::remainder(look.turn - kRadiansPerUnit * static_cast<float>(motion.xrel), 6.2831853f);
  look.rise =
      std::clamp(look.rise + kRadiansPerUnit * static_cast<float>(motion.yrel), -kMostRise, kMostRise);
}

}  // namespace

CameraControl::CameraControl(const render::Camera& camera, int height)
    : camera_(camera), window_{.height = height} {
  SC_ASSERT(height > 0, "a picture {} pixels high", height);
}

bool CameraControl::handle(const SDL_Event& event, Look& look) {
  if (window_.follow(event)) return false;
  switch (event.type) {
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP:
      if (event.button.button != SDL_BUTTON_RIGHT) return false;
      flies_ = event.type == SDL_MOUSEBUTTONDOWN;
      if (!flies_) held_ = {};
      return true;
    case SDL_KEYDOWN:
    case SDL_KEYUP:
      return flies_ && handle_key(event.key);
    case SDL_MOUSEMOTION:
      if (event.motion.state == 0) return false;
      move(event.motion, look);
      return true;
    case SDL_MOUSEWHEEL:
      look.distance =
          std::clamp(look.distance * std::pow(kPerNotch, event.wheel.preciseY), kNearest, kFarthest);
      return true;
    default:
      return false;
  }
}

void CameraControl::move(const SDL_MouseMotionEvent& motion, Look& look) const {
  const bool sideways = (motion.state & SDL_BUTTON_MMASK) != 0 ||
                        ((motion.state & SDL_BUTTON_LMASK) != 0 && (SDL_GetModState() & KMOD_SHIFT) != 0);
  const render::Camera before = moved_by(camera_, look);
  if (sideways) {
    const float metres =
        2 * before.tan_half_fov_y * (before.eye - before.target).norm() / static_cast<float>(window_.height);
    const Axes axes(before);
    look.moved +=
        metres * (static_cast<float>(motion.yrel) * axes.up - static_cast<float>(motion.xrel) * axes.right);
    return;
  }
  if ((motion.state & SDL_BUTTON_RMASK) != 0) look.looks_around = true;
  turn(motion, look);
  // The eye stays in place, and the target moves.
  if ((motion.state & SDL_BUTTON_RMASK) != 0) look.moved += before.eye - moved_by(camera_, look).eye;
}

bool CameraControl::handle_key(const SDL_KeyboardEvent& key) {
  const float down = key.type == SDL_KEYDOWN ? 1 : 0;
  switch (key.keysym.sym) {
    case SDLK_w:
      held_.forward = down;
      return true;
    case SDLK_s:
      held_.back = down;
      return true;
    case SDLK_d:
      held_.right = down;
      return true;
    case SDLK_a:
      held_.left = down;
      return true;
    case SDLK_e:
      held_.up = down;
      return true;
    case SDLK_q:
      held_.down = down;
      return true;
    default:
      return false;
  }
}

void CameraControl::next_frame(Look& look) const {
  const render::Camera camera = moved_by(camera_, look);
  const Axes axes(camera);
  const Vector3f way = (held_.right - held_.left) * axes.right + (held_.up - held_.down) * axes.up +
                       (held_.back - held_.forward) * axes.back;
  look.moved += kFlightInFrame * (camera.eye - camera.target).norm() * way;
}

}  // namespace softcell::demos
