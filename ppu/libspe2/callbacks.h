#pragma once
// Functions of the PPU side that SPE programs call.

namespace softcell::libspe2 {

/// A handler gets the local store and the word of the call: operation << 24 | local-store address.
using Callback = int(void* ls_base, unsigned int ls_address);

/// The first numbers are those of the C library, POSIX and others that SPU programs bring. [libspe2] documented
inline constexpr unsigned int kLibraries = 4;

/// @return  null: none. Any thread.
Callback* callback_of(unsigned int callnum);

}  // namespace softcell::libspe2
