#pragma once
// The random numbers of a schedule. They are the same on every host and in every version, because bug reports
// quote seeds.

#include <cstdint>

#include "softcell/base/assert.h"

namespace softcell::dma {

/// splitmix64 (Steele, Lea, Flood 2014): a 64-bit counter whose values are mixed. Used by one thread.
class RandomStream {
 public:
  /// Streams with the same seed and different `stream` are independent.
  RandomStream(std::uint64_t seed, std::uint64_t stream)
      : state_(mix(seed + kGamma) ^ mix(stream * kGamma + 1)) {}

  std::uint64_t next() { return mix(state_ += kGamma); }

  /// A uniform number in 0..bound-1, with a bias below 2^-32 x bound. @pre bound is not 0
  std::uint32_t below(std::uint32_t bound) {
    SC_ASSERT(bound != 0, "a random number below {}", bound);
    return static_cast<std::uint32_t>(((next() >> 32) * bound) >> 32);
  }

 private:
  static constexpr std::uint64_t kGamma = 0x9E3779B97F4A7C15;

  static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EB;
    return z ^ (z >> 31);
  }

  std::uint64_t state_;
};

}  // namespace softcell::dma
