// contact_find: where soft bodies would enter each other, or themselves, in the coming step.  [FL01], [MZS+11]
//
//   array     direction  element                     count             alignment
//   job       in         FindJob, 128 bytes          1                 128
//   tasks     in         FindTask, 256 bytes         any               128
//   cells     in         FindCell, 160 bytes         of two models     16
//   groups    in         FindGroup, 64 bytes         of two models     16
//   boxes     in         FindBoxes, 96 bytes         of two bodies     16
//   ends      in         FindEnd, 16 bytes           of two bodies     16
//   begins    in         FindBegin, 16 bytes         of two bodies     16
//   candid.   in, out    FindCandidate, 8 bytes      <= 448 of a task  16
//   contacts  out        SolveContact, 176 bytes     <= 256 of a task  16, those of a job beside each other
//   results   out        FindResult, 16 bytes        1 of a task       16
//
// Cells of the two bodies are held against each other by their boxes, four at a time; then points, four at a time, against
// parallelepipeds and a plane below the distance field. What is near by these bounds widened by a margin is a candidate, which serves
// for the next steps, too. What is near without the margin is looked for in the cell by Newton's iteration, four points at a time. Few
// points come so far. Where candidates are known from a step before, the search begins with them.
//
// Contacts do not depend on the margin: a point that is in a cell is its candidate with any.
//
// Budget: 244 KB. 148 KB of bodies and their models, 11 KB of contacts, 44 KB of cells that are near, their bounds and candidates;
// the rest for code and 6.5 KB of stack.
//
// Compiles unchanged with a real SPU g++ (7 to 9, -std=c++17).

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "common/dma.h"
#include "contact_find_job.h"
#include "contacts/deformed_cell.h"
#include "contacts/embedded_contact.h"

