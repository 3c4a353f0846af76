#pragma once
// softcell help, completion and man: the command line itself, for a reader and for a shell.

#include <memory>
#include <string>

#include "verb.h"

namespace softcell::tool {

/// @param version  of the command, as the manual page says it
std::unique_ptr<Verb> shell_verbs(std::string version);

}  // namespace softcell::tool
