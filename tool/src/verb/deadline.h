#pragma once
// The value of --deadline.

#include <chrono>
#include <string>

namespace softcell::tool {

/// "2.5": seconds from 0.001 to 86400.
std::chrono::milliseconds parse_deadline(const std::string& text);

}  // namespace softcell::tool
