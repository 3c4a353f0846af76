// EGL on Mesa's surfaceless platform: no display server, no window. Declared here because EGL's header is of
// no use without its library, which is loaded at run time. [EGL 1.5, EGL_MESA_platform_surfaceless]
// documented

#include <memory>
#include <stdexcept>
#include <string>

#include "backends.h"
#include "dynamic_library.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::render {
namespace {

constexpr unsigned int kEglPlatformSurfacelessMesa = 0x31DD;
constexpr unsigned int kEglOpenglApi = 0x30A2;
constexpr int kEglNone = 0x3038;
constexpr int kEglSurfaceType = 0x3033;
constexpr int kEglRenderableType = 0x3040;
constexpr int kEglOpenglBit = 0x0008;
constexpr int kEglContextMajorVersion = 0x3098;
constexpr int kEglContextMinorVersion = 0x30FB;
constexpr int kEglContextProfileMask = 0x30FD;
constexpr int kEglContextCoreProfileBit = 0x0001;

using EglHandle = void*;  // displays, configurations, contexts and surfaces alike

class EglContext final : public GlContext {
 public:
  EglContext() {
    // An extension function: asked for by name, not exported by every libEGL.
    const auto get_platform_display = reinterpret_cast<EglHandle (*)(unsigned int, void*, const int*)>(
        function_("eglGetPlatformDisplayEXT"));
    if (get_platform_display == nullptr) throw std::runtime_error("libEGL has no eglGetPlatformDisplayEXT");
    display_ = get_platform_display(kEglPlatformSurfacelessMesa, nullptr, nullptr);
    if (display_ == nullptr) refuse("a surfaceless display; install the package libegl-mesa0");
    if (initialize_(display_, nullptr, nullptr) == 0) refuse("to start; install the package libgl1-mesa-dri");
    create();
  }

  ~EglContext() override {
    make_current_(display_, nullptr, nullptr, nullptr);
    destroy_context_(display_, handle_);
    // The display is the process's: terminating it would end the contexts of others.
  }

  void make_current() override {
    if (make_current_(display_, nullptr, nullptr, handle_) == 0) refuse("to make its context current");
  }

  Function function(const char* name) const override {
    SC_ASSERT(name != nullptr && get_current_context_() == handle_,
              "a GL function of context {}; the current one is {}", handle_, get_current_context_());
    return function_(name);
  }
  std::string backend_name() const override { return "EGL"; }

 private:
  void create() {
    if (bind_api_(kEglOpenglApi) == 0) refuse("desktop OpenGL");
    // Surface type 0: a configuration that need not be able to show anything.
    constexpr int kConfiguration[] = {kEglSurfaceType, 0, kEglRenderableType, kEglOpenglBit, kEglNone};
    EglHandle configuration = nullptr;
    int count = 0;
    if (choose_config_(display_, kConfiguration, &configuration, 1, &count) == 0 || count == 0) {
      refuse("a configuration for OpenGL");
    }
    constexpr int kAttributes[] = {
        kEglContextMajorVersion,   3,       kEglContextMinorVersion, 3, kEglContextProfileMask,
        kEglContextCoreProfileBit, kEglNone};
    handle_ = create_context_(display_, configuration, nullptr, kAttributes);
    if (handle_ == nullptr) refuse("an OpenGL 3.3 core context");
    try {
      make_current();
    } catch (...) {
      destroy_context_(display_, handle_);
      throw;
    }
  }

  [[noreturn]] void refuse(const char* what) const {
    throw std::runtime_error(std::string("EGL refuses ") + what + " (EGL error " +
                             base::hex(static_cast<unsigned int>(get_error_())) + ")");
  }

  DynamicLibrary library_{{"libEGL.so.1"}, "libegl1"};
  Function (*function_)(const char*) = library_.function<decltype(function_)>("eglGetProcAddress");
  int (*get_error_)() = library_.function<decltype(get_error_)>("eglGetError");
  unsigned int (*initialize_)(EglHandle, int*,
                              int*) = library_.function<decltype(initialize_)>("eglInitialize");
  unsigned int (*bind_api_)(unsigned int) = library_.function<decltype(bind_api_)>("eglBindAPI");
  unsigned int (*choose_config_)(EglHandle, const int*, EglHandle*, int,
                                 int*) = library_.function<decltype(choose_config_)>("eglChooseConfig");
  EglHandle (*create_context_)(EglHandle, EglHandle, EglHandle,
                               const int*) = library_.function<decltype(create_context_)>("eglCreateContext");
  unsigned int (*destroy_context_)(EglHandle, EglHandle) =
      library_.function<decltype(destroy_context_)>("eglDestroyContext");
  unsigned int (*make_current_)(EglHandle, EglHandle, EglHandle,
                                EglHandle) = library_.function<decltype(make_current_)>("eglMakeCurrent");
  EglHandle (*get_current_context_)() =
      library_.function<decltype(get_current_context_)>("eglGetCurrentContext");
  EglHandle display_ = nullptr;
  EglHandle handle_ = nullptr;
};

}  // namespace

std::unique_ptr<GlContext> create_egl_context() { return std::make_unique<EglContext>(); }

}  // namespace softcell::render
