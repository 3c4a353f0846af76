#pragma once
// The keys and controller buttons, and what each does: used by the input and by the help page.

#include <SDL.h>

#include <cstdint>
#include <optional>
#include <span>

namespace softcell::demos {

enum class Command : std::uint8_t {
  kJump,
  kHome,
  kReset,
  kPause,
  kSingleStep,
  kGravityOnOff,
  kMoreGravity,
  kLessGravity,
  kGravityLeft,
  kGravityRight,
  kGravityUp,
  kGravityDown,
  kNextView,
  kNextScene,
  kMenu,
  kScenesCamera,
  kFollow,
  kSaveScene,
  kRemove,
  kKnife,
  kPin,
  kStatistics,
  kHelp,
  kQuit,
};

struct KeyBinding {
  Command command;
  SDL_Keycode key;
  SDL_GameControllerButton button;  ///< SDL_CONTROLLER_BUTTON_INVALID: none
  const char* key_name;
  const char* does;
  bool repeats = false;     ///< while the key is held
  bool only_in_2d = false;  ///< in 3D the key has another use
  bool only_in_3d = false;  ///< in 2D there is nothing for it to do
};

std::span<const KeyBinding> key_bindings();

/// The button's name as makers of controllers print it: that of Xbox, then that of PlayStation if it differs. Null: no button.
const char* button_name(SDL_GameControllerButton button);

/// The command that an event asks for: the event is a key or button that goes down. None: the event asks for no command.
std::optional<Command> command_of(const SDL_Event& event, int dimension);

}  // namespace softcell::demos
