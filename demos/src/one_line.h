#pragma once

#include <string>
#include <string_view>

namespace softcell::demos {

/// A sentence as it may be printed, whatever a file has put into it: in one line, control characters and what
/// is no UTF-8 as "\x1b", and no longer than some 2000 bytes: of a longer one beginning and end.
std::string one_line(std::string_view sentence);

}  // namespace softcell::demos
