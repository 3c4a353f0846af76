#pragma once
// How bytes get to where a local store holds instructions, or did, or will: with ordinary vector stores only,
// never with the string instructions (`rep movsb`, `rep stosb`) that the host's memmove and memset choose for
// longer ranges. storage_port.h says which bytes these are.
//
// Code that `rep movsb` had just copied was seen to be executed as it was before, by the thread that had
// copied it, in one of thirty runs on one kind of host; with vector stores it never was.
// docs/notes/performance.md has the figures, docs/reference/architecture.md says what the processors' manuals promise.

#include <cstddef>

namespace softcell::dma {

/// Copies `bytes` to a local store. If both addresses are multiples of 16, each quadword arrives whole. The
/// ranges may overlap; then what arrives is not specified. Any thread. A processor that is to execute what
/// was copied must be serialised after the copy: ls_sim/src/native/serialise.h.
void copy_to_local_store(std::byte* to, const std::byte* from, std::size_t bytes);

/// Sets `bytes` of a local store to `value`, likewise.
void fill_local_store(std::byte* to, std::byte value, std::size_t bytes);

/// For bytes that turn out to be instructions after they have been copied in another way: takes them out of
/// all caches of the host. They stay as they are. Any thread; some 0.1 ms for a whole local store.
void flush_local_store(const std::byte* begin, std::size_t bytes);

}  // namespace softcell::dma
