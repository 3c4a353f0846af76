#pragma once
// The plan of the kernel `match_tiles`: a body that no local store holds, cut into tiles.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "match_tiles_job.h"
#include "ppu/matching/matching_plan.h"
#include "ppu/plans/kernel_plan.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// How large a tile is, in particles; 0: as the plan sees fit.
struct TileShape {
  int planes = 0;  ///< along x
  int rows = 0;    ///< along y; along z a tile is as high as the body
};

/// Which tile does what, slice by slice, and the constants that it needs for it. Immutable, the same bytes on
/// every host.
///
/// Nothing is decided by geometry alone: a tile makes every sum that its regions and particles rest on, and
/// those on which these sums rest, by the rules that MatchPlan has for the whole body. So any lattice with
/// any half-width can be cut anywhere, and the shape of tiles changes nothing but the cost. What a slice
/// keeps for later slices, and until when, is found here too: slots of the local store are given out and
/// taken back as a compiler does with registers.
///
/// @see match_tiles_job.h for passes and places, docs/notes/performance.md for what was chosen and why
class TilePlan {
 public:
  struct Tile {
    std::vector<spu::TileSlice> up;          ///< of `gather` and `twist`
    std::vector<spu::TileSlice> down, damp;  ///< of `scatter`, and the same for `damp`
  };

  /// @param arena_bytes  what the kernel has for a tile: kTileArenaBytes, or of its instrumented flavour
  ///                     kTileCheckedArenaBytes. Says nothing about the result.
  /// @throws BodyTooLarge           a slice does not fit a local store: the lattice is too high (z).
  /// @throws std::invalid_argument  a shape below zero.
  TilePlan(const Lattice<3>& lattice, const MatchingPlan<float, 3>& matching, TileShape shape = {},
           std::uint32_t arena_bytes = spu::kTileArenaBytes);

  std::span<const Tile> tiles() const { return tiles_; }

  /// What does not change from step to step, its addresses left 0.
  const spu::TiledBody& body() const { return body_; }

  /// Particle -> where it is in positions and velocities. Ascending; the places between are padding.
  std::span<const std::uint32_t> place_of() const { return place_of_; }
  std::size_t places() const { return 4 * rest_.size(); }            ///< of particles, padding included
  std::size_t region_places() const { return 4 * regions_.size(); }  ///< likewise

  /// Sum lists and offsets, which TileSlice refers to; each once, however many slices are alike.
  std::span<const std::byte> lists() const { return std::as_bytes(std::span(lists_)); }
  std::span<const spu::TileRest> rest() const { return rest_; }
  std::span<const spu::TileWeights> weights() const { return weights_; }
  std::span<const spu::MatchRegions> regions() const { return regions_; }

 private:
  spu::TiledBody body_{};
  std::vector<Tile> tiles_;
  std::vector<std::uint32_t> place_of_;
  std::vector<std::uint32_t> lists_;
  std::vector<spu::TileRest> rest_;
  std::vector<spu::TileWeights> weights_;
  std::vector<spu::MatchRegions> regions_;
};

}  // namespace softcell::ppu
