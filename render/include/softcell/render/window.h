#pragma once
// A window on the user's screen, by SDL2: OpenGL where there is any, else pictures drawn in memory and
// copied.
//
//   Window window({.title = "softcell demo 3d"});
//   Renderer renderer(window.context(), {.width = window.width(), .height = window.height()});
//   while (...) { SDL_PollEvent(...); renderer.render(frame); window.show(renderer); }

#include <memory>
#include <string>

#include "softcell/render/gl_context.h"
#include "softcell/render/renderer.h"

struct SDL_Window;

namespace softcell::render {

struct WindowSettings {
  std::string title = "softcell";
  int width = 1280, height = 720;  ///< in the desktop's units, which on a dense screen are several pixels
  bool vertical_sync = true;       ///< wait for the screen when showing, where it can
};

/// Made, polled and destroyed on the program's main thread, as SDL asks; context() and show() may belong to
/// one other thread, after release(). One window at a time.
class Window {
 public:
  /// @throws std::runtime_error  there is no display, and how to do without; or what SDL refuses.
  explicit Window(const WindowSettings& settings);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// Current on the thread that made the window.
  GlContext& context();

  /// Gives the context up, so that another thread can make it current.
  void release();

  /// Pixels, now: the user may change them.
  int width() const;
  int height() const;

  /// Pixels for one of the units in which SDL gives the mouse.
  float density() const;

  /// Shows the renderer's last frame, stretched when its size is not the window's. @pre context() is current
  void show(Renderer& renderer);

  SDL_Window* sdl();

 private:
  class Surface;
  class GlSurface;
  class CopiedSurface;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::render
