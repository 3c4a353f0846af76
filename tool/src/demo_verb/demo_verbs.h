#pragma once
// softcell demo 2d, demo 3d and scenes.

#include <memory>

#include "command_line/verb.h"
#include "demo_options.h"

namespace softcell::tool {

/// @return the exit status: 0, 3 when checked kernels have findings, or 130 when interrupted.
int run_demo_2d(const Demo2dOptions& options);
int run_demo_3d(const Demo3dOptions& options);

std::unique_ptr<Verb> demo_verbs();
std::unique_ptr<Verb> scenes_verb();

}  // namespace softcell::tool
