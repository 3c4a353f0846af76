#pragma once
// The OpenGL context that a renderer draws with. Backends: offscreen_context.h, and in softcell's sources window.h.

#include <string>

namespace softcell::render {

/// An OpenGL 3.3 core context. It is current on one thread at a time; see Window::release(). A process uses one backend: Mesa's
/// libraries keep the current context in shared thread-local state, and two of them on one thread crash.
class GlContext {
 public:
  using Function = void (*)();

  virtual ~GlContext() = default;
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Makes it the thread's current context. @throws std::runtime_error  the backend refuses.
  virtual void make_current() = 0;
  /// Address of a GL function, or null. @pre the context is current
  virtual Function function(const char* name) const = 0;
  /// The backend's name for messages: "OSMesa", "EGL".
  virtual std::string backend_name() const = 0;

 protected:
  GlContext() = default;
};

}  // namespace softcell::render
