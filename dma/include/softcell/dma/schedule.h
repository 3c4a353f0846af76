#pragma once
// When queued transfers happen. The hardware may complete a transfer at any time between its issue and the
// wait for its tag. A correct kernel gives the same bits under every schedule; a kernel that reads or
// overwrites too early does not.

#include <cstdint>
#include <string>
#include <string_view>

namespace softcell::dma {

/// When queued transfers happen.
struct Schedule {
  enum Kind : std::uint8_t {
    /// At issue, or as soon as the commands that they wait for are complete.
    kEager,
    /// As late as waits, a full queue, ordering and Mfc::kMostVisits allow. If several may move, the one
    /// issued last moves first.
    kLazy,
    /// At random moments, line by line, in any order that fences, barriers and tags allow. The destination of
    /// a get is poisoned first. The seed reproduces it.
    kRandom,
  };
  Kind kind = kEager;
  std::uint64_t seed = 0;  ///< of kRandom only

  bool operator==(const Schedule&) const = default;
};

/// Reads "eager", "lazy" or "random:SEED", SEED a decimal number of at most 64 bits.
/// @throws std::invalid_argument  anything else; the message says what is allowed.
Schedule parse_schedule(std::string_view text);

/// The text that parse_schedule() reads back.
std::string to_string(const Schedule& schedule);

}  // namespace softcell::dma
