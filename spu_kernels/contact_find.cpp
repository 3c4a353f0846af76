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
//   contacts  out        SolveContact, 176 bytes     <= 192 of a task  16
//   results   out        FindResult, 16 bytes        1 of a task       16
//
// Cells of the two bodies are held against each other by their boxes, four at a time; then points, four at a time, against
// parallelepipeds and a plane below the distance field; what is left is found by Newton's iteration, four points at a time. Few points
// come so far.
//
// Budget: 232 KB. 128 KB of bodies and their models, 33 KB of contacts, 30 KB of cells that are near; the rest for code and 6 KB of
// stack.
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

constexpr uint32_t kBatch = 16;  // tasks that are fetched together
/// Something that is in the local store already.
struct Part {
  uint64_t ea;  // 0: nothing
  uint32_t offset;
};

/// Cells of a body that are near the other one: their boxes, as in FindBoxes but close together.
struct NearCells {
  uint32_t count;
  alignas(16) float box[6][kFindMaxNear + 4];
  uint16_t cell[kFindMaxNear];
};

/// Everything this kernel keeps in local store beside its code and stack.
struct alignas(128) LocalStoreMap {
  FindJob job;
  FindTask tasks[kBatch];
  FindResult results[kBatch];
  FindResult result;
  alignas(128) char bytes[kFindMaxBytes];  // model and state of a, then those of b
  Part model[2], state[2];
  alignas(128) SolvedContact contacts[kFindMaxContacts];
  NearCells near[2];  // of a, of b
  RoughInverse inverse[kFindMaxNear];
  bool has_inverse[kFindMaxNear];
  uint16_t meets[kFindMaxNear];
  alignas(16) float along[2][kFindMaxParticles];  // places of particles between the two bodies
  uint32_t under_way;                             // tag groups with transfers
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

/// Until all transfers of bodies and contacts are complete.
void wait_for_all() {
  if (ls.under_way != 0) wait_for_tags(ls.under_way);
  ls.under_way = 0;
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

/// Those near cells that meet a box, ascending, to ls.meets.
uint32_t gather_meeting(const BoxInAllLanes& box, const NearCells& near) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < near.count; i += 4) {
    const auto at = [&](uint32_t k) __attribute__((always_inline)) {
      return *reinterpret_cast<const vec_float4*>(near.box[k] + i);
    };
    uint32_t left = lanes_left(apart(box, at(0), at(1), at(2), at(3), at(4), at(5)));
    while (left != 0) ls.meets[count++] = static_cast<uint16_t>(i + take_lane(left));
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

/// The points of one body in another.
class Direction {
 public:
  Direction(const BodyInStore& mine, const BodyInStore& other, const NearCells& near_mine,
            const NearCells& near_other, bool swap, const TaskTerms& terms)
      : mine_(mine),
        other_(other),
        near_mine_(near_mine),
        near_other_(near_other),
        swap_(swap),
        terms_(terms),
        least_volume_(0x1.0624dep-10f * other.spacing * other.spacing * other.spacing) {}  // 1e-3

  /// @return  false: there is no room
  bool find() {
    for (uint32_t i = 0; i < near_other_.count; ++i) ls.has_inverse[i] = false;
    for (uint32_t i = 0; i < near_mine_.count; ++i) {
      const uint32_t cell = near_mine_.cell[i];
      if (spu_extract(mine_.cells[cell].place, 5) == 0) continue;  // no points in it
      const auto all = [&](uint32_t k) __attribute__((always_inline)) {
        return spu_splats(near_mine_.box[k][i]);
      };
      const uint32_t meets =
          gather_meeting({{all(0), all(1), all(2)}, {all(3), all(4), all(5)}}, near_other_);
      if (meets != 0 && !try_cell(cell, meets)) return false;
    }
    return true;
  }

 private:
  const RoughInverse& inverse_of(uint32_t near_index) {
    if (!ls.has_inverse[near_index]) {
      const CellAtRest& cell = other_.cells[near_other_.cell[near_index]];
      ls.inverse[near_index] =
          rough_inverse(deformed_cell(cell.corner, other_.ends), cell.least, least_volume_, kNearInField);
      ls.has_inverse[near_index] = true;
    }
    return ls.inverse[near_index];
  }

  /// Four points of a cell at the step's end.
  struct FourPoints {
    Vector3x4 s, end;
    vec_float4 allowance;  // metres
    vec_float4 allowance_in_cells;
    vec_uint4 done;  // top bit set: found in a cell, or no point
  };

  bool try_cell(uint32_t cell, uint32_t meets) {
    const CellAtRest& own = mine_.cells[cell];
    uint32_t first = static_cast<uint32_t>(spu_extract(own.place, 4)) & 0xFFFFu;
    const uint32_t end = first + (static_cast<uint32_t>(spu_extract(own.place, 5)) & 0xFFFFu);
    const CellMap map = in_all_lanes(deformed_cell(own.corner, mine_.ends));
    const vec_float4 per_spacing = reciprocal(spu_splats(other_.spacing));
    constexpr uint32_t kGroups = 4;
    FourPoints points[kGroups];
    for (; first < end; first += kGroups) {
      const uint32_t count = end - first < kGroups ? end - first : kGroups;
      for (uint32_t i = 0; i < count; ++i) {
        const vec_float4* const group = mine_.groups + (first + i) * 4;
        FourPoints& four = points[i];
        four.s = {group[0], group[1], group[2]};
        four.end = map_points(map, four.s).position;
        four.allowance = group[3];
        four.allowance_in_cells = spu_mul(group[3], per_spacing);
        four.done = less(spu_splats(0.5f * kFindNoPoint), group[3]);
      }
      for (uint32_t i = 0; i < meets; ++i)
        if (!try_points(cell, ls.meets[i], points, count)) return false;
    }
    return true;
  }

  /// @return  false: there is no room
  bool try_points(uint32_t cell, uint32_t near_index, FourPoints* points, uint32_t count) {
    const uint32_t there = near_other_.cell[near_index];
    if (&mine_ == &other_ && belong_together(mine_.cells[cell], other_.cells[there])) return true;
    const RoughInverse4 inverse = in_all_lanes(inverse_of(near_index));
    for (uint32_t i = 0; i < count; ++i) {
      FourPoints& four = points[i];
      const Vector3x4 rough = rough_place(inverse, four.end);
      const vec_uint4 elsewhere =
          spu_or(four.done, surely_elsewhere(inverse, rough, four.allowance_in_cells));
      if (lanes_left(elsewhere) != 0 && !try_group(cell, there, inverse, four, rough, elsewhere))
        return false;
    }
    return true;
  }

  __attribute__((noinline)) bool try_group(uint32_t cell, uint32_t there, const RoughInverse4& inverse,
                                           FourPoints& four, const Vector3x4& rough, vec_uint4 elsewhere) {
    const CellMap map = in_all_lanes(deformed_cell(other_.cells[there].corner, other_.ends));
    const FoundPlaces places =
        find_places(map, inverse, four.end, rough, four.allowance_in_cells, elsewhere, least_volume_);
    ls.result.looked_at += 4;
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
      if (ls.result.count == kFindMaxContacts) return false;
      const PointInCell point = {
          cell,       there,       p_own[lane],
          p_at[lane], p1[lane],    p2[lane],
          p3[lane],   p_end[lane], spu_extract(four.allowance, static_cast<int>(lane))};
      SolvedContact& contact = ls.contacts[ls.result.count];
      if (!make_contact(mine_, other_, point, swap_, terms_, contact)) continue;
      ++ls.result.count;
      if (spu_extract(contact.terms, 2) > 0.0f) ls.result.pushes = 1;
    }
    return true;
  }

  const BodyInStore& mine_;
  const BodyInStore& other_;
  const NearCells &near_mine_, &near_other_;
  bool swap_;
  const TaskTerms& terms_;
  float least_volume_;
};

/// What two bodies have to do with each other; to ls.result and ls.contacts.
/// @return  false: there is no room
bool find_between(const BodyInStore& a, const BodyInStore& b, const FindTask& task, const TaskTerms& terms) {
  const vec_float4 low = *reinterpret_cast<const vec_float4*>(task.low);
  const vec_float4 high = *reinterpret_cast<const vec_float4*>(task.high);
  const BoxInAllLanes box = {in_all_lanes(low), in_all_lanes(high)};
  NearCells &near_a = ls.near[0], &near_b = ls.near[1];
  BoxInAllLanes around_a, around_b;
  if (task.itself != 0) {
    if (!gather_near(a, {box, nullptr, 0, 0}, near_a, around_a)) return false;
    return Direction(a, a, near_a, near_a, false, terms).find();
  }
  // Between two planes across the line between their middles: only there the bodies meet.
  const vec_float4 direction = spu_sub(*reinterpret_cast<const vec_float4*>(task.b.middle),
                                       *reinterpret_cast<const vec_float4*>(task.a.middle));
  const Reach reach_a = reach_along(a, direction, ls.along[0]);
  const Reach reach_b = reach_along(b, direction, ls.along[1]);
  if (reach_b.least > reach_a.most || reach_a.least > reach_b.most) return true;
  if (!gather_near(b, {box, ls.along[1], reach_a.least, reach_a.most}, near_b, around_b)) return false;
  if (near_b.count == 0) return true;
  if (!gather_near(a, {common(box, around_b), ls.along[0], reach_b.least, reach_b.most}, near_a, around_a))
    return false;
  if (near_a.count == 0) return true;
  if (!gather_near(b, {common(box, around_a), ls.along[1], reach_a.least, reach_a.most}, near_b, around_b))
    return false;
  return Direction(a, b, near_a, near_b, false, terms).find() &&
         Direction(b, a, near_b, near_a, true, terms).find();
}

bool do_task(const FindTask& task) {
  if (find_bytes(task) > kFindMaxBytes || task.a.particle_count > kFindMaxParticles ||
      task.b.particle_count > kFindMaxParticles)
    return false;
  const bool itself = task.itself != 0, one_model = task.a.cells_ea == task.b.cells_ea;
  const uint32_t state_a = find_model_bytes(task.a);
  fetch_model(ls.model[0], 0, task.a);
  fetch_state(ls.state[0], state_a, task.a);
  const uint32_t model_b = state_a + find_state_bytes(task.a);
  const uint32_t state_b = model_b + (one_model ? 0 : find_model_bytes(task.b));
  if (!itself) {
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
  ls.result = {0, 0, 0, 0};
  if (!find_between(a, b, task, terms)) ls.result = {0, 0, 1, 0};
  if (ls.result.count == 0) return true;
  put_large(ls.contacts, task.contacts_ea, ls.result.count * static_cast<uint32_t>(sizeof(SolvedContact)),
            kTagOut);
  ls.under_way |= 1u << kTagOut;
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
