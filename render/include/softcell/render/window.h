#pragma once
// A window on the user's screen, with SDL2. It uses OpenGL if the display supports it; otherwise pictures are drawn in memory and copied.
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
  int width = 1280, height = 720;  ///< in the desktop's units; on a dense screen a unit is several pixels
  bool vertical_sync = true;       ///< show() waits for the screen, if the driver supports it
};

/// Create, poll and destroy it on the program's main thread, as SDL requires. After release(), one other
/// thread may call context() and show(). One window at a time.
class Window {
 public:
  /// @throws std::runtime_error  there is no display (the message says how to work without one), or SDL refuses.
  explicit Window(const WindowSettings& settings);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  /// The window's context, which is current on the thread that made the window.
  GlContext& context();

  /// Releases the window's context from this thread, so that another thread can make it current.
  void release();

  /// Size in pixels, now: the user may change it.
  int width() const;
  int height() const;

  /// Pixels in one of the units in which SDL reports the mouse.
  float density() const;

  /// Shows the renderer's last frame, stretched if its size is not the window's. @pre context() is current
  void show(Renderer& renderer);

  /// Whether the display has gone, as when an X server ends. Then neither this object nor what show() uses may be destroyed: the display's
  /// library may never return from a call.
  bool lost() const;

  SDL_Window* sdl();

 private:
  class Surface;
  class GlSurface;
  class CopiedSurface;
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace softcell::render
