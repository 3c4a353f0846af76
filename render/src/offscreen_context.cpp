#include "softcell/render/offscreen_context.h"

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "backends.h"

namespace softcell::render {

std::unique_ptr<GlContext> create_offscreen_context(Backend backend) {
  if (backend == Backend::egl) return create_egl_context();
  if (backend == Backend::osmesa) return create_osmesa_context();
  try {
    return create_osmesa_context();
  } catch (const std::runtime_error& no_osmesa) {
    try {
      return create_egl_context();
    } catch (const std::runtime_error& no_egl) {
      throw std::runtime_error(std::string("no way to draw without a window: ") + no_osmesa.what() + "; or " +
                               no_egl.what());
    }
  }
}

void pin_software_rasterizer() {
  ::setenv("LIBGL_ALWAYS_SOFTWARE", "true", 1);
  ::setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  ::setenv("GALLIUM_OVERRIDE_CPU_CAPS", "sse2", 1);
  ::setenv("LP_NATIVE_VECTOR_WIDTH", "128", 1);
  ::setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
}

}  // namespace softcell::render
