#pragma once
// Memory below 4 GB: the pointers of a kernel have 32 bits, as an SPU's.

#include <cstddef>

namespace softcell::ls_sim {

/// Reserves inaccessible pages that lie below 4 GB as a whole. Give them back by munmap(). Any thread.
/// @param bytes  a multiple of the page size
/// @param what   what they are for, as an error says it: "a local store"
/// @throws std::runtime_error  there is no room below 4 GB, or the host refuses.
void* reserve_below_4_gb(std::size_t bytes, const char* what);

}  // namespace softcell::ls_sim
