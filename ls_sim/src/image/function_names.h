#pragma once
// From an address of an SPU program to the function that it lies in.

#include <string>

#include "softcell/ls_sim/image.h"

namespace softcell::ls_sim {

/// "main + 0x20", or an empty string where the image names nothing.
std::string function_at(const KernelImage& image, dma::LocalStoreAddress address);

}  // namespace softcell::ls_sim
