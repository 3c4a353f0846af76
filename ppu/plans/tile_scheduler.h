#pragma once
// Cuts the work of a tile into slices: what each slice fetches, sums up, keeps and writes.

#include <array>
#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "match_tiles_job.h"
#include "ppu/matching/summation.h"
#include "ppu/plans/lattice_sums.h"
#include "ppu/plans/tile_places.h"
#include "softcell/dma/element_layout.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// The lists of all slices; equal lists are stored once.
class TileLists {
 public:
  /// @param words     first `offsets` offsets, a multiple of 4, then pairs of halfwords as they lie in memory
  /// @return the list's offset in bytes, a multiple of 16
  std::uint32_t add(std::vector<std::uint32_t> words, std::uint32_t offsets);
  /// Moves all lists out.
  std::vector<std::uint32_t> release() { return std::move(words_); }
  /// The widths of the numbers in the lists.
  std::span<const dma::ElementRun> record() const { return record_; }

 private:
  void extend_record(std::uint32_t words, std::uint32_t element_bytes);

  std::vector<std::uint32_t> words_;
  std::vector<dma::ElementRun> record_;
  std::map<std::pair<std::uint32_t, std::vector<std::uint32_t>>, std::uint32_t> known_;
};

/// Schedules both directions of all tiles. Time counts planes: at time x a slice fetches the particles of plane x, or
/// the motions of regions whose lowest particle is there, and from then on bars and plates with them can be summed.
/// A region, or its total, is complete w planes after its lowest particle, and a particle's total w planes after
/// the particle.
class TileScheduler {
 public:
  enum class Direction { kUp, kDown };

  TileScheduler(const Lattice<3>& lattice, const SumPlan& sums, int half_width, const LatticeSums& order,
                const TileGrid& grid, const TilePlaces& particles, const TilePlaces& regions);

  std::vector<spu::TileSlice> slices(std::pair<int, int> tile, Direction direction);
  /// Writes the result of the last slices() again, for slots of two rows.
  std::vector<spu::TileSlice> slices_for_twists() { return write_slices(spu::kTwistSlotBytes); }

  TileLists& lists() { return lists_; }
  const spu::TileLimits& limits(Direction direction) const {
    return limits_[direction == Direction::kDown ? 1 : 0];
  }

 private:
  enum Kind { kInput, kBar, kPlate, kRegion, kKinds };
  using Slots = std::vector<std::uint32_t>;

  /// One kind of value in one slice.
  struct Block {
    Slots slots;                        // global numbers, in the order of their local ones; 0 is padding
    std::uint32_t begin = 0, size = 0;  // local
    int last_use = std::numeric_limits<int>::min();
  };
  struct Slice {
    std::array<Block, kKinds> blocks;
    std::uint32_t first_place = 0, last_place = 0;  // of inputs
    TilePlaces::Stretch output;
  };

  void start(Direction direction);
  const SumLevel& level(int kind) const;
  int time_of(int kind, std::uint32_t slot) const { return (*times_[kind])[slot]; }
  void require(int kind, std::uint32_t slot);
  template <typename Visit>
  void visit_terms(int kind, std::uint32_t slot, const Visit& visit) const;
  Slice& slice_at(int time);
  void collect(std::pair<int, int> tile);
  void place_outputs(std::pair<int, int> tile);
  void find_lifetimes();
  void allocate_slots();
  std::uint32_t local(int kind, std::uint32_t slot) const { return slot == 0 ? 0 : local_[kind][slot]; }
  void append_list(int kind, const Block& block, std::vector<std::uint16_t>& out) const;
  spu::TileSlice written(const Slice& slice);
  std::vector<spu::TileSlice> write_slices(std::uint32_t slot_bytes);

  const Lattice<3>& lattice_;
  const SumPlan& sums_;
  const int half_width_;
  const LatticeSums& order_;
  const TileGrid& grid_;
  const TilePlaces &particles_, &regions_;
  std::map<std::pair<int, int>, Slots> particles_of_tile_, regions_of_tile_;                      // by number
  std::vector<int> plane_of_particle_, plane_of_region_, plane_of_bar_, plane_of_plate_, ready_;  // by slot

  // For the current tile and direction:
  Direction direction_ = Direction::kUp;
  std::uint32_t slot_bytes_ = spu::kMatchSlotBytes;
  std::array<const std::vector<int>*, kKinds> times_{};
  std::array<Slots, kKinds> needed_;
  std::array<std::vector<std::uint32_t>, kKinds> mark_, local_;  // by slot
  std::uint32_t epoch_ = 0;
  int first_time_ = 0;
  std::vector<Slice> slices_;

  TileLists lists_;
  std::array<spu::TileLimits, 2> limits_{};
};

}  // namespace softcell::ppu
