#pragma once
// The size of a window, from SDL's events.

#include <SDL.h>

#include <algorithm>

namespace softcell::demos {

/// In the units in which SDL gives the mouse; 1 or more.
struct WindowSize {
  int width = 1, height = 1;

  /// @return  whether the event is a change of the size, which is followed then
  bool follow(const SDL_Event& event) {
    if (event.type != SDL_WINDOWEVENT || event.window.event != SDL_WINDOWEVENT_SIZE_CHANGED) return false;
    width = std::max(event.window.data1, 1);  // a window may shrink to nothing
    height = std::max(event.window.data2, 1);
    return true;
  }
};

}  // namespace softcell::demos
