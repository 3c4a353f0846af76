#pragma once

struct SDL_Window;

namespace softcell::render {

/// Notes when the X server of a window has gone. Xlib ends the program when a call then fails, and may never return from a call of another
/// thread, so the program has to know before its next call. One at a time.
class DisplayWatch {
 public:
  /// Call it on the thread that polls for events. @param window  on another kind of display nothing is noted
  explicit DisplayWatch(SDL_Window* window);

  bool lost() const;

 private:
  int connection_ = -1;  // to the X server; below 0: there is none
};

}  // namespace softcell::render
