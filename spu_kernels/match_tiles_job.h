#pragma once
// The contract of the kernel `match_tiles`: a body that is too large for a local store is cut into tiles, and
// all SPEs work on them. Plain data in main memory, the same bytes for both sides.
//
// A step is four passes over the body. A pass ends where particles need results of neighbouring tiles:
//
//   gather   x                 -->  sums of regions -->  R, motions                        over the regions
//   scatter  motions           -->  sums of motions -->  goals, v'                         over the particles
//   twist    x, v'             -->  sums of regions -->  omega, b                          over the regions
//   damp     omega, b          -->  their sums      -->  v                                 over the particles
//
// A tile is some rows (y) of some planes (x) of the lattice, over its whole height (z). A job runs one pass
// over one tile, plane by plane. A plane of a tile is a slice. It reads one contiguous range of main memory, the tile's rows and
// half_width more on either side, and writes one range, the tile's rows. Sums over planes continue from slice to
// slice. The kernel fetches a slice while it works on the one before.
//
// The PPU side plans all of that (ppu/plans/tile_plan.h): what each slot holds, and when a slot is free again.
// Sums follow the rules of match_job.h, with the same chains as for a whole body, so that the bits are the
// same.
//
// Particles and regions are numbered by plane, tile row and index. Each plane of a tile is padded to groups
// of four with particles without mass and regions without particles.

#include <stdint.h>

#include "match_job.h"

