#pragma once
// Calls of the C library that the PPU side serves for a program on an SPE.  [libspe2, C99 handler; newlib, jsre.h] documented

#include <cstdint>
#include <span>

#include "softcell/dma/addresses.h"

namespace softcell::ls_sim::assisted {

/// The functions' numbers. [newlib, c99ppe.h and jsre.h] documented
enum C99Function : std::uint32_t {
  kFflush = 5,
  kFputc = 11,
  kFputs = 12,
  kFwrite = 18,
  kPutc = 23,
  kPutchar = 24,
  kPuts = 25,
  kVfprintf = 35,
  kVprintf = 37,
  kVsnprintf = 39,
  kVsprintf = 40
};

/// Serves one call. Output goes to the standard output or error of this process. Any thread.
/// @param local_store  all 256 KB of it
/// @param request      the function's number in the upper 8 bits, and the local-store address of its arguments: a quadword each, with
///                     the value in word 0. A va_list is that of the x32 ABI.
/// @return  what the function returns; ~0 for one that is not served.
std::uint32_t serve_c99_call(std::span<std::byte> local_store, std::uint32_t request);

}  // namespace softcell::ls_sim::assisted
