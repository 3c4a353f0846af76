#include "softcell/dma/element_layout.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

namespace softcell::dma {

ElementLayout::ElementLayout(std::span<const ElementRun> record) {
  constexpr std::uint64_t kMost = std::numeric_limits<std::int32_t>::max();
  std::uint64_t end = 0;
  for (const ElementRun& run : record) {
    const std::uint32_t width = run.element_bytes;
    if (width != 1 && width != 2 && width != 4 && width != 8)
      throw std::invalid_argument("a record with elements of " + std::to_string(width) +
                                  " bytes; allowed are 1, 2, 4 and 8");
    if (run.bytes == 0 || run.bytes % width != 0 || end % width != 0 || run.bytes > kMost - end)
      throw std::invalid_argument("a record with " + std::to_string(run.bytes) + " bytes of elements of " +
                                  std::to_string(width) + " at " + std::to_string(end) +
                                  "; expected whole elements at multiples of their width");
    end += run.bytes;
    runs_.push_back({static_cast<std::uint32_t>(end), width});
  }
  if (runs_.empty()) throw std::invalid_argument("a record without elements");
  for (const Run& run : runs_) {
    if (end % run.element_bytes != 0)
      throw std::invalid_argument("a record of " + std::to_string(end) + " bytes with elements of " +
                                  std::to_string(run.element_bytes) +
                                  ": expected a multiple of each width, since the record repeats");
  }
}

ElementRun ElementLayout::run_at(std::uint64_t offset) const {
  const auto place = static_cast<std::uint32_t>(offset % runs_.back().end);
  const auto run = std::ranges::upper_bound(runs_, place, {}, &Run::end);
  return {.bytes = run->end - place, .element_bytes = run->element_bytes};
}

}  // namespace softcell::dma
