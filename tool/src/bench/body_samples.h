#pragma once
// Work for the kernels of soft bodies, to measure their stacks with: it takes lattices and plans to make it.

#include <span>

#include "kernel_runs/kernel_samples.h"

namespace softcell::tool {

/// Of match, match_2d, match_tiles and skin.
std::span<const KernelSample> body_samples();

}  // namespace softcell::tool
