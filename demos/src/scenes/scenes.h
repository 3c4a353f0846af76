#pragma once

#include <optional>

#include "../scene.h"

namespace softcell::demos {

Scene make_arena();
Scene make_drop(const std::optional<OwnModel>& model);

}  // namespace softcell::demos
