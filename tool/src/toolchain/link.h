#pragma once
// Links objects to a program: an image of a local store, with its checked image in a section.

#include <filesystem>

#include "options.h"
#include "places.h"
#include "process.h"

namespace softcell::toolchain {

/// Links objects and archives, in order; with `options.relocatable` into one object.
/// @throws Failed  the linker has printed why.
void link(const Words& files, const std::filesystem::path& output, const Options& options,
          const Places& places, ScratchFolder& scratch);

}  // namespace softcell::toolchain
