#pragma once
// The memory of a host program as main storage: what the process has mapped, with which permissions.

#include <atomic>
#include <cstdint>
#include <mutex>
#include <optional>
#include <shared_mutex>
#include <string>
#include <variant>
#include <vector>

#include "softcell/dma/address_space.h"
#include "softcell/dma/fault.h"
#include "softcell/dma/host_allocations.h"

namespace softcell::dma {

/// Any thread. It keeps a copy of the process's mappings and reads them anew when the copy does not permit an
/// access. A mapping that ends is noticed later, by host_access.h.
class HostMemory {
 public:
  /// Null: no allocator is asked. It outlives this object.
  void set_allocations(const HostAllocations* allocations) {
    allocations_.store(allocations, std::memory_order_release);
  }

  /// The part around `ea` within which all accesses are alike: of an allocation, or else of a mapping.
  std::optional<Mapping> mapping_at(EffectiveAddress ea, SpeAccess wanted) const;

  /// Does what AddressSpace::resolve() does. The range may reach over several mappings, but not out of an allocation.
  std::variant<std::byte*, Fault> resolve(EffectiveAddress ea, std::uint64_t bytes, SpeAccess wanted) const;

  /// Changes when an allocation ends.
  std::uint64_t generation() const {
    const HostAllocations* allocations = allocations_.load(std::memory_order_acquire);
    return allocations == nullptr ? 0 : allocations->generation();
  }

 private:
  struct Region {
    std::uint64_t begin, end;
    SpeAccess access;
    std::string name;  ///< of the file, or "[heap]", "[stack]"
  };
  using Regions = std::vector<Region>;  // by address; they do not overlap

  static Regions read_regions();
  static const Region* region_at(const Regions& regions, std::uint64_t address);
  static bool covers(const Regions& regions, EffectiveAddress ea, std::uint64_t bytes, SpeAccess wanted);
  bool is_mapped(EffectiveAddress ea, std::uint64_t bytes, SpeAccess wanted) const;
  Fault describe(EffectiveAddress ea, std::uint64_t bytes, SpeAccess wanted) const;
  std::optional<Fault> check_allocation(EffectiveAddress ea, std::uint64_t bytes) const;

  std::atomic<const HostAllocations*> allocations_{nullptr};
  mutable std::shared_mutex mutex_;
  mutable Regions regions_;
};

}  // namespace softcell::dma
