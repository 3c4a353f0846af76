#pragma once
// The places of particles and regions in main memory, for a body in tiles.

#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "softcell/base/assert.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// Tiles of equal size over a lattice, numbered by index: (x / planes, y / rows), rounded down.
struct TileGrid {
  int planes, rows;
  std::pair<int, int> tile_of(const Eigen::Vector3i& index) const;
};

/// Places of things (particles or regions) at lattice sites, ordered by plane, tile row and number. The things of one tile in one plane
/// form one stretch, padded to groups of four.
class TilePlaces {
 public:
  struct Stretch {
    std::uint32_t begin = 0, end = 0;
  };
  static constexpr std::uint32_t kPadding = std::numeric_limits<std::uint32_t>::max();

  /// @param sites  of thing 0, 1, 2, ...; ascending by x, then y
  TilePlaces(const TileGrid& grid, const std::vector<Eigen::Vector3i>& sites);

  std::uint32_t place_of(std::uint32_t thing) const {
    SC_ASSERT(thing < place_of_.size(), "the place of {} of {}", thing, place_of_.size());
    return place_of_[thing];
  }
  std::span<const std::uint32_t> all_places() const { return place_of_; }
  /// The thing at a place, or kPadding.
  std::uint32_t at(std::uint32_t place) const {
    SC_ASSERT(place < thing_at_.size(), "place {} of {}", place, thing_at_.size());
    return thing_at_[place];
  }
  std::uint32_t size() const { return static_cast<std::uint32_t>(thing_at_.size()); }
  /// The stretch of plane x and a tile row; empty if there is nothing.
  Stretch stretch(int x, int tile_row) const;

 private:
  std::vector<std::uint32_t> place_of_, thing_at_;
  std::map<std::pair<int, int>, Stretch> stretches_;
};

}  // namespace softcell::ppu
