#pragma once
// The plan of the kernel `match_tiles`: a body too large for a local store, cut into tiles.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "match_tiles_job.h"
#include "ppu/matching/matching_plan.h"
#include "ppu/plans/kernel_plan.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// The size of a tile in particles; 0: the plan chooses.
struct TileShape {
  int planes = 0;  ///< along x
  int rows = 0;    ///< along y; along z a tile is as high as the body
};

/// The work of each tile, slice by slice, with its constants. Immutable, the same bytes on every host.
///
/// A tile computes every sum that its regions and particles need, and the sums that these need, by MatchPlan's rules for the whole body;
/// geometry alone decides nothing. So any lattice with any half-width can be cut anywhere, and the shape of tiles affects only the cost.
/// The plan also decides which values a slice keeps for later slices, and until when: it allocates slots of the local store by lifetime, as
/// a compiler allocates registers.
///
/// @see match_tiles_job.h for passes and places, docs/notes/performance.md for the choices and their reasons
class TilePlan {
 public:
  struct Tile {
    std::vector<spu::TileSlice> up;          ///< of `gather` and `twist`
    std::vector<spu::TileSlice> down, damp;  ///< of `scatter`, and the same for `damp`
  };

  /// @param arena_bytes  local store for a tile: kTileArenaBytes, or for the checked kernel kTileCheckedArenaBytes. The result does not
  ///                     depend on it.
  /// @throws BodyTooLarge           a slice does not fit a local store: the lattice is too high (z).
  /// @throws std::invalid_argument  a size in `shape` is negative.
  TilePlan(const Lattice<3>& lattice, const MatchingPlan<float, 3>& matching, TileShape shape = {},
           std::uint32_t arena_bytes = spu::kTileArenaBytes);

  std::span<const Tile> tiles() const { return tiles_; }

  /// The part that stays the same from step to step. Its addresses are 0.
  const spu::TiledBody& body() const { return body_; }

  /// The place of each particle in positions and velocities. Ascending; the places between are padding.
  std::span<const std::uint32_t> place_of() const { return place_of_; }
  /// The place of each region, as SumPlan numbers them.
  std::span<const std::uint32_t> place_of_region() const { return place_of_region_; }
  std::size_t places() const { return 4 * rest_.size(); }            ///< of particles, padding included
  std::size_t region_places() const { return 4 * regions_.size(); }  ///< likewise

  /// The sum lists and offsets to which TileSlice refers; equal ones are stored once.
  std::span<const std::byte> lists() const { return std::as_bytes(std::span(lists_)); }
  /// The widths of the numbers in lists().
  std::span<const dma::ElementRun> record_of_lists() const { return record_of_lists_; }
  std::span<const spu::TileRest> rest() const { return rest_; }
  std::span<const spu::TileWeights> weights() const { return weights_; }
  std::span<const spu::MatchRegions> regions() const { return regions_; }

 private:
  spu::TiledBody body_{};
  std::vector<Tile> tiles_;
  std::vector<std::uint32_t> place_of_, place_of_region_;
  std::vector<std::uint32_t> lists_;
  std::vector<dma::ElementRun> record_of_lists_;
  std::vector<spu::TileRest> rest_;
  std::vector<spu::TileWeights> weights_;
  std::vector<spu::MatchRegions> regions_;
};

}  // namespace softcell::ppu
