#pragma once
// Words of a command that is shown to be typed in a shell.

#include <string>
#include <vector>

namespace softcell::tool {

/// The word as a shell reads it: in quotes, if it needs them.
std::string quoted_for_shell(const std::string& word);

/// The words with spaces between them.
std::string quoted_for_shell(const std::vector<std::string>& words);

}  // namespace softcell::tool
