#pragma once

#include <string>

#include "command_tree.h"

namespace softcell::tool {

/// softcell(1) in the macros of man(7). @param version  of softcell, for the footer.
std::string manual_page(const CommandVerb& top, const std::string& version);

}  // namespace softcell::tool
