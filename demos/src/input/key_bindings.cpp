#include "key_bindings.h"
#include "softcell/base/assert.h"

#include <array>

namespace softcell::demos {
namespace {

constexpr auto kNoButton = SDL_CONTROLLER_BUTTON_INVALID;

// The report has the square as the button to jump; SDL calls it X.
constexpr std::array kBindings{
    KeyBinding{Command::kJump, SDLK_SPACE, SDL_CONTROLLER_BUTTON_X, "Space", "jump"},
    KeyBinding{Command::kHome, SDLK_BACKSPACE, SDL_CONTROLLER_BUTTON_BACK, "Backspace",
               "soft bodies back to where they began"},
    KeyBinding{Command::kReset, SDLK_r, SDL_CONTROLLER_BUTTON_START, "R", "everything as at the beginning"},
    KeyBinding{Command::kPause, SDLK_p, kNoButton, "P", "pause, and on"},
    KeyBinding{Command::kSingleStep, SDLK_PERIOD, kNoButton, ".", "in a pause: one step", true},
    KeyBinding{Command::kGravityOnOff, SDLK_g, SDL_CONTROLLER_BUTTON_Y, "G", "gravity off, and on"},
    KeyBinding{Command::kMoreGravity, SDLK_PLUS, SDL_CONTROLLER_BUTTON_RIGHTSHOULDER, "+", "more gravity",
               true},
    KeyBinding{Command::kLessGravity, SDLK_MINUS, SDL_CONTROLLER_BUTTON_LEFTSHOULDER, "-", "less gravity",
               true},
    KeyBinding{Command::kGravityLeft, SDLK_LEFT, SDL_CONTROLLER_BUTTON_DPAD_LEFT, "Left",
               "gravity to the left", false, true},
    KeyBinding{Command::kGravityRight, SDLK_RIGHT, SDL_CONTROLLER_BUTTON_DPAD_RIGHT, "Right",
               "gravity to the right", false, true},
    KeyBinding{Command::kGravityUp, SDLK_UP, SDL_CONTROLLER_BUTTON_DPAD_UP, "Up", "gravity upwards", false,
               true},
    KeyBinding{Command::kGravityDown, SDLK_DOWN, SDL_CONTROLLER_BUTTON_DPAD_DOWN, "Down", "gravity downwards",
               false, true},
    KeyBinding{Command::kNextView, SDLK_v, SDL_CONTROLLER_BUTTON_A, "V", "next view"},
    KeyBinding{Command::kNextScene, SDLK_n, SDL_CONTROLLER_BUTTON_B, "N", "next scene"},
    KeyBinding{Command::kMenu, SDLK_m, kNoButton, "M", "menu"},
    KeyBinding{Command::kScenesCamera, SDLK_c, kNoButton, "C", "the scene's own camera again", false, false,
               true},
    KeyBinding{Command::kFollow, SDLK_f, kNoButton, "F", "camera follows the body that was held last, or not",
               false, false, true},
    KeyBinding{Command::kRemove, SDLK_DELETE, kNoButton, "Delete", "remove the soft body that was held last"},
    KeyBinding{Command::kKnife, SDLK_k, kNoButton, "K", "the mouse is a knife, or a hand again"},
    KeyBinding{Command::kPin, SDLK_h, kNoButton, "H",
               "pin what hands hold; with nothing held: take all pins off"},
    KeyBinding{Command::kSaveScene, SDLK_F5, kNoButton, "F5", "save the scene as it is"},
    KeyBinding{Command::kStatistics, SDLK_s, SDL_CONTROLLER_BUTTON_LEFTSTICK, "S", "statistics"},
    KeyBinding{Command::kHelp, SDLK_F1, SDL_CONTROLLER_BUTTON_RIGHTSTICK, "F1", "this help"},
    KeyBinding{Command::kQuit, SDLK_ESCAPE, kNoButton, "Esc", "the end"},
};

/// Maps keys with the same meaning to one: plus without shift, and keys of the number pad.
SDL_Keycode same_as(SDL_Keycode key) {
  switch (key) {
    case SDLK_EQUALS:
    case SDLK_KP_PLUS:
      return SDLK_PLUS;
    case SDLK_KP_MINUS:
      return SDLK_MINUS;
    default:
      return key;
  }
}

}  // namespace

const char* button_name(SDL_GameControllerButton button) {
  switch (button) {
    case SDL_CONTROLLER_BUTTON_A:
      return "A / Cross";
    case SDL_CONTROLLER_BUTTON_B:
      return "B / Circle";
    case SDL_CONTROLLER_BUTTON_X:
      return "X / Square";
    case SDL_CONTROLLER_BUTTON_Y:
      return "Y / Triangle";
    case SDL_CONTROLLER_BUTTON_BACK:
      return "Back / Select";
    case SDL_CONTROLLER_BUTTON_START:
      return "Start";
    case SDL_CONTROLLER_BUTTON_LEFTSTICK:
      return "left stick pressed";
    case SDL_CONTROLLER_BUTTON_RIGHTSTICK:
      return "right stick pressed";
    case SDL_CONTROLLER_BUTTON_LEFTSHOULDER:
      return "LB / L1";
    case SDL_CONTROLLER_BUTTON_RIGHTSHOULDER:
      return "RB / R1";
    case SDL_CONTROLLER_BUTTON_DPAD_UP:
      return "D-pad up";
    case SDL_CONTROLLER_BUTTON_DPAD_DOWN:
      return "D-pad down";
    case SDL_CONTROLLER_BUTTON_DPAD_LEFT:
      return "D-pad left";
    case SDL_CONTROLLER_BUTTON_DPAD_RIGHT:
      return "D-pad right";
    default:
      return nullptr;
  }
}

std::span<const KeyBinding> key_bindings() { return kBindings; }

std::optional<Command> command_of(const SDL_Event& event, int dimension) {
  SC_ASSERT(dimension == 2 || dimension == 3, "an event in {} dimensions", dimension);
  if (event.type == SDL_QUIT) return Command::kQuit;
  for (const KeyBinding& binding : kBindings) {
    if ((binding.only_in_2d && dimension != 2) || (binding.only_in_3d && dimension != 3)) continue;
    const bool by_key = event.type == SDL_KEYDOWN && same_as(event.key.keysym.sym) == binding.key &&
                        (event.key.repeat == 0 || binding.repeats);
    const bool by_button = event.type == SDL_CONTROLLERBUTTONDOWN && binding.button != kNoButton &&
                           event.cbutton.button == binding.button;
    if (by_key || by_button) return binding.command;
  }
  return std::nullopt;
}

}  // namespace softcell::demos
