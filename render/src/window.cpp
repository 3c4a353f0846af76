#include "softcell/render/window.h"

#include <SDL.h>

#include <memory>
#include <optional>
#include <stdexcept>

#include "display_watch.h"
#include "softcell/base/assert.h"
#include "softcell/render/offscreen_context.h"

namespace softcell::render {
namespace {

[[noreturn]] void refuse(const std::string& what) {
  throw std::runtime_error(what + " (SDL: " + SDL_GetError() + ")");
}

/// What a user can look at. Left to itself, SDL would take its "offscreen" driver where there is no display.
/// Asked without a folder for its socket, Wayland's library writes a line of its own.
const char* displays() {
  return SDL_getenv("XDG_RUNTIME_DIR") == nullptr ? "x11,KMSDRM" : "x11,wayland,KMSDRM";
}

/// SDL's video, input and controllers for the life of the object.
class SdlSession {
 public:
  SdlSession() {
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");  // Ctrl-C is the program's own
    SDL_SetHint(SDL_HINT_VIDEO_HIGHDPI_DISABLED, "0");
    SDL_SetHint(SDL_HINT_JOYSTICK_HIDAPI_PS3, "1");  // the report's controller; off by default on Linux
    SDL_SetHint(SDL_HINT_VIDEODRIVER, displays());
    SDL_SetMainReady();
    if (SDL_Init(SDL_INIT_VIDEO | SDL_INIT_GAMECONTROLLER | SDL_INIT_SENSOR) != 0) {
      refuse(
          "there is no display to open a window on; run with --headless, and --out or --video to see "
          "something");
    }
  }
  ~SdlSession() { SDL_Quit(); }
  SdlSession(const SdlSession&) = delete;
  SdlSession& operator=(const SdlSession&) = delete;
};

struct DestroyWindow {
  void operator()(SDL_Window* window) const { SDL_DestroyWindow(window); }
};
using WindowHandle = std::unique_ptr<SDL_Window, DestroyWindow>;

WindowHandle open(const WindowSettings& settings, Uint32 flags) {
  return WindowHandle(SDL_CreateWindow(settings.title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
                                       settings.width, settings.height,
                                       flags | SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI));
}

class WindowContext final : public GlContext {
 public:
  explicit WindowContext(SDL_Window* window) : window_(window), handle_(SDL_GL_CreateContext(window)) {
    if (handle_ == nullptr) refuse("the window has no OpenGL 3.3");
  }
  ~WindowContext() override { SDL_GL_DeleteContext(handle_); }

  void make_current() override {
    if (SDL_GL_GetCurrentContext() == handle_) return;
    if (SDL_GL_MakeCurrent(window_, handle_) != 0)
      refuse("the window's OpenGL context cannot be made current");
  }
  Function function(const char* name) const override {
    return reinterpret_cast<Function>(SDL_GL_GetProcAddress(name));
  }
  std::string backend_name() const override { return "SDL"; }

 private:
  SDL_Window* window_;
  SDL_GLContext handle_;
};

}  // namespace

/// How pictures get into the window.
class Window::Surface {
 public:
  virtual ~Surface() = default;
  virtual GlContext& context() = 0;
  virtual void release() = 0;
  virtual void pixel_size(int& width, int& height) const = 0;
  virtual void show(Renderer& renderer) = 0;
};

class Window::GlSurface final : public Surface {
 public:
  GlSurface(SDL_Window* window, bool vertical_sync) : window_(window), context_(window) {
    // Late frames are shown at once, where the driver can; where it can do neither, frames just appear.
    if (!vertical_sync) {
      SDL_GL_SetSwapInterval(0);
    } else if (SDL_GL_SetSwapInterval(-1) != 0) {
      SDL_GL_SetSwapInterval(1);
    }
  }
  GlContext& context() override { return context_; }
  void release() override { SDL_GL_MakeCurrent(window_, nullptr); }
  void pixel_size(int& width, int& height) const override {
    SDL_GL_GetDrawableSize(window_, &width, &height);
  }
  void show(Renderer& renderer) override {
    int width = 0, height = 0;
    pixel_size(width, height);
    renderer.present(width, height);
    SDL_GL_SwapWindow(window_);
  }

