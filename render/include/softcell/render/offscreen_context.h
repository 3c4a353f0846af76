#pragma once
// OpenGL without a window. Mesa is loaded at run time, never linked: its libraries export the same symbols as libGL, and a program must
// also start on a machine that has neither.

#include <memory>

#include "softcell/render/gl_context.h"

namespace softcell::render {

enum class Backend {
  kAutomatic,  ///< OSMesa, else EGL
  kOsmesa,     ///< libOSMesa: always in software; gone from Mesa 25.1 on
  kEgl,        ///< libEGL on Mesa's surfaceless platform; in software after pin_software_rasterizer()
};

/// Makes a context and makes it current on the calling thread.
/// @throws std::runtime_error  names the missing library and the package that contains it, or what Mesa refused.
std::unique_ptr<GlContext> create_offscreen_context(Backend backend = Backend::kAutomatic);

/// Makes pictures the same on every processor with AVX and FMA, which softcell's native engine needs anyway.
/// Selects Mesa's software rasterizer llvmpipe, fixes the instruction set and vector width of its code
/// generator, and switches off its shader cache on disk. This costs no speed. On an older processor, single
/// pixels differ by 1. The function sets environment variables of this process: call it at the beginning of
/// main(), before the first thread and the first context.
void pin_software_rasterizer();

}  // namespace softcell::render
