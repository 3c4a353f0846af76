#include "panel_input.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

namespace softcell::demos {
namespace {

constexpr std::array<std::pair<ImGuiKey, SDL_Scancode>, 18> kKeys{{
    {ImGuiKey_Tab, SDL_SCANCODE_TAB},
    {ImGuiKey_LeftArrow, SDL_SCANCODE_LEFT},
    {ImGuiKey_RightArrow, SDL_SCANCODE_RIGHT},
    {ImGuiKey_UpArrow, SDL_SCANCODE_UP},
    {ImGuiKey_DownArrow, SDL_SCANCODE_DOWN},
    {ImGuiKey_PageUp, SDL_SCANCODE_PAGEUP},
    {ImGuiKey_PageDown, SDL_SCANCODE_PAGEDOWN},
    {ImGuiKey_Home, SDL_SCANCODE_HOME},
    {ImGuiKey_End, SDL_SCANCODE_END},
    {ImGuiKey_Delete, SDL_SCANCODE_DELETE},
    {ImGuiKey_Backspace, SDL_SCANCODE_BACKSPACE},
    {ImGuiKey_Space, SDL_SCANCODE_SPACE},
    {ImGuiKey_Enter, SDL_SCANCODE_RETURN},
    {ImGuiKey_KeyPadEnter, SDL_SCANCODE_KP_ENTER},
    {ImGuiKey_Escape, SDL_SCANCODE_ESCAPE},
    {ImGuiKey_A, SDL_SCANCODE_A},
    {ImGuiKey_C, SDL_SCANCODE_C},
    {ImGuiKey_V, SDL_SCANCODE_V},
}};

std::optional<std::size_t> button_of(Uint8 button) {
  switch (button) {
    case SDL_BUTTON_LEFT:
      return ImGuiMouseButton_Left;
    case SDL_BUTTON_RIGHT:
      return ImGuiMouseButton_Right;
    case SDL_BUTTON_MIDDLE:
      return ImGuiMouseButton_Middle;
    default:
      return std::nullopt;
  }
}

}  // namespace

PanelInput::PanelInput() {
  ImGuiIO& io = ImGui::GetIO();
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  for (const auto& [key, scancode] : kKeys) io.KeyMap[key] = scancode;
}

bool PanelInput::handle(const SDL_Event& event, float density, const Panel& panel) {
  const ImGuiIO& io = ImGui::GetIO();
  const auto moved_to = [&](int x, int y) {
    Change& change = coming_.emplace_back();
    change.kind = Change::Kind::kMouseAt;
    change.x = x_ = density * static_cast<float>(x);
    change.y = y_ = density * static_cast<float>(y);
  };
  switch (event.type) {
    case SDL_MOUSEMOTION:
      moved_to(event.motion.x, event.motion.y);
      return pressed_ != 0 || (event.motion.state == 0 && panel.contains(x_, y_));
    case SDL_MOUSEBUTTONDOWN:
    case SDL_MOUSEBUTTONUP: {
      moved_to(event.button.x, event.button.y);
      const bool down = event.type == SDL_MOUSEBUTTONDOWN;
      const auto mask = static_cast<Uint32>(SDL_BUTTON(event.button.button));
      const bool ours = down ? panel.contains(x_, y_) : (pressed_ & mask) != 0;
      pressed_ = down && ours ? pressed_ | mask : pressed_ & ~mask;
      if (const auto button = button_of(event.button.button)) {
        Change& change = coming_.emplace_back();
        change.kind = Change::Kind::kButton;
        change.which = *button;
        change.down = down;
      }
      return ours;
    }
    case SDL_MOUSEWHEEL: {
      Change& change = coming_.emplace_back();
      change.kind = Change::Kind::kWheel;
      change.x = event.wheel.preciseX;
      change.y = event.wheel.preciseY;
      return panel.contains(x_, y_);
    }
    case SDL_KEYDOWN:
    case SDL_KEYUP: {
      if (event.key.keysym.scancode >= IM_ARRAYSIZE(io.KeysDown)) return false;
      Change& change = coming_.emplace_back();
      change.kind = Change::Kind::kKey;
      change.which = static_cast<std::size_t>(event.key.keysym.scancode);
      change.down = event.type == SDL_KEYDOWN;
      // Other users of the input get the release as well: the key may have gone down before the panel was there.
      return change.down && io.WantCaptureKeyboard;
    }
    case SDL_TEXTINPUT: {
      Change& change = coming_.emplace_back();
      change.kind = Change::Kind::kText;
      std::memcpy(change.text, event.text.text, sizeof change.text);
      return io.WantTextInput;
    }
    default:
      return false;
  }
}

void PanelInput::apply(const Change& change) const {
  ImGuiIO& io = ImGui::GetIO();
  switch (change.kind) {
    case Change::Kind::kMouseAt:
      io.MousePos = {change.x, change.y};
      break;
    case Change::Kind::kButton:
      io.MouseDown[change.which] = change.down;
      break;
    case Change::Kind::kWheel:
      io.MouseWheelH += change.x;
      io.MouseWheel += change.y;
      break;
    case Change::Kind::kKey:
      io.KeysDown[change.which] = change.down;
      io.KeyShift = io.KeysDown[SDL_SCANCODE_LSHIFT] || io.KeysDown[SDL_SCANCODE_RSHIFT];
      io.KeyCtrl = io.KeysDown[SDL_SCANCODE_LCTRL] || io.KeysDown[SDL_SCANCODE_RCTRL];
      io.KeyAlt = io.KeysDown[SDL_SCANCODE_LALT] || io.KeysDown[SDL_SCANCODE_RALT];
      break;
    case Change::Kind::kText:
      io.AddInputCharactersUTF8(change.text);
      break;
  }
}

void PanelInput::begin_frame() {
  std::vector<std::pair<Change::Kind, std::size_t>> changed;
  while (!coming_.empty()) {
    const Change& change = coming_.front();
    const bool toggles = change.kind == Change::Kind::kButton || change.kind == Change::Kind::kKey;
    const std::pair which(change.kind, change.which);
    // A widget does not notice the button either if the mouse leaves it before Dear ImGui looks.
    if (change.kind == Change::Kind::kMouseAt && !changed.empty()) return;
    if (toggles && std::ranges::find(changed, which) != changed.end()) return;
    if (toggles) changed.push_back(which);
    apply(change);
    coming_.pop_front();
  }
}

}  // namespace softcell::demos
