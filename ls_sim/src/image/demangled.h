#pragma once

#include <string>
#include <string_view>

namespace softcell::ls_sim {

/// A C++ symbol as the source has it: "step(Map&)"; any other symbol as it is. Of hostile files, too.
std::string demangled(std::string_view symbol);

}  // namespace softcell::ls_sim
