#pragma once

#include <SDL.h>

#include <map>
#include <memory>

namespace softcell::demos {

/// Opens game controllers as they are plugged in, and turns on their motion sensors, so that their events arrive. The thread that polls
/// events uses it while SDL is initialised.
class Controllers {
 public:
  void handle(const SDL_Event& event) {
    if (event.type == SDL_CONTROLLERDEVICEADDED) {
      Handle controller(SDL_GameControllerOpen(event.cdevice.which));
      if (!controller) return;  // gone again
      SDL_GameControllerSetSensorEnabled(controller.get(), SDL_SENSOR_ACCEL, SDL_TRUE);
      const SDL_JoystickID id = SDL_JoystickInstanceID(SDL_GameControllerGetJoystick(controller.get()));
      open_[id] = std::move(controller);
    } else if (event.type == SDL_CONTROLLERDEVICEREMOVED) {
      open_.erase(event.cdevice.which);
    }
  }

 private:
  struct Close {
    void operator()(SDL_GameController* controller) const { SDL_GameControllerClose(controller); }
  };
  using Handle = std::unique_ptr<SDL_GameController, Close>;

  std::map<SDL_JoystickID, Handle> open_;
};

}  // namespace softcell::demos
