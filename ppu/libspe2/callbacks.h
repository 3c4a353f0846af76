#pragma once
// Functions of the PPU side that SPE programs call.

namespace softcell::libspe2 {

/// A handler gets the local store and the word of the call: operation << 24 | local-store address.
using Callback = int(void* ls_base, unsigned int ls_address);

/// @return  null: none. Any thread.
Callback* callback_of(unsigned int callnum);

}  // namespace softcell::libspe2
