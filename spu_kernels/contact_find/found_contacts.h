#pragma once
// Contacts of points with cells: of candidates that are known, and of those that a Direction finds.

#include <spu_intrinsics.h>

#include "contact_find/boxes.h"
#include "contact_find/local_store.h"
#include "contact_find/sides.h"

namespace softcell::spu {
namespace {  // a part of contact_find.cpp, which alone includes it

/// Discards all inverses: those that follow belong to another body.
void forget_inverses() {
  const vec_ushort8 nobody = spu_splats(kFindNoCell);
  for (uint32_t i = 0; i < kInverses; i += 8) *reinterpret_cast<vec_ushort8*>(ls.inverse_of + i) = nobody;
}

const RoughInverse& inverse_of(const Sides& sides, uint32_t cell) {
  const uint32_t place = cell % kInverses;
  if (ls.inverse_of[place] != cell) {
    const CellAtRest& at_rest = sides.other.cells[cell];
    // In two steps: the checker does not see stores by which a function writes its result directly into its place.
    const RoughInverse inverse = rough_inverse(deformed_cell(at_rest.corner, sides.other.ends), at_rest.least,
                                               sides.least_volume, kNearInField);
    ls.inverse[place] = inverse;
    ls.inverse_of[place] = static_cast<uint16_t>(cell);
  }
  return ls.inverse[place];
}

/// Four points of a cell at the step's end.
struct FourPoints {
  Vector3x4 s, end;
  vec_float4 allowance;  // metres
  vec_float4 allowance_in_cells;
  vec_uint4 none;  // top bit set: no point
  vec_uint4 done;  // top bit set: found in a cell, or no point
};

inline void place_points(const Sides& sides, const CellMap& map, uint32_t number, FourPoints& four) {
  const vec_float4* const group = sides.mine.groups + number * 4;
  four.s = {group[0], group[1], group[2]};
  four.end = map_points(map, four.s).position;
  four.allowance = group[3];
  four.allowance_in_cells = spu_mul(group[3], sides.per_spacing);
  four.none = four.done = less(spu_splats(0.5f * kFindNoPoint), group[3]);
}

/// Contacts of points, to ls.contacts.
class Contacts {
 public:
  Contacts(const BodyInStore& a, const BodyInStore& b, const TaskTerms& terms)
      : a_in_b_(a, b, false), b_in_a_(b, a, true), terms_(terms) {}

  /// Finds the contacts of the candidates in ls.candidates. @return  false: there is no room
  bool find_among_candidates() {
    const Sides* now = nullptr;  // to which the present inverses belong
    for (uint32_t i = 0; i < ls.candidate_count;) {
      const bool of_b = (ls.candidates[i].of_groups & kFindOfB) != 0;
      const Sides& sides = of_b ? b_in_a_ : a_in_b_;
      if (now != &sides) forget_inverses();
      now = &sides;
      if (!find_of_cell(sides, i)) return false;
    }
    return true;
  }

  /// Finds the contacts of four points of a cell with another body's cell. @param rough  about where they are in it
  /// @param elsewhere  words whose top bit is set in lanes that are not needed
  /// @return  false: there is no room
  __attribute__((noinline)) bool find_in_cell(const Sides& sides, uint32_t cell, uint32_t there,
                                              FourPoints& four, const Vector3x4& rough, vec_uint4 elsewhere) {
    const BodyInStore& other = sides.other;
    const CellAtRest& at_rest = other.cells[there];
    const CellMap map = in_all_lanes(deformed_cell(at_rest.corner, other.ends));
    const FoundPlaces places = find_places(map, at_rest.least, four.end, rough, four.allowance_in_cells,
                                           elsewhere, sides.least_volume);
    const uint32_t left = lanes_left(places.elsewhere);
    if (left == 0) return true;
    four.done = spu_or(four.done, spu_andc(spu_splats(0x80000000u), places.elsewhere));
    const vec_float4 zero = spu_splats(0.0f);
    const auto rows = [&](const Vector3x4& v) __attribute__((always_inline)) {
      return transpose(Rows4{v.x, v.y, v.z, zero});
    };
    const Rows4 own = rows(four.s), ends = rows(four.end), at = rows(places.s);
    const Rows4 f1 = rows(places.map.f1), f2 = rows(places.map.f2), f3 = rows(places.map.f3);
    const vec_float4 *const p_own = &own.a, *const p_end = &ends.a, *const p_at = &at.a;
    const vec_float4 *const p1 = &f1.a, *const p2 = &f2.a, *const p3 = &f3.a;
    for (uint32_t lane = 0; lane < 4; ++lane) {
      if ((left & 8u >> lane) == 0) continue;
      if (ls.result.count == ls.contacts_most) return false;
      const PointInCell point = {
          cell,       there,       p_own[lane],
          p_at[lane], p1[lane],    p2[lane],
          p3[lane],   p_end[lane], spu_extract(four.allowance, static_cast<int>(lane))};
      SolvedContact& contact = room_for_contact();
      if (!make_contact(sides.mine, other, point, sides.swap, terms_, contact)) continue;
      ++ls.result.count;
      if (spu_extract(contact.terms, 2) > 0.0f) ls.result.pushes = 1;
    }
    return true;
  }

 private:
  /// Finds the contacts of all candidates that have the same four groups. @param i  the first of them; becomes the first one of others
  // Not inlined, as Clang would do, because its points would take stack also in a search without known candidates.
  __attribute__((noinline)) bool find_of_cell(const Sides& sides, uint32_t& i) {
    const FindCandidate first = ls.candidates[i];
    const CellMap map = in_all_lanes(deformed_cell(sides.mine.cells[first.cell].corner, sides.mine.ends));
    FourPoints points[kGroups];
    uint32_t placed = 0;
    for (; i < ls.candidate_count; ++i) {
      const FindCandidate& candidate = ls.candidates[i];
      if (candidate.first != first.first || ((candidate.of_groups ^ first.of_groups) & kFindOfB) != 0) break;
      const RoughInverse4 inverse = in_all_lanes(inverse_of(sides, candidate.other));
      for (uint32_t g = 0; g < kGroups; ++g) {
        if ((candidate.of_groups >> g & 1) == 0) continue;
        FourPoints& four = points[g];
        if ((placed >> g & 1) == 0) place_points(sides, map, candidate.first + g, four);
        placed |= 1u << g;
        const Vector3x4 rough = rough_place(inverse, four.end);
        const vec_uint4 elsewhere =
            spu_or(four.done, surely_elsewhere(inverse, rough, four.allowance_in_cells));
        if (lanes_left(elsewhere) != 0 &&
            !find_in_cell(sides, candidate.cell, candidate.other, four, rough, elsewhere))
          return false;
      }
    }
    return true;
  }

  Sides a_in_b_, b_in_a_;
  const TaskTerms& terms_;
};

}  // namespace
}  // namespace softcell::spu
