#include "softcell/dma/translation_cache.h"

#include <optional>

#include "softcell/base/assert.h"

namespace softcell::dma {

std::variant<std::byte*, Fault> TranslationCache::resolve_slowly(EffectiveAddress ea, std::uint64_t bytes,
                                                                 SpeAccess wanted) {
  // The generation is read before the mapping: a mapping that ends in between leaves an entry that is already
  // stale.
  const std::uint64_t generation = space_->generation();
  if (generation != generation_) {
    entries_.fill({});
    generation_ = generation;
  }
  const std::optional<Mapping> mapping = space_->mapping_at(ea, wanted);
  if (!mapping || !mapping->contains(ea, bytes) || !mapping->permits(wanted)) {
    return space_->resolve(ea, bytes, wanted);  // the fault, in words
  }
  SC_ASSERT(mapping->host != nullptr, "the mapping at {} has no bytes", mapping->ea);
  entries_[next_] = *mapping;
  next_ = (next_ + 1) % kEntries;
  return mapping->host_of(ea);
}

}  // namespace softcell::dma
