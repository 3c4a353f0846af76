#pragma once
// The verbs that this build of the command has: all_verbs.cpp defines them or, without demos, kernel_verbs.cpp.

#include <span>
#include <string_view>

#include "command_line/verb.h"

namespace softcell::tool {

/// In the order in which --help lists them.
Verbs all_verbs();

/// The verbs that only builds with demos have; empty in such a build.
std::span<const std::string_view> left_out_verbs();

}  // namespace softcell::tool
