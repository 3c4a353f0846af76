#pragma once

#include <lua.hpp>
#include <stdexcept>

#include "value_message.h"

namespace softcell::demos {

/// Writes the value on top of the stack. Runs nothing of the chunk's: no metamethods.
/// @throws std::runtime_error  it is not plain data: numbers that are finite, texts, booleans, arrays without
/// holes, tables whose keys are names, not in each other without end; or it is more than a message holds.
void write_result(lua_State* state, MessageWriter& writer);

}  // namespace softcell::demos