 private:
  SDL_Window* window_;
  WindowContext context_;
};

/// Without OpenGL on the display: drawn in memory, copied by the display server's simplest means.
class Window::CopiedSurface final : public Surface {
 public:
  explicit CopiedSurface(SDL_Window* window) : window_(window) { context(); }
  /// Made by the thread that uses it: one in memory cannot be handed from thread to thread.
  GlContext& context() override {
    if (!context_) context_ = create_offscreen_context();
    return *context_;
  }
  void release() override { context_.reset(); }
  void pixel_size(int& width, int& height) const override { SDL_GetWindowSize(window_, &width, &height); }
  void show(Renderer& renderer) override {
    const Image& image = renderer.pixels();
    SC_ASSERT(image.is_whole(), "{} bytes for {} by {} pixels", image.rgba.size(), image.width, image.height);
    const std::unique_ptr<SDL_Surface, decltype(&SDL_FreeSurface)> picture(
        SDL_CreateRGBSurfaceWithFormatFrom(const_cast<std::uint8_t*>(image.rgba.data()), image.width,
                                           image.height, 32, 4 * image.width, SDL_PIXELFORMAT_RGBA32),
        &SDL_FreeSurface);
    SDL_Surface* const screen = SDL_GetWindowSurface(window_);
    if (picture == nullptr || screen == nullptr) refuse("the window takes no picture");
    SDL_SetSurfaceBlendMode(picture.get(), SDL_BLENDMODE_NONE);
    SDL_BlitScaled(picture.get(), nullptr, screen, nullptr);
    SDL_UpdateWindowSurface(window_);
  }

 private:
  SDL_Window* window_;
  std::unique_ptr<GlContext> context_;
};

struct Window::State {
  explicit State(const WindowSettings& settings) {
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, 3);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_CORE);
    SDL_GL_SetAttribute(SDL_GL_DEPTH_SIZE, 0);
    try {
      window = open(settings, SDL_WINDOW_OPENGL);
      if (window == nullptr) refuse("no window with OpenGL");
      surface = std::make_unique<GlSurface>(window.get(), settings.vertical_sync);
      watch.emplace(window.get());
      return;
    } catch (const std::runtime_error&) {
      window.reset();
    }
    // SDL must not make a GL context of its own for the copies: beside OSMesa's on one thread it crashes.
    SDL_SetHint(SDL_HINT_FRAMEBUFFER_ACCELERATION, "0");
    window = open(settings, 0);
    if (window == nullptr) refuse("the display opens no window");
    surface = std::make_unique<CopiedSurface>(window.get());
    watch.emplace(window.get());
  }

  SdlSession session;
  WindowHandle window;
  std::unique_ptr<Surface> surface;
  std::optional<DisplayWatch> watch;
};

Window::Window(const WindowSettings& settings) : state_(std::make_unique<State>(settings)) {}
Window::~Window() = default;

GlContext& Window::context() { return state_->surface->context(); }
void Window::release() { state_->surface->release(); }
SDL_Window* Window::sdl() { return state_->window.get(); }

int Window::width() const {
  int width = 0, height = 0;
  state_->surface->pixel_size(width, height);
  return width;
}

int Window::height() const {
  int width = 0, height = 0;
  state_->surface->pixel_size(width, height);
  return height;
}

float Window::density() const {
  int units = 0, ignored = 0;
  SDL_GetWindowSize(state_->window.get(), &units, &ignored);
  return units > 0 ? static_cast<float>(width()) / static_cast<float>(units) : 1;
}

bool Window::lost() const { return state_->watch->lost(); }

void Window::show(Renderer& renderer) { state_->surface->show(renderer); }

}  // namespace softcell::render
