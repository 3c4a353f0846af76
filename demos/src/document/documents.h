#pragma once
// Reads a scene or a lattice from its text as plain data: the text is TOML, or a Lua script that returns the data.

#include <memory>
#include <string>
#include <string_view>

#include "value.h"

namespace softcell::demos {

/// Parses TOML. @param file  the file's name in error messages
/// @throws SceneError  the text is not TOML, or contains dates or times, which no scene has.
Value parse_toml(std::string_view text, const std::shared_ptr<const std::string>& file);

/// Runs the chunk in a child process with limits on time and memory (lua_sandbox.h), and reads the plain data
/// that it returns. Every value's location is the line at which the chunk ended.
///
/// It forks: call it before threads are started. The child has only the calling thread, and locks that other threads hold stay locked in
/// it.
/// @param file  the file's name in error messages
/// @throws SceneError  a mistake in the chunk, data that is not plain, or a limit exceeded. The call takes hardly longer than
/// kLuaAnswerSeconds.
Value run_lua(std::string_view chunk, const std::shared_ptr<const std::string>& file);

/// Seconds after which a child that has not answered is killed.
inline constexpr double kLuaAnswerSeconds = 12;

}  // namespace softcell::demos
