#pragma once
// The code that runs in the child process of run_lua().
//
// A chunk can use what a scene needs: numbers, texts, tables, and the functions listed in lua_sandbox.cpp. The sandbox leaves out what
// reaches files or other programs, what catches errors (a limit must end the chunk), what can run for ever inside Lua's own C code, where
// no hook is called (string patterns, string.rep, table.move, finalizers by setmetatable), and what differs from run to run (pairs, which
// follows addresses).

#include <cstddef>
#include <lua.hpp>
#include <string_view>

#include "value_message.h"

namespace softcell::demos {

inline constexpr std::size_t kLuaMaxBytes = std::size_t{64} << 20;
inline constexpr double kLuaSeconds = 1;       ///< of processor time
inline constexpr double kLuaWallSeconds = 10;  ///< wall-clock time: much more, for busy machines

/// Sets limits on the processor time, memory and files of the process, runs the chunk, writes its result as a message (value_message.h) to
/// the file descriptor, and ends the process.
[[noreturn]] void run_sandboxed(std::string_view chunk, int descriptor);

/// Writes the value on top of the stack. Runs no code of the chunk: no metamethods.
/// @throws std::runtime_error  the value is not plain data: finite numbers, texts, booleans, arrays without holes, and tables whose keys
/// are names, nested to a limited depth; or it is longer than a message may be.
void write_result(lua_State* state, MessageWriter& writer);

}  // namespace softcell::demos
