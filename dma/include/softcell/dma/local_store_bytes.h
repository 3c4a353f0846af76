#pragma once
// Writes to the part of a local store that holds instructions, has held them or will hold them. These
// functions use ordinary vector stores only, never the string instructions (`rep movsb`, `rep stosb`) that
// the host's memmove and memset choose for longer ranges. storage_port.h says which bytes this concerns.
//
// In one of thirty runs on one kind of host, a thread copied code with `rep movsb` and then executed the old
// bytes. With vector stores this never happened. docs/notes/performance.md has the figures, docs/reference/emulator.md says what the
// processors' manuals promise.

#include <cstddef>

namespace softcell::dma {

/// Copies bytes to a local store. If both addresses are multiples of 16, each quadword is written in one access. If the ranges overlap, the
/// result is unspecified. Any thread. A processor must be serialised before it executes the copied bytes (in softcell's sources,
/// ls_sim/src/native/serialise.h).
void copy_to_local_store(std::byte* to, const std::byte* from, std::size_t bytes);

/// Sets bytes of a local store to `value`, in the same way.
void fill_local_store(std::byte* to, std::byte value, std::size_t bytes);

/// Flushes bytes from all caches of the host, for bytes that were copied in another way and turn out to be instructions. Their values do
/// not change. Any thread; takes about 0.1 ms for a whole local store.
void flush_local_store(const std::byte* begin, std::size_t bytes);

}  // namespace softcell::dma
