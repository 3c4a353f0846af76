#pragma once

#include <string>

#include "command_tree.h"

namespace softcell::tool {

/// A script that bash sources: completes verbs, options, the words of choices, files, folders, and the names
/// that `softcell scenes` lists.
std::string bash_completion(const CommandVerb& top);

/// The same for zsh, by its emulation of bash's completion.
std::string zsh_completion(const CommandVerb& top);

}  // namespace softcell::tool