namespace softcell::spu {

/// One slice of a tile, in one direction: `up` from particles to regions, `down` from regions to particles.
/// Slots are numbers here, and offsets in sum lists. The slots of `damp` have two rows, so that pass has lists of its own.
struct alignas(64) TileSlice {
  uint32_t input;         ///< number of the first particle or region that is read; a multiple of 4
  uint32_t input_groups;  ///< groups of four; 0: nothing is read
  uint32_t input_slot;
  uint32_t bars_slot, plates_slot, sums_slot;  ///< the first slots that the three lists write
  uint32_t output;         ///< number of the first particle or region that is written; a multiple of 4
  uint32_t output_groups;  ///< 0: nothing is ready yet
  uint32_t lists;          ///< offset from TiledBody::lists_ea, a multiple of 16; bytes
  uint32_t lists_bytes;    ///< a multiple of 16
  uint32_t plates_list, sums_list;  ///< offsets of these lists from the list of bars; bytes, even
  /// Offset of the list of bars from `lists`. In a slice of `down`, the offsets of the output particles' totals come before it, four for
  /// each group.
  uint32_t bars_list;
  uint32_t pad[3];
};
static_assert(sizeof(TileSlice) == 64, "four quadwords");

/// Constants of four particles, for the passes that need them.
struct alignas(16) TileRest {
  float rest_moment[4][4];  ///< as in MatchParticles
};
struct alignas(16) TileWeights {
  float inverse_mass[4];  ///< 1 / kg; 0 for padding
  float mass[4];
};

/// The output of `scatter` for four particles: all that the later passes need, in one line.
struct alignas(128) TilePulled {
  float x[4], y[4], z[4];     ///< position about the body's origin, metres
  float vx[4], vy[4], vz[4];  ///< v', m/s
  float modified_mass[4];     ///< m~, kg; 0 for padding
  float share[4];             ///< 1 / |R_i|; 0 for padding
};
static_assert(sizeof(TilePulled) == 128, "one line");

/// The output of `gather` for `twist`, of four regions.
struct alignas(16) TileMomenta {
  float x[4], y[4], z[4];  ///< sum m~ x
  float inverse_mass[4];
};

/// The report of one tile. Two lines, because two passes write one each.
struct alignas(128) TileReport {
  float residual_square;      ///< the largest of the tile; `gather` writes it
  uint32_t positions_finite;  ///< `gather` writes it
  uint32_t pad0[30];
  uint32_t pulls[28];          ///< a PullSum; `scatter` writes it
  uint32_t velocities_finite;  ///< `scatter` writes it
  uint32_t pad1[3];
};
static_assert(sizeof(TileReport) == 256, "two lines");
constexpr uint32_t kTileReportLine = 128;

/// Upper limits of the slices of one direction.
struct TileLimits {
  uint32_t slices;        ///< of a tile
  uint32_t input_groups;  ///< of a slice
  uint32_t output_groups;
  uint32_t lists_bytes;
  uint32_t slots;
};

/// One body. Two lines in main memory.
struct alignas(128) TiledBody {
  uint64_t positions_ea;      ///< x y z 0 of each place, metres
  uint64_t velocities_ea;     ///< x y z 0 of each place, m/s; changed in place by `damp`
  uint64_t pulled_ea;         ///< TilePulled of each group of particles
  uint64_t rotations_in_ea;   ///< MatchRotations of each group of regions, of the last step
  uint64_t rotations_out_ea;  ///< the same of this step
  /// A slot of each region: (R, t) after `gather`; after `twist` a slot of two rows, (b, omega).
  uint64_t motions_ea;
  uint64_t momenta_ea;  ///< TileMomenta of each group of regions
  uint64_t reports_ea;  ///< a TileReport of each tile
  uint64_t lists_ea;
  uint64_t rest_ea;     ///< TileRest of each group of particles
  uint64_t weights_ea;  ///< TileWeights
  uint64_t regions_ea;  ///< MatchRegions of each group of regions
  uint32_t tiles;
  float pull;     ///< alpha / h, 1/s
  float damping;  ///< k, 0..1
  uint32_t cold;  ///< not 0: there are no rotations of an earlier step
  uint32_t least_iterations, most_iterations;
  float noise_floor, grid;  ///< as in MatchPlanHeader
  MatchHold hold;
  uint32_t samples[kMatchSamples];  ///< numbers of particles spread over the body
  TileLimits up, down;
  uint32_t pad[4];
};
static_assert(sizeof(TiledBody) == 256, "two lines");

enum TilePass : uint32_t { kTileGather = 0, kTileScatter = 1, kTileTwist = 2, kTileDamp = 3 };

/// The job's descriptor: one tile, one pass.
struct alignas(128) TileJob {
  uint64_t body_ea;    ///< a TiledBody
  uint64_t slices_ea;  ///< TileSlice of the pass's direction, a multiple of 16
  uint32_t slice_count;
  uint32_t tile;
  uint32_t pass;  ///< a TilePass
  uint32_t pad[25];
};
static_assert(sizeof(TileJob) == 128, "one line");

/// What main returns.
enum TileStatus : uint32_t { kTileDone = 0, kTileTooLarge = 1 };

/// Bytes of local store for one direction: slices, two sides of a double buffer, output, slots. Accepts any
/// limits below 65536.
constexpr uint32_t tile_up_side_bytes(const TileLimits& up) {
  return up.lists_bytes + up.input_groups * static_cast<uint32_t>(sizeof(TilePulled)) +
         up.output_groups * (64 + 64);
}
constexpr uint32_t tile_down_side_bytes(const TileLimits& down) {
  return down.lists_bytes + down.output_groups * (64 + 64 + 64 + 32);
}
constexpr uint32_t tile_up_bytes(const TileLimits& up) {
  return up.slices * static_cast<uint32_t>(sizeof(TileSlice)) + 2 * tile_up_side_bytes(up) +
         up.output_groups * (4 * kMatchSlotBytes + static_cast<uint32_t>(sizeof(TileMomenta))) +
         up.slots * kMatchSlotBytes;
}
constexpr uint32_t tile_down_bytes(const TileLimits& down) {
  return down.slices * static_cast<uint32_t>(sizeof(TileSlice)) + 2 * tile_down_side_bytes(down) +
         down.output_groups * static_cast<uint32_t>(sizeof(TilePulled)) + down.slots * kMatchSlotBytes;
}

/// Bytes of local store that the kernel has for these. Its checked build has more code, and so less room.
constexpr uint32_t kTileArenaBytes = 208 * 1024, kTileCheckedArenaBytes = 144 * 1024;

constexpr bool tile_limits_small(const TileLimits& limits) {
  constexpr uint32_t most = kTileArenaBytes / 16;  // below it, sizes do not overflow
  return limits.slices <= most && limits.input_groups <= most && limits.output_groups <= most &&
         limits.lists_bytes <= kTileArenaBytes && limits.slots <= most;
}
constexpr bool tile_fits(const TileLimits& up, const TileLimits& down, uint32_t arena_bytes) {
  return tile_limits_small(up) && tile_limits_small(down) && tile_up_bytes(up) <= arena_bytes &&
         tile_down_bytes(down) <= arena_bytes;
}

}  // namespace softcell::spu
