#pragma once
// SPU programs that a program has imported.

#include <memory>

#include "lv2.h"

namespace softcell::psl1ght {

/// @return  null: the structure holds none, or it was closed.
std::shared_ptr<const ls_sim::KernelImage> program_of(const sysSpuImage* image);

}  // namespace softcell::psl1ght
