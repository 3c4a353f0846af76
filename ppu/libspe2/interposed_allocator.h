#pragma once
// What the interposed allocator tells about the heap: the symbol `softcell_interposed_allocator` of its library.

#include <cstdint>

struct SoftcellAllocation {
  std::uint64_t begin, bytes;
  std::uint64_t caller;  ///< where the call of malloc returns to
  int live;              ///< 0: it was freed
};

/// Any thread.
struct SoftcellAllocator {
  /// The block with the highest begin at or below the address. @return  0: there is none.
  int (*last_at_or_below)(std::uint64_t address, SoftcellAllocation* block);
  /// Whether the heap of the C library is there. @return  0: no.
  int (*owns)(std::uint64_t address);
  /// Changes whenever a block ends.
  std::uint64_t (*generation)();
};
