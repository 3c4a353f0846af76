#pragma once
// The window's mouse and keys, for Dear ImGui.

#include <SDL.h>

#include <cstddef>
#include <deque>
#include <vector>

#include "demo/panel.h"

namespace softcell::demos {

/// Concerns Dear ImGui's current context (render::Overlay::make_current()). One thread uses it.
///
/// What goes down and up again within a frame would be lost to Dear ImGui, which looks once a frame: the second change of a key or button
/// waits for the next frame, and everything behind it, too.
class PanelInput {
 public:
  /// Lets the widgets be used by keyboard alone.
  PanelInput();

  /// @param density  pixels in a unit of SDL's mouse
  /// @return true: the event is the panel's: the mouse is over it, or the keyboard is in it
  /// @param panel  as it was drawn last
  bool handle(const SDL_Event& event, float density, const Panel& panel);

  /// Before each frame of Dear ImGui.
  void begin_frame();

 private:
  /// What has changed of the mouse or the keyboard.
  struct Change {
    enum class Kind { kMouseAt, kButton, kWheel, kKey, kText };
    Kind kind = Kind::kMouseAt;
    std::size_t which = 0;  // button or key
    bool down = false;
    float x = 0, y = 0;
    char text[SDL_TEXTINPUTEVENT_TEXT_SIZE] = {};
  };
  void apply(const Change& change) const;

  std::deque<Change> coming_;
  float x_ = -1, y_ = -1;  // the mouse, pixels
  Uint32 pressed_ = 0;     // buttons that went down on the panel, and have not come up
};

}  // namespace softcell::demos
