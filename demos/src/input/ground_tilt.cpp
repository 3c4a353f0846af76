#include "ground_tilt.h"

#include <array>
#include <cmath>

#include "controller_hands.h"

namespace softcell::demos {
namespace {

using Eigen::Vector2f;

constexpr float kSensorGrain = 0.01f;  // radians: a hand is never still

Vector2f clamped(const Vector2f& v, float most) { return v.cwiseMax(-most).cwiseMin(most); }

}  // namespace

void GroundTilt::handle(const SDL_Event& event) {
  switch (event.type) {
    case SDL_KEYDOWN:
    case SDL_KEYUP:
      handle_key(event.key);
      break;
    case SDL_CONTROLLERAXISMOTION:
      handle_axis(event.caxis);
      break;
    case SDL_CONTROLLERSENSORUPDATE:
      handle_sensor(event.csensor);
      break;
    case SDL_CONTROLLERDEVICEREMOVED:
      stick_.setZero();
      sensor_.setZero();
      break;
    default:
      break;
  }
}

void GroundTilt::handle_key(const SDL_KeyboardEvent& key) {
  const float down = key.type == SDL_KEYDOWN ? 1 : 0;
  switch (key.keysym.sym) {
    case SDLK_LEFT:
      held_.left = down;
      break;
    case SDLK_RIGHT:
      held_.right = down;
      break;
    case SDLK_UP:
      held_.away = down;
      break;
    case SDLK_DOWN:
      held_.near = down;
      break;
    default:
      break;
  }
}

void GroundTilt::handle_axis(const SDL_ControllerAxisEvent& axis) {
  const float used = stick_share(axis.value);
  if (axis.axis == SDL_CONTROLLER_AXIS_LEFTX) stick_.x() = used;
  if (axis.axis == SDL_CONTROLLER_AXIS_LEFTY) stick_.y() = used;
}

/// An accelerometer at rest measures the force that holds it up: 9.8 m/s^2 along its own y when it lies flat; x is to the right and z
/// towards the player. [SDL_sensor.h, "Accelerometer sensor"] documented
void GroundTilt::handle_sensor(const SDL_ControllerSensorEvent& sensor) {
  if (sensor.sensor != SDL_SENSOR_ACCEL) return;
  const auto [x, y, z] = std::array{sensor.data[0], sensor.data[1], sensor.data[2]};
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(z)) return;
  const Vector2f angles = clamped({-std::atan2(z, y), std::atan2(x, y)}, kMost);
  sensor_ = (angles / kSensorGrain).array().round() * kSensorGrain;
}

void GroundTilt::forget() { angles_.setZero(); }

std::optional<Eigen::Vector3f> GroundTilt::next_frame() {
  const Vector2f arrows{held_.near - held_.away, held_.left - held_.right};
  const Vector2f stick{stick_.y(), -stick_.x()};
  const Vector2f wanted = clamped(kMost * (arrows + stick) + sensor_, kMost);
  const Vector2f change = clamped(wanted - angles_, kMostInAFrame);
  if (change.isZero(0)) return std::nullopt;
  angles_ += change;
  return Eigen::Vector3f{angles_.x(), 0, angles_.y()};
}

}  // namespace softcell::demos
