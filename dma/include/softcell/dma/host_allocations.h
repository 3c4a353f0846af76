#pragma once
// What an allocator that replaces the C library's knows of a host program's heap.

#include <cstdint>
#include <optional>
#include <string>

namespace softcell::dma {

/// One block that a program has allocated.
struct HostAllocation {
  std::uint64_t begin = 0;  ///< address of its first byte
  std::uint64_t bytes = 0;  ///< as requested
  bool live = true;         ///< false: the program has freed it
  std::string made_at;      ///< where it was allocated: a function or an address of the program, in words
};

/// Any thread.
class HostAllocations {
 public:
  virtual ~HostAllocations() = default;

  /// The block with the highest begin at or below `address`, if the allocator knows one.
  virtual std::optional<HostAllocation> last_at_or_below(std::uint64_t address) const = 0;

  /// Whether the whole heap around this address belongs to the allocator: bytes in no block there are not allocated.
  virtual bool owns(std::uint64_t address) const = 0;

  /// A number that changes whenever a block ends.
  virtual std::uint64_t generation() const = 0;
};

}  // namespace softcell::dma
