#pragma once
// A search without known candidates: the points of one body in the cells of another.

#include <spu_intrinsics.h>

#include "contact_find/found_contacts.h"
#include "contact_find/near_bounds.h"
#include "contact_find/near_cells.h"

namespace softcell::spu {
namespace {  // a part of contact_find.cpp, which alone includes it

/// The state of candidates: all are in ls.candidates; nobody wants them, or they do not fit; there was no room to look for them.
enum class Candidates { kThere, kNotKept, kTooMany };

/// One body's points in the other body: candidates and contacts.
class Direction {
 public:
  /// @param margin  metres, of candidates
  Direction(const Sides& sides, const NearCells& near_mine, NearCells& near_other, float margin,
            Contacts& contacts, Candidates& candidates)
      : sides_(sides),
        near_mine_(near_mine),
        near_other_(near_other),
        // A reserve, so that rounding does not change which points are found.
        rounding_(spu_splats(0x1.a36e2ep-14f * sides.other.spacing)),  // 1e-4
        margin_(spu_add(spu_splats(margin), rounding_)),
        contacts_(contacts),
        candidates_(candidates) {}

  /// @return  false: there is no room for contacts
  bool find() {
    bound_blocks(near_other_);
    for (uint32_t i = 0; i < near_other_.count; i += 4) bound_four(sides_, near_other_, i);
    for (uint32_t i = 0; i < near_mine_.count; ++i)
      if (!try_cell(near_mine_.cell[i])) return false;
    return true;
  }

 private:
  bool try_cell(uint32_t cell) {
    const CellAtRest& own = sides_.mine.cells[cell];
    uint32_t first = static_cast<uint32_t>(spu_extract(own.place, 4)) & 0xFFFFu;
    const uint32_t end = first + (static_cast<uint32_t>(spu_extract(own.place, 5)) & 0xFFFFu);
    if (first == end) return true;
    const CellMap map = in_all_lanes(deformed_cell(own.corner, sides_.mine.ends));
    FourPoints points[kGroups];
    for (; first < end; first += kGroups) {
      const uint32_t count = end - first < kGroups ? end - first : kGroups;
      for (uint32_t i = 0; i < count; ++i) place_points(sides_, map, first + i, points[i]);
      const uint32_t meets = gather_meeting(region_of(points, count), margin_, near_other_);
      if (ls.candidate_count + meets > kFindMaxCandidates) candidates_ = Candidates::kNotKept;
      for (uint32_t i = 0; i < meets; ++i)
        if (!try_points(cell, ls.meets[i], first, points, count)) return false;
    }
    return true;
  }

  /// The box around all points, widened by the margin.
  Region region_of(const FourPoints* points, uint32_t count) const {
    Vector3x4 low = points[0].end, high = low;
    for (uint32_t i = 1; i < count; ++i) {
      const Vector3x4& at = points[i].end;
      low = {smaller(low.x, at.x), smaller(low.y, at.y), smaller(low.z, at.z)};
      high = {larger(high.x, at.x), larger(high.y, at.y), larger(high.z, at.z)};
    }
    const vec_float4 zero = spu_splats(0.0f), half = spu_splats(0.5f);
    const Rows4 lows = transpose(Rows4{low.x, low.y, low.z, zero});
    const Rows4 highs = transpose(Rows4{high.x, high.y, high.z, zero});
    const vec_float4 lowest = smaller(smaller(lows.a, lows.b), smaller(lows.c, lows.d));
    const vec_float4 highest = larger(larger(highs.a, highs.b), larger(highs.c, highs.d));
    const vec_float4 reach = spu_mul(spu_sub(highest, lowest), half);
    Region region;
    region.box = {in_all_lanes(spu_sub(lowest, margin_)), in_all_lanes(spu_add(highest, margin_))};
    region.middle = in_all_lanes(spu_mul(spu_add(lowest, highest), half));
    region.radius = length_in_all_lanes(reach);
    return region;
  }

  bool try_points(uint32_t cell, uint32_t near_index, uint32_t first, FourPoints* points, uint32_t count) {
    const BodyInStore &mine = sides_.mine, &other = sides_.other;
    const uint32_t there = near_other_.cell[near_index];
    if (&mine == &other && belong_together(mine.cells[cell], other.cells[there])) return true;
    const Bounds4 bounds = bounds_at([&](uint32_t k) __attribute__((always_inline)) {
      return spu_splats(ls.bounds.row[k][near_index]);
    });
    const vec_float4 half = spu_splats(0.5f);
    uint32_t of_groups = 0;
    for (uint32_t i = 0; i < count; ++i) {
      FourPoints& four = points[i];
      RoughPlaces places = rough_places(bounds, four.end);
      places.above = spu_madd(four.allowance_in_cells, half, places.above);
      if (lanes_left(spu_or(four.none, surely_far(bounds, places, margin_))) == 0) continue;
      of_groups |= 1u << i;
      const vec_uint4 elsewhere = spu_or(four.done, surely_far(bounds, places, rounding_));
      if (lanes_left(elsewhere) != 0 &&
          !contacts_.find_in_cell(sides_, cell, there, four, places.s, elsewhere))
        return false;
    }
    if (of_groups == 0 || candidates_ != Candidates::kThere) return true;
    ls.candidates[ls.candidate_count++] = {
        static_cast<uint16_t>(cell), static_cast<uint16_t>(there), static_cast<uint16_t>(first),
        static_cast<uint16_t>(sides_.swap ? of_groups | kFindOfB : of_groups)};
    return true;
  }

  const Sides& sides_;
  const NearCells& near_mine_;
  NearCells& near_other_;
  vec_float4 rounding_, margin_;  // metres
  Contacts& contacts_;
  Candidates& candidates_;
};

}  // namespace
}  // namespace softcell::spu
