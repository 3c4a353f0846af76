#pragma once

#include <cstdint>

namespace CLI {
class Option;
}  // namespace CLI

namespace softcell::demos {

/// Lets the option be nothing but a whole number in decimal digits, from `least`, which is above 0, to
/// `most`.
/// @return the option
CLI::Option* take_whole_number(CLI::Option* option, std::uint64_t least, std::uint64_t most);

}  // namespace softcell::demos
