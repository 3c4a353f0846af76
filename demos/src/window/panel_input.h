#pragma once
// Passes the window's mouse and keys to Dear ImGui.

#include <SDL.h>

#include <cstddef>
#include <deque>

#include "demo/panel.h"

namespace softcell::demos {

/// It acts on Dear ImGui's current context (render::Overlay::make_current()). One thread uses it.
///
/// Dear ImGui looks once per frame, and would miss a key or button that goes down and up again within a frame. So the second change of a
/// key or button waits for the next frame, together with all events after it.
class PanelInput {
 public:
  /// Makes the widgets usable by keyboard alone.
  PanelInput();

  /// @param density  pixels per unit of SDL's mouse
  /// @return true: the event is for the panel, because the mouse is over it or the keyboard is in it
  /// @param panel  as it was drawn last
  bool handle(const SDL_Event& event, float density, const Panel& panel);

  /// Call it before each frame of Dear ImGui.
  void begin_frame();

 private:
  /// A change of the mouse or the keyboard.
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
  float x_ = -1, y_ = -1;  // position of the mouse, pixels
  Uint32 pressed_ = 0;     // buttons that went down on the panel and are still down
};

}  // namespace softcell::demos
