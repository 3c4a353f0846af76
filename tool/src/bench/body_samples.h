#pragma once
// Work for the kernels of soft bodies, for measuring their stacks. Making it needs lattices and plans.

#include <span>

#include "kernel_runs/kernel_samples.h"

namespace softcell::tool {

/// Samples for match, match_2d, match_tiles, skin and the other kernels of soft bodies.
std::span<const KernelSample> body_samples();

}  // namespace softcell::tool
