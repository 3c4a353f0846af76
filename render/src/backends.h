#pragma once
// The two kinds of offscreen context, one file each.

#include <memory>

#include "softcell/render/gl_context.h"

namespace softcell::render {

std::unique_ptr<GlContext> create_osmesa_context();
std::unique_ptr<GlContext> create_egl_context();

}  // namespace softcell::render
