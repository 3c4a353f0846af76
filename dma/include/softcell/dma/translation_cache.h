#pragma once
// An MFC's own copies of the mappings that it used last, so that most commands take no lock. It is the
// hardware's TLB.

#include <array>
#include <cstddef>
#include <cstdint>
#include <variant>

#include "softcell/dma/address_space.h"

namespace softcell::dma {

/// Used by one thread. Other threads may change the address space at any time; its generation number says
/// when copies are stale.
class TranslationCache {
 public:
  explicit TranslationCache(const AddressSpace& space) : space_(&space) {}

  /// Does what AddressSpace::resolve() does, faster.
  std::variant<std::byte*, Fault> resolve(EffectiveAddress ea, std::uint64_t bytes, SpeAccess wanted) {
    if (space_->generation() == generation_) {
      for (const Mapping& mapping : entries_) {
        if (mapping.contains(ea, bytes) && mapping.permits(wanted)) return mapping.host_of(ea);
      }
    }
    return resolve_slowly(ea, bytes, wanted);
  }

 private:
  // Descriptor, image, inputs and outputs of a usual job, and the local stores of the other SPEs.
  static constexpr std::size_t kEntries = 16;

  std::variant<std::byte*, Fault> resolve_slowly(EffectiveAddress ea, std::uint64_t bytes, SpeAccess wanted);

  const AddressSpace* space_;
  std::uint64_t generation_ = 0;             // of the entries
  std::array<Mapping, kEntries> entries_{};  // one of 0 bytes holds no address
  std::size_t next_ = 0;                     // to be replaced
};

}  // namespace softcell::dma
