#pragma once
// softcell help, completion and man: describe the command line, for a reader and for a shell.

#include <memory>
#include <string>

#include "verb.h"

namespace softcell::tool {

/// @param version  of the command, for the manual page
std::unique_ptr<Verb> shell_verbs(std::string version);

}  // namespace softcell::tool
