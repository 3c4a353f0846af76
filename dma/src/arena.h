#pragma once
// One range of emulated memory: host pages behind it, and a first-fit allocator over it.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "softcell/base/assert.h"
#include "softcell/dma/addresses.h"

namespace softcell::dma {

/// Not thread safe: the address space guards it.
class Arena {
 public:
  /// Reserves host addresses for the range; pages become real when first touched, and read as zero.
  /// @param base, bytes  multiples of the host's page size.
  /// @throws std::runtime_error  the host has no address range left.
  Arena(EffectiveAddress base, std::uint64_t bytes);
  ~Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  /// Takes the lowest free range that fits. Its bytes are zero.
  /// @param bytes  at least 1; rounded up to lines of 128.
  /// @return  nothing when no free range is large enough.
  std::optional<EffectiveAddress> allocate(std::uint64_t bytes);

  /// Gives back what allocate() returned for `bytes`, and joins it with free neighbours.
  void free(EffectiveAddress ea, std::uint64_t bytes);

  std::byte* host(EffectiveAddress ea) const {
    SC_ASSERT(ea.value - base_.value < bytes_, "{} is not in the {} bytes from {} on", ea, bytes_, base_);
    return host_ + (ea.value - base_.value);
  }

  std::uint64_t bytes() const { return bytes_; }
  std::uint64_t free_bytes() const;
  std::uint64_t largest_free_range() const;

 private:
  EffectiveAddress base_;
  std::uint64_t bytes_;
  std::byte* host_;
  std::map<std::uint64_t, std::uint64_t> free_;  // offset -> bytes; never empty ranges, never two that touch
  std::uint64_t touched_ = 0;                    // offsets from here on were never handed out and are zero
};

}  // namespace softcell::dma