namespace softcell::spu {
namespace {

enum Tag : uint32_t { kTagTask = 0, kTagIn = 1, kTagOut = 2 };

#ifdef SOFTCELL_CHECKED  // its code is twice as large
constexpr uint32_t kBatch = 1, kInverses = 8, kContactBatch = 4;
#else
constexpr uint32_t kBatch = 16;         // tasks that are fetched together
constexpr uint32_t kInverses = 64;      // that are kept
constexpr uint32_t kContactBatch = 64;  // contacts that go to main memory together
#endif
constexpr uint32_t kGroups = 4;  // of a FindCandidate
/// Something that is in the local store already.
struct Part {
  uint64_t ea;  // 0: nothing
  uint32_t offset;
};

/// Cells of a body that are near the other one: their boxes, as in FindBoxes but close together.
struct NearCells {
  uint32_t count;
  alignas(16) float box[6][kFindMaxNear + 4];
  vec_float4 block[kFindMaxNear / 16]
                  [6];  // of 16 cells: lane i is around the cells i, i + 4, i + 8 and i + 12
  uint16_t cell[kFindMaxNear];
};
static_assert(kFindMaxNear % 16 == 0, "whole blocks");

/// Of near cells, as RoughInverse, a cell to a lane: what is no farther from the three pairs of planes than a distance, and from the
/// plane below the surface, may be in the cell.
struct NearBounds {
  enum Row : uint32_t {
    kMiddle = 0,   // x y z
    kRow1 = 3,     // x y z of each of the inverse's rows
    kReach = 12,   // by s1 s2 s3
    kLength = 15,  // of the three rows, 1/m: how much of reach a metre is
    kSlope = 18,   // x y z: of the plane below the field, in the world
    kLimit = 21,   // of what it says
    kSteep = 22,   // length of the slope
    kRows = 23
  };
  alignas(16) float row[kRows][kFindMaxNear + 4];
};

/// Everything this kernel keeps in local store beside its code and stack.
struct alignas(128) LocalStoreMap {
  FindJob job;
  FindTask tasks[kBatch];
  FindResult results[kBatch];
  FindResult result;
  alignas(128) char bytes[kFindMaxBytes];  // model and state of a, then those of b
  Part model[2], state[2];
  alignas(128) SolvedContact contacts[kContactBatch];  // found last
  uint32_t contacts_sent;                              // before them
  uint32_t contacts_most;                              // that the task may have
  uint64_t contacts_ea;                                // of the task
  NearCells near[2];                                   // of a, of b
  uint16_t inverse_of[kInverses];                      // whose it is
  uint16_t meets[kFindMaxNear];
  alignas(128) FindCandidate candidates[kFindMaxCandidates];
  uint32_t candidate_count;
  union {
    alignas(16) float along[2][kFindMaxParticles];  // places of particles between the two bodies
    NearBounds bounds;                              // behind that
    RoughInverse inverse[kInverses];  // where candidates are known: of a cell at its number modulo kInverses
  };
  uint32_t under_way;  // tag groups with transfers
};
LocalStoreMap ls;

/// Where a body's parts are.
BodyInStore body_in_store(uint32_t model, uint32_t state, const FindBody& body) {
  const auto at = [](uint32_t offset) { return reinterpret_cast<const vec_float4*>(ls.bytes + offset); };
  const uint32_t ends = state + (body.cell_count + 3) / 4 * static_cast<uint32_t>(sizeof(FindBoxes));
  return {reinterpret_cast<const CellAtRest*>(ls.bytes + model),
          at(model + body.cell_count * static_cast<uint32_t>(sizeof(FindCell))),
          at(state),
          at(ends),
          at(ends + body.particle_count * 16),
          body.cell_count,
          body.particle_count,
          body.spacing};
}

/// Tasks come in an order in which much is there already.
inline bool is_there(Part& part, uint64_t ea, uint32_t offset) {
  const bool is = part.ea == ea && part.offset == offset;
  part = {ea, offset};
  return is;
}

void fetch_model(Part& part, uint32_t offset, const FindBody& body) {
  if (is_there(part, body.cells_ea, offset)) return;
  const uint32_t cells = body.cell_count * static_cast<uint32_t>(sizeof(FindCell));
  get_large(ls.bytes + offset, body.cells_ea, cells, kTagIn);
  get_large(ls.bytes + offset + cells, body.groups_ea,
            body.group_count * static_cast<uint32_t>(sizeof(FindGroup)), kTagIn);
  ls.under_way |= 1u << kTagIn;
}

void fetch_state(Part& part, uint32_t offset, const FindBody& body) {
  if (is_there(part, body.state_ea, offset)) return;
  get_large(ls.bytes + offset, body.state_ea, find_state_bytes(body), kTagIn);
  ls.under_way |= 1u << kTagIn;
}

/// In whole quadwords.
inline uint32_t bytes_of_candidates(uint32_t count) {
  return (count + 1) / 2 * 2 * static_cast<uint32_t>(sizeof(FindCandidate));
}

/// Until all transfers of bodies and contacts are complete.
void wait_for_all() {
  if (ls.under_way != 0) wait_for_tags(ls.under_way);
  ls.under_way = 0;
}

/// The contacts in the local store to main memory.
void send_contacts() {
  const uint32_t count = ls.result.count - ls.contacts_sent;
  if (count == 0) return;
  constexpr uint32_t kBytes = sizeof(SolvedContact);
  static_assert(kContactBatch * kBytes <= 16384, "one command");
  mfc_put(ls.contacts, ls.contacts_ea + ls.contacts_sent * kBytes, count * kBytes, kTagOut, 0, 0);
  ls.under_way |= 1u << kTagOut;
  ls.contacts_sent = ls.result.count;
}

/// Where the next contact goes.
SolvedContact& room_for_contact() {
  if (ls.result.count - ls.contacts_sent == kContactBatch) {
    send_contacts();
    wait_for_all();
  }
  return ls.contacts[ls.result.count - ls.contacts_sent];
}

/// A box in all lanes.
struct BoxInAllLanes {
  Vector3x4 low, high;
};

/// Words whose top bit is set where a box has no point in common with the four boxes.
inline vec_uint4 apart(const BoxInAllLanes& box, vec_float4 low_x, vec_float4 low_y, vec_float4 low_z,
                       vec_float4 high_x, vec_float4 high_y, vec_float4 high_z) {
  return spu_or(spu_or(spu_or(less(box.high.x, low_x), less(box.high.y, low_y)),
                       spu_or(less(box.high.z, low_z), less(high_x, box.low.x))),
                spu_or(less(high_y, box.low.y), less(high_z, box.low.z)));
}

/// A bit for each lane whose top bit is not set: 8 is lane 0.
inline uint32_t lanes_left(vec_uint4 words) {
  return spu_extract(spu_gather(spu_rlmask(words, -31)), 0) ^ 15u;
}

/// The first of some lanes, which is taken out.
inline uint32_t take_lane(uint32_t& lanes) {
  const uint32_t lane = static_cast<uint32_t>(__builtin_clz(lanes)) - 28;
  lanes &= ~(8u >> lane);
  return lane;
}

/// How far a body reaches along a direction, and each of its particles.
struct Reach {
  float least, most;
};

Reach reach_along(const BodyInStore& body, vec_float4 direction, float* along) {
  const Vector3x4 d = in_all_lanes(direction);
  vec_float4 least = spu_splats(1e38f), most = spu_splats(-1e38f);
  for (uint32_t p = 0; p < body.particle_count; p += 4) {
    const auto at = [&](uint32_t i) __attribute__((always_inline)) {
      return body.ends[p + i < body.particle_count ? p + i : body.particle_count - 1];
    };
    const Rows4 rows = transpose(Rows4{at(0), at(1), at(2), at(3)});
    const vec_float4 place = dot(d, Vector3x4{rows.a, rows.b, rows.c});
    *reinterpret_cast<vec_float4*>(along + p) = place;
    least = smaller(least, place);
    most = larger(most, place);
  }
  return {-largest_lane(negative(least)), largest_lane(most)};
}

/// |v|, of a vector whose fourth lane is 0.
inline vec_float4 length_in_all_lanes(vec_float4 v) {
  const vec_float4 square = dot_in_all_lanes(v, v);
  return spu_mul(square, reciprocal_sqrt(square));
}

inline Reach widened(const Reach& reach, vec_float4 direction, float margin) {
  const vec_float4 wide = spu_mul(length_in_all_lanes(direction), spu_splats(margin));
  return {reach.least - spu_extract(wide, 0), reach.most + spu_extract(wide, 0)};
}

/// What a cell has to meet to be near: a box, and a plane between the two bodies.
struct Nearness {
  BoxInAllLanes box;
  const float* along;  // of the body's particles; null: no plane
  float least, most;   // one corner at least has to be in between
};

/// Cells of a body that are near the other, and the box around them.
/// @return  false: there are too many
bool gather_near(const BodyInStore& body, const Nearness& nearness, NearCells& near, BoxInAllLanes& around) {
  near.count = 0;
  vec_float4 around_low = spu_splats(0x1.93e594p+99f), around_high = spu_splats(-0x1.93e594p+99f);  // 1e30
  const uint32_t groups = (body.cell_count + 3) / 4;
  for (uint32_t g = 0; g < groups; ++g) {
    const vec_float4* const b = body.boxes + g * 6;
    uint32_t left = lanes_left(apart(nearness.box, b[0], b[1], b[2], b[3], b[4], b[5]));
    while (left != 0) {
      const uint32_t lane = take_lane(left), cell = 4 * g + lane;
      if (cell >= body.cell_count) break;
      if (nearness.along != nullptr) {
        const vec_ushort8 corner = body.cells[cell].corner;
        const auto along = [&](int k) __attribute__((always_inline)) {
          return nearness.along[spu_extract(corner, k)];
        };
        const vec_float4 low = {along(0), along(1), along(2), along(3)};
        const vec_float4 high = {along(4), along(5), along(6), along(7)};
        // All below, or all above?
        const vec_float4 least = spu_splats(nearness.least), most = spu_splats(nearness.most);
        const vec_uint4 below = spu_and(less(low, least), less(high, least));
        const vec_uint4 above = spu_and(less(most, low), less(most, high));
        if (lanes_left(below) == 0 || lanes_left(above) == 0) continue;
      }
      if (near.count == kFindMaxNear) return false;
      const float* const of_lane = reinterpret_cast<const float*>(b) + lane;
      for (uint32_t i = 0; i < 6; ++i) near.box[i][near.count] = of_lane[4 * i];
      const vec_float4 low = {of_lane[0], of_lane[4], of_lane[8], 0.0f};
      const vec_float4 high = {of_lane[12], of_lane[16], of_lane[20], 0.0f};
      around_low = smaller(around_low, low);
      around_high = larger(around_high, high);
      near.cell[near.count] = static_cast<uint16_t>(cell);
      ++near.count;
    }
  }
  for (uint32_t i = near.count; i < near.count + 4; ++i) {  // what fills up the last four meets nothing
    for (uint32_t k = 0; k < 3; ++k) near.box[k][i] = 0x1.93e594p+99f;   // 1e30
    for (uint32_t k = 3; k < 6; ++k) near.box[k][i] = -0x1.93e594p+99f;  // 1e30
  }
  around = {in_all_lanes(around_low), in_all_lanes(around_high)};
  return true;
}

inline BoxInAllLanes common(const BoxInAllLanes& a, const BoxInAllLanes& b) {
  return {{larger(a.low.x, b.low.x), larger(a.low.y, b.low.y), larger(a.low.z, b.low.z)},
          {smaller(a.high.x, b.high.x), smaller(a.high.y, b.high.y), smaller(a.high.z, b.high.z)}};
}

/// @param by  x y z
inline BoxInAllLanes widened(const BoxInAllLanes& box, vec_float4 by) {
  const Vector3x4 wide = in_all_lanes(by);
  return {difference(box.low, wide),
          {spu_add(box.high.x, wide.x), spu_add(box.high.y, wide.y), spu_add(box.high.z, wide.z)}};
}

/// Where the points of a cell are: in a box, and in a ball. In all lanes.
struct Region {
  BoxInAllLanes box;
  Vector3x4 middle;
  vec_float4 radius;
};

/// Bounds of four near cells, or of one in all lanes.
struct Bounds4 {
  Vector3x4 middle, row1, row2, row3, reach, length, slope;
  vec_float4 limit, steep;
};

/// @param at  what is in a row of ls.bounds
template <typename At>
inline Bounds4 bounds_at(const At& at) {
  const auto three = [&](uint32_t first) __attribute__((always_inline)) {
    return Vector3x4{at(first), at(first + 1), at(first + 2)};
  };
  using B = NearBounds;
  return {three(B::kMiddle), three(B::kRow1),  three(B::kRow1 + 3), three(B::kRow1 + 6), three(B::kReach),
          three(B::kLength), three(B::kSlope), at(B::kLimit),       at(B::kSteep)};
}

/// Points as a cell sees them.
struct RoughPlaces {
  Vector3x4 s;       // where they would be in the cell if it were a parallelepiped
  vec_float4 above;  // what the lower plane's function says
};

inline RoughPlaces rough_places(const Bounds4& cell, const Vector3x4& point) {
  const Vector3x4 d = difference(point, cell.middle);
  return {{dot(cell.row1, d), dot(cell.row2, d), dot(cell.row3, d)}, dot(cell.slope, d)};
}

/// Words whose top bit is set where points cannot be in a cell and near its surface.
/// @param distance  metres: of all that may be there from the points
inline vec_uint4 surely_far(const Bounds4& cell, const RoughPlaces& places, vec_float4 distance) {
  const auto beyond = [&](vec_float4 s, vec_float4 reach, vec_float4 length) __attribute__((always_inline)) {
    return less(spu_madd(length, distance, reach), absolute(s));
  };
  return spu_or(spu_or(beyond(places.s.x, cell.reach.x, cell.length.x),
                       beyond(places.s.y, cell.reach.y, cell.length.y)),
                spu_or(beyond(places.s.z, cell.reach.z, cell.length.z),
                       less(spu_madd(cell.steep, distance, cell.limit), places.above)));
}

/// The boxes of blocks.
void bound_blocks(NearCells& near) {
  for (uint32_t first = 0; first < near.count; first += 16) {
    const uint32_t end = first + 16 < near.count ? first + 16 : near.count;
    for (uint32_t k = 0; k < 6; ++k) {
      vec_float4 around = *reinterpret_cast<const vec_float4*>(near.box[k] + first);
      for (uint32_t i = first + 4; i < end; i += 4) {
        const vec_float4 four = *reinterpret_cast<const vec_float4*>(near.box[k] + i);
        around = k < 3 ? smaller(around, four) : larger(around, four);
      }
      near.block[first / 16][k] = around;
    }
  }
}

/// Those near cells that may hold a point of a region, ascending, to ls.meets.
/// @param margin  metres, in all lanes
uint32_t gather_meeting(const Region& region, vec_float4 margin, const NearCells& near) {
  const vec_float4 distance = spu_add(region.radius, margin);
  uint32_t count = 0;
  for (uint32_t first = 0; first < near.count; first += 16) {
    const vec_float4* const block = near.block[first / 16];
    if (lanes_left(apart(region.box, block[0], block[1], block[2], block[3], block[4], block[5])) == 0)
      continue;
    const uint32_t end = first + 16 < near.count ? first + 16 : near.count;
    for (uint32_t i = first; i < end; i += 4) {
      const auto at = [&](uint32_t k) __attribute__((always_inline)) {
        return *reinterpret_cast<const vec_float4*>(near.box[k] + i);
      };
      const vec_uint4 far = apart(region.box, at(0), at(1), at(2), at(3), at(4), at(5));
      if (lanes_left(far) == 0) continue;
      const Bounds4 cells = bounds_at([&](uint32_t k) __attribute__((always_inline)) {
        return *reinterpret_cast<const vec_float4*>(ls.bounds.row[k] + i);
      });
      uint32_t left =
          lanes_left(spu_or(far, surely_far(cells, rough_places(cells, region.middle), distance)));
      while (left != 0) ls.meets[count++] = static_cast<uint16_t>(i + take_lane(left));
    }
  }
  return count;
}

/// Of a body with itself: whether two cells are too near at rest to touch.
bool belong_together(const CellAtRest& a, const CellAtRest& b) {
  int32_t square = 0;
  for (int d = 0; d < 3; ++d) {
    const int32_t off = spu_extract(a.place, d) - spu_extract(b.place, d);
    square += off * off;
  }
  return square <= kFindApart * kFindApart;
}

/// Two bodies as a Direction sees them: whose points, in whose cells.
struct Sides {
  const BodyInStore& mine;
  const BodyInStore& other;
  bool swap;  // contacts are as seen from `other`
  float least_volume;
  vec_float4 per_spacing;  // of the other

