#pragma once
// The files of demos/report/, which the build puts into the program.

#include <span>
#include <string_view>

namespace softcell::demos {

std::string_view report_template();
std::string_view report_style();

/// In the order in which they build on each other.
std::span<const std::string_view> report_scripts();

}  // namespace softcell::demos
