#pragma once
// Names of functions: a symbol as the source has it, and the function that an address lies in.

#include <string>
#include <string_view>

#include "softcell/ls_sim/image.h"

namespace softcell::ls_sim {

/// A C++ symbol as the source has it: "step(Map&)". Any other symbol is returned as it is, also that of a damaged file.
std::string demangled(std::string_view symbol);

/// The function that an instruction lies in; null: the image names none there.
const ImageObject* function_of(const KernelImage& image, dma::LocalStoreAddress address);

/// The function of an SPU program that an address lies in: "main + 0x20". Empty where the image names nothing.
std::string function_at(const KernelImage& image, dma::LocalStoreAddress address);

}  // namespace softcell::ls_sim
