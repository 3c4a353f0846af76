#pragma once
// A scene or a lattice from its text, as plain data: read as TOML, or what a script in Lua returns.

#include <memory>
#include <string>
#include <string_view>

#include "value.h"

namespace softcell::demos {

/// Reads TOML. @param file  as errors name it.
/// @throws SceneError  not TOML, or dates and times, which no scene has.
Value parse_toml(std::string_view text, const std::shared_ptr<const std::string>& file);

/// Runs the chunk in a child process with limits on time and memory (lua_sandbox.h), and reads the plain data
/// that it returns. Every value's place is the line at which the chunk ended.
///
/// Forks: call it before threads are started, since a child has only the calling one, and locks that others
/// hold stay locked in it.
/// @param file  as errors name it.
/// @throws SceneError  a mistake in the chunk, data that is not plain, or a limit passed. Never takes longer
/// than kLuaAnswerSeconds and a little.
Value run_lua(std::string_view chunk, const std::shared_ptr<const std::string>& file);

/// Seconds after which a child that has not answered is killed.
inline constexpr double kLuaAnswerSeconds = 12;

}  // namespace softcell::demos
