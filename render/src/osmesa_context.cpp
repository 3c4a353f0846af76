// OSMesa: Mesa's classic interface for drawing into memory. Declared here because its header includes a GL
// header, which would clash with the loader's. [GL/osmesa.h of Mesa 22.3] documented

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "backends.h"
#include "dynamic_library.h"
#include "softcell/base/assert.h"

namespace softcell::render {
namespace {

constexpr int kOsmesaFormat = 0x22;
constexpr int kOsmesaRgba = 0x1908;
constexpr int kOsmesaDepthBits = 0x30;
constexpr int kOsmesaStencilBits = 0x31;
constexpr int kOsmesaProfile = 0x33;
constexpr int kOsmesaCoreProfile = 0x34;
constexpr int kOsmesaContextMajorVersion = 0x36;
constexpr int kOsmesaContextMinorVersion = 0x37;
constexpr unsigned int kGlUnsignedByte = 0x1401;

struct OsmesaRecord;
using OsmesaHandle = OsmesaRecord*;

class OsmesaContext final : public GlContext {
 public:
  OsmesaContext() {
    const auto create =
        library_.function<OsmesaHandle (*)(const int*, OsmesaHandle)>("OSMesaCreateContextAttribs");
    constexpr int kAttributes[] = {kOsmesaFormat,
                                   kOsmesaRgba,
                                   kOsmesaDepthBits,
                                   0,
                                   kOsmesaStencilBits,
                                   0,
                                   kOsmesaProfile,
                                   kOsmesaCoreProfile,
                                   kOsmesaContextMajorVersion,
                                   3,
                                   kOsmesaContextMinorVersion,
                                   3,
                                   0};
    handle_ = create(kAttributes, nullptr);
    if (handle_ == nullptr) throw std::runtime_error("OSMesa refuses an OpenGL 3.3 core context");
    try {
      make_current();
    } catch (...) {
      destroy_(handle_);
      throw;
    }
  }

  ~OsmesaContext() override {
    // Destroying a context that is current leaves the thread pointing at it.
    make_current_(nullptr, nullptr, 0, 0, 0);
    destroy_(handle_);
  }

  void make_current() override {
    if (make_current_(handle_, window_.data(), kGlUnsignedByte, kWindowSide, kWindowSide) == 0) {
      throw std::runtime_error("OSMesa cannot make its context current");
    }
  }

  Function function(const char* name) const override {
    SC_ASSERT(name != nullptr && handle_ != nullptr, "a GL function of context {}", handle_);
    return function_(name);
  }
  std::string backend_name() const override { return "OSMesa"; }

 private:
  // A window that nobody looks at: the renderer draws into its own framebuffer.
  static constexpr int kWindowSide = 16;

  DynamicLibrary library_{{"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"}, "libosmesa6"};
  unsigned char (*make_current_)(OsmesaHandle, void*, unsigned int, int,
                                 int) = library_.function<decltype(make_current_)>("OSMesaMakeCurrent");
  void (*destroy_)(OsmesaHandle) = library_.function<decltype(destroy_)>("OSMesaDestroyContext");
  Function (*function_)(const char*) = library_.function<decltype(function_)>("OSMesaGetProcAddress");
  OsmesaHandle handle_ = nullptr;
  std::array<std::uint32_t, std::size_t{kWindowSide} * kWindowSide> window_{};
};

}  // namespace

std::unique_ptr<GlContext> create_osmesa_context() { return std::make_unique<OsmesaContext>(); }

}  // namespace softcell::render
