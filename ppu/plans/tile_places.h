#pragma once
// Where particles and regions are in main memory when a body is cut into tiles.

#include <cstdint>
#include <limits>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// Tiles of equal size over a lattice, numbered by index: (x / planes, y / rows), rounded down.
struct TileGrid {
  int planes, rows;
  std::pair<int, int> tile_of(const Eigen::Vector3i& index) const;
};

/// Places of things that are at lattice sites, by plane, tile row and number. What one tile has in one plane
/// is one stretch, padded to groups of four.
class TilePlaces {
 public:
  struct Stretch {
    std::uint32_t begin = 0, end = 0;
  };
  static constexpr std::uint32_t kPadding = std::numeric_limits<std::uint32_t>::max();

  /// @param sites  of thing 0, 1, 2, ...; ascending by x, then y
  TilePlaces(const TileGrid& grid, const std::vector<Eigen::Vector3i>& sites);

  std::uint32_t place_of(std::uint32_t thing) const { return place_of_[thing]; }
  std::span<const std::uint32_t> all_places() const { return place_of_; }
  std::uint32_t at(std::uint32_t place) const { return thing_at_[place]; }  ///< or kPadding
  std::uint32_t size() const { return static_cast<std::uint32_t>(thing_at_.size()); }
  /// Of plane x and a tile row; empty where there is nothing.
  Stretch stretch(int x, int tile_row) const;

 private:
  std::vector<std::uint32_t> place_of_, thing_at_;
  std::map<std::pair<int, int>, Stretch> stretches_;
};

}  // namespace softcell::ppu
