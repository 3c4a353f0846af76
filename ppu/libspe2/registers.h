#pragma once
// Problem state as the PPU program's memory.

#include <cstdint>

struct spe_context;

namespace softcell::libspe2 {

/// Does what a load or store of 4 bytes at an offset from the context's local store does. Any thread.
/// @return  false: no register can be accessed there in this way; standard error says why.
bool access_register(spe_context& context, std::uint32_t offset, bool is_store, std::uint32_t& value);

/// From now on loads and stores of 4 bytes at the areas of spe_ps_area_get() reach the registers there.
void map_registers();

}  // namespace softcell::libspe2
