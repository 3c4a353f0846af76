#pragma once
// Headers that programs for the Cell include, and that SPU programs do not have here: what to say of them.

#include <optional>
#include <string>
#include <string_view>

namespace softcell::toolchain {

/// A sentence about a header of the C or C++ library, or of the PPU side; nothing: it is another one.
std::optional<std::string> why_missing(std::string_view header);

}  // namespace softcell::toolchain
