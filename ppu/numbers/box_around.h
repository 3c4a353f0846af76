#pragma once

namespace softcell::ppu {

/// The box around some places. @tparam Box  has `low` and `high`, as Bounds  @pre there is at least one place
template <class Box, class Places>
Box box_around(const Places& places) {
  Box box{*places.begin(), *places.begin()};
  for (const auto& place : places) {
    box.low = box.low.cwiseMin(place);
    box.high = box.high.cwiseMax(place);
  }
  return box;
}

}  // namespace softcell::ppu