  Sides(const BodyInStore& my, const BodyInStore& its, bool seen_from_other)
      : mine(my),
        other(its),
        swap(seen_from_other),
        least_volume(0x1.0624dep-10f * its.spacing * its.spacing * its.spacing),  // 1e-3
        per_spacing(reciprocal(spu_splats(its.spacing))) {}
};

/// Inverses are of another body from now on.
void forget_inverses() {
  const vec_ushort8 nobody = spu_splats(kFindNoCell);
  for (uint32_t i = 0; i < kInverses; i += 8) *reinterpret_cast<vec_ushort8*>(ls.inverse_of + i) = nobody;
}

const RoughInverse& inverse_of(const Sides& sides, uint32_t cell) {
  const uint32_t place = cell % kInverses;
  if (ls.inverse_of[place] != cell) {
    const CellAtRest& at_rest = sides.other.cells[cell];
    // In two steps: of a result that a function writes where it belongs, the checker hears nothing.
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

  /// Of the candidates in ls.candidates. @return  false: there is no room
  bool find_among_candidates() {
    const Sides* now = nullptr;  // whose inverses are there
    for (uint32_t i = 0; i < ls.candidate_count;) {
      const bool of_b = (ls.candidates[i].of_groups & kFindOfB) != 0;
      const Sides& sides = of_b ? b_in_a_ : a_in_b_;
      if (now != &sides) forget_inverses();
      now = &sides;
      if (!find_of_cell(sides, i)) return false;
    }
    return true;
  }

  /// Of four points of a cell with another body's cell. @param rough  where they are in it, about
  /// @param elsewhere  words whose top bit is set where nobody asks
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
  /// All of the same four groups. @param i  the first of them; becomes the first one of others
  // Inlined, as Clang would do, its points would take stack also where a search begins anew.
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

/// What is known of candidates: all are in ls.candidates; nobody wants them, or they do not fit; there was no room to look for them.
enum class Candidates { kThere, kNotKept, kTooMany };

/// Of four near cells to ls.bounds.
// Not inlined: its arrays are not needed together with the points of a cell.
__attribute__((noinline)) void bound_four(const Sides& sides, const NearCells& near, uint32_t first) {
  vec_float4 middle[4], row1[4], row2[4], row3[4], reach[4], lengths[4], slope[4];
  for (uint32_t i = 0; i < 4; ++i) {
    const uint32_t k = first + i < near.count ? first + i : near.count - 1;
    const CellAtRest& at_rest = sides.other.cells[near.cell[k]];
    const RoughInverse inverse = rough_inverse(deformed_cell(at_rest.corner, sides.other.ends), at_rest.least,
                                               sides.least_volume, kNearInField);
    middle[i] = inverse.middle;
    row1[i] = only_xyz(inverse.row1);
    row2[i] = only_xyz(inverse.row2);
    row3[i] = only_xyz(inverse.row3);
    const vec_float4 uphill = spu_madd(
        splat_lane<0>(inverse.least), row1[i],
        spu_madd(splat_lane<1>(inverse.least), row2[i], spu_mul(splat_lane<2>(inverse.least), row3[i])));
    vec_float4 limit = spu_sub(inverse.limit, splat_lane<3>(inverse.least));
    reach[i] = inverse.reach;
    if (spu_extract(inverse.reach, 0) < 0.0f)  // nothing is in it now; when it is less flat, there may be
      reach[i] = limit = spu_splats(0x1.93e594p+99f);  // 1e30
    const vec_float4 length12 = interleave_low(length_in_all_lanes(row1[i]), length_in_all_lanes(row2[i]));
    const vec_uchar16 two_and_one = {0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23};
    lengths[i] = with_fourth(spu_shuffle(length12, length_in_all_lanes(row3[i]), two_and_one),
                             length_in_all_lanes(uphill));
    slope[i] = with_fourth(uphill, limit);
  }
  const auto store = [&](uint32_t row, const vec_float4* of_cells, uint32_t count)
      __attribute__((always_inline)) {
    const Rows4 rows = transpose(Rows4{of_cells[0], of_cells[1], of_cells[2], of_cells[3]});
    const vec_float4* const quads = &rows.a;
    for (uint32_t k = 0; k < count; ++k)
      *reinterpret_cast<vec_float4*>(ls.bounds.row[row + k] + first) = quads[k];
  };
  using B = NearBounds;
  store(B::kMiddle, middle, 3);
  store(B::kRow1, row1, 3);
  store(B::kRow1 + 3, row2, 3);
  store(B::kRow1 + 6, row3, 3);
  store(B::kReach, reach, 3);
  store(B::kSlope, slope, 4);  // and kLimit
  store(B::kLength, lengths, 3);
  const Rows4 rows = transpose(Rows4{lengths[0], lengths[1], lengths[2], lengths[3]});
  *reinterpret_cast<vec_float4*>(ls.bounds.row[B::kSteep] + first) = rows.d;
}

/// One body's points in the other body: candidates and contacts.
class Direction {
 public:
  /// @param margin  metres, of candidates
  Direction(const Sides& sides, const NearCells& near_mine, NearCells& near_other, float margin,
            Contacts& contacts, Candidates& candidates)
      : sides_(sides),
        near_mine_(near_mine),
        near_other_(near_other),
        // Rounding must not make a difference.
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

  /// Around all points, and the margin around the box.
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

/// Contacts to ls.contacts, candidates to ls.candidates.
/// @return  false: there is no room for contacts
bool find_anew(const BodyInStore& a, const BodyInStore& b, const FindTask& task, float margin,
               Contacts& contacts, Candidates& candidates) {
  const vec_float4 wide = only_xyz(spu_splats(margin));
  const vec_float4 low = spu_sub(*reinterpret_cast<const vec_float4*>(task.low), wide);
  const vec_float4 high = spu_add(*reinterpret_cast<const vec_float4*>(task.high), wide);
  const BoxInAllLanes box = {in_all_lanes(low), in_all_lanes(high)};
  NearCells &near_a = ls.near[0], &near_b = ls.near[1];
  BoxInAllLanes around_a, around_b;
  const Candidates kept = margin > 0.0f ? Candidates::kThere : Candidates::kNotKept;
  candidates = Candidates::kTooMany;
  ls.candidate_count = 0;
  if (task.itself != 0) {
    if (!gather_near(a, {box, nullptr, 0, 0}, near_a, around_a)) return true;
    candidates = kept;
    const Sides itself(a, a, false);
    return Direction(itself, near_a, near_a, margin, contacts, candidates).find();
  }
  // Between two planes across the line between their middles: only there the bodies meet.
  const vec_float4 direction = only_xyz(spu_sub(*reinterpret_cast<const vec_float4*>(task.b.middle),
                                                *reinterpret_cast<const vec_float4*>(task.a.middle)));
  const Reach reach_a = widened(reach_along(a, direction, ls.along[0]), direction, margin);
  const Reach reach_b = widened(reach_along(b, direction, ls.along[1]), direction, margin);
  near_a.count = near_b.count = 0;
  if (reach_b.least <= reach_a.most && reach_a.least <= reach_b.most) {
    if (!gather_near(b, {box, ls.along[1], reach_a.least, reach_a.most}, near_b, around_b)) return true;
    if (near_b.count != 0 &&
        !gather_near(a, {common(box, widened(around_b, wide)), ls.along[0], reach_b.least, reach_b.most},
                     near_a, around_a))
      return true;
    if (near_a.count != 0 &&
        !gather_near(b, {common(box, widened(around_a, wide)), ls.along[1], reach_a.least, reach_a.most},
                     near_b, around_b))
      return true;
  }
  candidates = kept;
  if (near_a.count == 0) return true;
  const Sides a_in_b(a, b, false), b_in_a(b, a, true);
  return Direction(a_in_b, near_a, near_b, margin, contacts, candidates).find() &&
         Direction(b_in_a, near_b, near_a, margin, contacts, candidates).find();
}

/// What two bodies have to do with each other; to ls.result and ls.contacts.
/// @return  false: there is no room
bool find_between(const BodyInStore& a, const BodyInStore& b, const FindTask& task, const TaskTerms& terms) {
  Contacts contacts(a, b, terms);
  ls.result.candidate_count = task.candidate_count;
  if (task.candidate_count != kFindUnknown) {
    ls.candidate_count = task.candidate_count;
    return contacts.find_among_candidates();
  }
  Candidates candidates;
  if (!find_anew(a, b, task, task.candidates_ea != 0 ? task.margin : 0.0f, contacts, candidates))
    return false;
  if (candidates == Candidates::kTooMany && task.margin > 0.0f &&
      !find_anew(a, b, task, 0.0f, contacts, candidates))
    return false;
  if (candidates == Candidates::kTooMany) return false;
  if (candidates == Candidates::kThere) {
    ls.result.candidate_count = ls.candidate_count;
    if (ls.candidate_count != 0) {
      put_large(ls.candidates, task.candidates_ea, bytes_of_candidates(ls.candidate_count), kTagOut);
      ls.under_way |= 1u << kTagOut;
    }
  }
  return true;
}

bool do_task(const FindTask& task) {
  if (find_bytes(task) > kFindMaxBytes || task.a.particle_count > kFindMaxParticles ||
      task.b.particle_count > kFindMaxParticles)
    return false;
  const uint32_t known = task.candidate_count;
  if (known != kFindUnknown && known != 0) {
    if (known > kFindMaxCandidates) return false;
    wait_for_all();  // those of the task before are gone
    get_large(ls.candidates, task.candidates_ea, bytes_of_candidates(known), kTagIn);
    ls.under_way |= 1u << kTagIn;
  }
  const bool itself = task.itself != 0, one_model = task.a.cells_ea == task.b.cells_ea;
  const uint32_t state_a = find_model_bytes(task.a);
  fetch_model(ls.model[0], 0, task.a);
  fetch_state(ls.state[0], state_a, task.a);
  const uint32_t model_b = state_a + find_state_bytes(task.a);
  const uint32_t state_b = model_b + (one_model ? 0 : find_model_bytes(task.b));
  if (itself) {
    ls.model[1].ea = ls.state[1].ea = 0;  // a may lie where they were
  } else {
    if (one_model)
      ls.model[1].ea = 0;
    else
      fetch_model(ls.model[1], model_b, task.b);
    fetch_state(ls.state[1], state_b, task.b);
  }
  wait_for_all();  // the contacts of the task before are gone, too
  const BodyInStore a = body_in_store(0, state_a, task.a);
  const BodyInStore b = itself ? a : body_in_store(one_model ? 0 : model_b, state_b, task.b);
  const TaskTerms terms = {task.step, task.inverse_step, task.friction, task.a.spacing};
  ls.result = {0, 0, 0, kFindUnknown};
  ls.contacts_sent = 0;
  ls.contacts_most = ls.job.contacts_room < kFindMaxContacts ? ls.job.contacts_room : kFindMaxContacts;
  if (find_between(a, b, task, terms)) {
    send_contacts();
    ls.contacts_ea += ls.result.count * sizeof(SolvedContact);
    ls.job.contacts_room -= ls.result.count;
  } else {
    const bool is_full = ls.result.count == ls.contacts_most && ls.contacts_most < kFindMaxContacts;
    ls.result = {0, 0, is_full ? kFindJobIsFull : kFindTooMany, kFindUnknown};
  }
  return true;
}

}  // namespace
}  // namespace softcell::spu

/// argp: effective address of a FindJob. Returns a FindStatus.
int main(uint64_t, uint64_t argp, uint64_t) {
  using namespace softcell::spu;
  ls.model[0].ea = ls.model[1].ea = ls.state[0].ea = ls.state[1].ea = 0;  // nothing is left of another job
  ls.under_way = 0;
  mfc_get(&ls.job, argp, sizeof(FindJob), kTagTask, 0, 0);
  wait_for_tag(kTagTask);
  ls.contacts_ea = ls.job.contacts_ea;
  for (uint32_t first = 0; first < ls.job.task_count; first += kBatch) {
    const uint32_t left = ls.job.task_count - first, count = left < kBatch ? left : kBatch;
    mfc_get(ls.tasks, ls.job.tasks_ea + first * sizeof(FindTask), count * sizeof(FindTask), kTagTask, 0, 0);
    wait_for_tag(kTagTask);
    for (uint32_t i = 0; i < count; ++i) {
      if (!do_task(ls.tasks[i])) {
        wait_for_all();
        return kFindTooLarge;
      }
      ls.results[i] = ls.result;
    }
    mfc_put(ls.results, ls.job.results_ea + first * sizeof(FindResult), count * sizeof(FindResult), kTagTask,
            0, 0);
    wait_for_tag(kTagTask);
  }
  wait_for_all();
  return kFindDone;
}
