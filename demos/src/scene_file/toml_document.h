#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "value.h"

namespace softcell::demos {

/// Reads TOML. @param file  as errors name it.
/// @throws SceneError  not TOML, or dates and times, which no scene has.
Value parse_toml(std::string_view text, const std::shared_ptr<const std::string>& file);

}  // namespace softcell::demos
