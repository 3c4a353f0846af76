#include "softcell/render/offscreen_context.h"

#include <cstdlib>
#include <stdexcept>
#include <string>

#include "backends.h"

namespace softcell::render {

std::unique_ptr<GlContext> create_offscreen_context(Backend backend) {
  if (backend == Backend::kEgl) return create_egl_context();
  if (backend == Backend::kOsmesa) return create_osmesa_context();
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
  // Without these the code generator takes all that the processor has. Measured with Mesa 22.3.6 on one that
  // has AVX-512, 960 x 540 pixels, 115,000 triangles: a frame takes 3 % longer with avx than with nothing
  // set, about 30 % longer with sse4.1 or sse2, and 15 % longer with vectors of 128 bits. The width never
  // changed a pixel; avx gives the pixels of nothing set; sse4.1 and below, which have no fused multiply-add,
  // differ by 1 in 0.01 % of them. A width of 512 crashes.
  ::setenv("GALLIUM_OVERRIDE_CPU_CAPS", "avx", 1);
  ::setenv("LP_NATIVE_VECTOR_WIDTH", "256", 1);
}

}  // namespace softcell::render
