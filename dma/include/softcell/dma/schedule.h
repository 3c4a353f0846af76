#pragma once
// When queued transfers happen. The hardware may finish one at any time between its issue and the wait for
// its tag; a correct kernel gives the same bits under every schedule, one that reads or overwrites too early
// does not.

#include <cstdint>
#include <string>
#include <string_view>

namespace softcell::dma {

struct Schedule {
  enum Kind : std::uint8_t {
    kEager,  ///< at issue, or as soon as what they wait for is done
    kLazy,   ///< as late as waits, a full queue, ordering and Mfc::kMostVisits allow; of several that may go,
             ///< the last issued first
    kRandom,  ///< at random moments, line by line, in any order that fences, barriers and tags allow; what a
              ///< get is about to overwrite is poisoned first; reproducible by the seed
  };
  Kind kind = kEager;
  std::uint64_t seed = 0;  ///< of kRandom only

  bool operator==(const Schedule&) const = default;
};

/// Reads "eager", "lazy" or "random:SEED", SEED a decimal number of at most 64 bits.
/// @throws std::invalid_argument  anything else; the sentence says what is allowed.
Schedule parse_schedule(std::string_view text);

/// The text that parse_schedule() reads back.
std::string to_string(const Schedule& schedule);

}  // namespace softcell::dma
