#pragma once
// Sources to objects. An object holds both flavours of its code: the checked one, which calls softcell before each load
// and store, in its section .softcell.checked.

#include <filesystem>
#include <string>

#include "options.h"
#include "places.h"
#include "process.h"

namespace softcell::toolchain {

inline constexpr const char kCheckedSection[] = ".softcell.checked";

/// Compiles one source. @throws Failed  the compiler has said why.
void compile(const Input& source, const std::filesystem::path& object, const Options& options,
             const Places& places, ScratchFolder& scratch);

/// -E and -M: what the preprocessor makes of the sources.
void preprocess(const Options& options, const Places& places);

/// Writes a file into a file of objects as a section of its own.
void add_section(const std::filesystem::path& object, const std::string& section,
                 const std::filesystem::path& file);

}  // namespace softcell::toolchain
