#pragma once
// Lists the instructions of kernels built for the host.

#include <vector>

#include "softcell/dma/addresses.h"
#include "softcell/ls_sim/image.h"

namespace softcell::tool {

/// An instruction in the form that coverage needs.
struct CoveredInstruction {
  dma::LocalStoreAddress address;
  bool is_conditional = false;  ///< a branch that may go either way
};

/// The instructions from `begin` to `end`, which must be inside the image. @pre Machine::kHost
/// @throws std::runtime_error  there is no memory for the disassembler.
std::vector<CoveredInstruction> list_host_instructions(const ls_sim::KernelImage& image,
                                                       dma::LocalStoreAddress begin,
                                                       dma::LocalStoreAddress end);

}  // namespace softcell::tool
