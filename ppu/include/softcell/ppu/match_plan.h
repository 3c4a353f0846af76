#pragma once
// The plan of the kernel `match`: a model's constants and sum lists as the SPE reads them.

#include <cstddef>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <vector>

#include "match_job.h"
#include "softcell/ppu/lattice.h"
#include "softcell/ppu/shape_matching.h"

namespace softcell::ppu {

/// Plan and state of one body need more local store than the kernel has; the sentence states both.
class BodyTooLarge : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A plan in lines of 128 bytes, ready to be copied to main memory. Immutable, the same bytes on every host.
///
/// Bars, plates and regions are SumPlan's; equal ones exist once. What is new is their order: along a row of
/// the lattice each bar follows the one that differs from it by one particle at either end, so that a sum is
/// made from its predecessor by one addition and one subtraction, whatever the half-width; plates and regions
/// likewise. Sums start anew at every kRestart-th place of the lattice, so that rounding errors stay those of
/// a short row and a tile of a large lattice that begins at such a place has the same bits.
class MatchPlan {
 public:
  static constexpr int kRestart = 16;

  /// @throws BodyTooLarge
  MatchPlan(const Lattice& lattice, const MatchingPlan<float>& matching);

  const spu::MatchPlanHeader& header() const;
  std::span<const std::byte> bytes() const;  ///< header() first; a multiple of 128

  /// Particle -> the number of its region in MatchRotations: group number / 4, lane number % 4.
  std::span<const std::uint32_t> region_of() const { return region_of_; }

  /// Additions and subtractions of slots that one sum up takes.
  std::size_t additions() const { return additions_; }

 private:
  struct alignas(128) Line {
    std::byte bytes[128];
  };
  std::vector<Line> lines_;
  std::vector<std::uint32_t> region_of_;
  std::size_t additions_ = 0;
};

}  // namespace softcell::ppu
