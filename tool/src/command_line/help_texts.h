#pragma once
// The documentation that the command generates of itself: the manual page and the completions of shells.

#include <string>

#include "command_tree.h"

namespace softcell::tool {

/// softcell(1) in the macros of man(7). @param version  of softcell, for the footer.
std::string manual_page(const CommandVerb& top, const std::string& version);

/// A script for bash to source: it completes verbs, options, the words of choices, files, folders, and the names that `softcell scenes`
/// lists.
std::string bash_completion(const CommandVerb& top);

/// The same for zsh, which emulates bash's completion.
std::string zsh_completion(const CommandVerb& top);

/// The same for fish, with the help text of each word.
std::string fish_completion(const CommandVerb& top);

}  // namespace softcell::tool
