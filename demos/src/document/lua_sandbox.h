#pragma once
// What runs in the child process of run_lua().
//
// A chunk can use what a scene needs: numbers, texts, tables, the functions listed in lua_sandbox.cpp.
// Left out is what reaches files or other programs, what catches errors (a limit must end the chunk), what
// can run for ever inside Lua's own C code, where no hook comes by (string patterns, string.rep, table.move,
// finalizers by setmetatable), and what differs from run to run (pairs, which follows addresses).

#include <cstddef>
#include <lua.hpp>
#include <string_view>

#include "value_message.h"

namespace softcell::demos {

inline constexpr std::size_t kLuaMaxBytes = std::size_t{64} << 20;
inline constexpr double kLuaSeconds = 1;       ///< of processor time
inline constexpr double kLuaWallSeconds = 10;  ///< by the clock: much more, for machines that are busy

/// Writes the message (value_message.h) to the file descriptor and ends the process. Sets limits on processor
/// time, memory and files of the process first.
[[noreturn]] void run_sandboxed(std::string_view chunk, int descriptor);

/// Writes the value on top of the stack. Runs nothing of the chunk's: no metamethods.
/// @throws std::runtime_error  it is not plain data: numbers that are finite, texts, booleans, arrays without
/// holes, tables whose keys are names, not in each other without end; or it is more than a message holds.
void write_result(lua_State* state, MessageWriter& writer);

}  // namespace softcell::demos
