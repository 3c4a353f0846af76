#pragma once
// The cycles in which transfers use the port of a local store.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "softcell/base/assert.h"

namespace softcell::ls_sim {

/// A line of a transfer takes one cycle, and has priority over the SPU. Used by the thread that runs the SPE.
/// [IBM SDK tutorial, local store] documented
class PortUse {
 public:
  /// Lines of one command: `lines` of them, evenly from `first` to `last`. @pre lines > 0, first <= last
  void add(std::uint64_t first, std::uint64_t last, std::uint64_t lines) {
    SC_ASSERT(lines > 0 && first <= last, "{} lines from cycle {} to {}", lines, first, last);
    const std::uint64_t interval = lines == 1 ? 1 : std::max<std::uint64_t>(1, (last - first) / (lines - 1));
    bursts_.push_back({first, interval, lines});
    next_ = std::min(next_, first);
  }

  /// The first cycle from `cycle` on that no line takes. Cycles before it are over. @pre never called with less
  std::uint64_t free_from(std::uint64_t cycle) {
    while (cycle >= next_) {
      const bool is_taken = pass(cycle);
      if (!is_taken) break;
      ++cycle;
    }
    return cycle;
  }

 private:
  static constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
  struct Burst {
    std::uint64_t next, interval, left;
  };

  /// Forgets the lines before `cycle`. @return  whether a line takes `cycle`.
  bool pass(std::uint64_t cycle) {
    bool is_taken = false;
    next_ = kNever;
    for (Burst& burst : bursts_) {
      if (burst.next < cycle) {
        const std::uint64_t passed =
            std::min(burst.left, (cycle - burst.next + burst.interval - 1) / burst.interval);
        burst.left -= passed;
        burst.next += passed * burst.interval;
      }
      if (burst.left == 0) continue;
      is_taken = is_taken || burst.next == cycle;
      next_ = std::min(next_, burst.next);
    }
    std::erase_if(bursts_, [](const Burst& burst) { return burst.left == 0; });
    return is_taken;
  }

  std::vector<Burst> bursts_;
  std::uint64_t next_ = kNever;  ///< no line takes a cycle before this one
};

}  // namespace softcell::ls_sim
