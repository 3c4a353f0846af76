#pragma once
// A few numbers that are added together: the payload of a sum over regions.

#include <cstddef>

namespace softcell::ppu {

/// `kCount` numbers, contiguous and aligned so that an addition is a handful of SIMD additions without
/// shuffles.
template <typename Real, std::size_t kCount>
struct alignas(16) Lanes {
  Real lane[kCount];

  Real& operator[](std::size_t i) { return lane[i]; }
  const Real& operator[](std::size_t i) const { return lane[i]; }
  Lanes& operator+=(const Lanes& other) {
    for (std::size_t i = 0; i < kCount; ++i) lane[i] += other.lane[i];
    return *this;
  }
};

}  // namespace softcell::ppu
