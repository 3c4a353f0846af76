#pragma once
// One pinned context for all cases of a test program: a process uses one backend.

#include <memory>

#include "softcell/render/offscreen_context.h"

namespace softcell::render::test {

inline GlContext& pinned_context() {
  static const std::unique_ptr<GlContext> context = [] {
    pin_software_rasterizer();
    return create_offscreen_context();
  }();
  return *context;
}

}  // namespace softcell::render::test
