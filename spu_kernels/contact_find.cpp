// contact_find: finds where soft bodies would enter each other, or themselves, in the coming step.  [FL01], [MZS+11]
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
// The kernel compares boxes of the two bodies' cells, four at a time; then points, four at a time, with parallelepipeds around the cells
// and a plane below the distance field. Points that are near by these bounds, widened by a margin, are candidates, which can be used again
// in the next steps. For points that are near without the margin, the kernel finds the place in the cell by Newton's iteration, four points
// at a time; these are few. If candidates are known from an earlier step, the search begins with them.
//
// Contacts do not depend on the margin: with any margin, a point in a cell is a candidate of that cell.
//
// Budget: 244 KB. 148 KB of bodies and their models, 11 KB of contacts, 44 KB of cells that are near, their bounds and candidates;
// the rest for code and 6.5 KB of stack.
//
// Compiles unchanged with a real SPU g++ (7 to 9, -std=c++17).

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "contact_find/direction.h"
#include "contact_find/found_contacts.h"
#include "contact_find/local_store.h"
#include "contact_find/near_cells.h"

namespace softcell::spu {
namespace {

/// Finds contacts and candidates of two bodies without knowing any; to ls.contacts and ls.candidates.
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
  // The bodies can only meet between two planes across the line between their middles.
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

/// Finds where two bodies touch, among candidates if they are known; to ls.result and ls.contacts.
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

/// Fetches the two bodies of a task and finds their contacts; to ls.result and main memory.
/// @return  false: the task does not fit into the local store
bool do_task(const FindTask& task) {
  if (find_bytes(task) > kFindMaxBytes || task.a.particle_count > kFindMaxParticles ||
      task.b.particle_count > kFindMaxParticles)
    return false;
  const uint32_t known = task.candidate_count;
  if (known != kFindUnknown && known != 0) {
    if (known > kFindMaxCandidates) return false;
    wait_for_all();  // until the contacts of the task before are stored
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
    ls.model[1].ea = ls.state[1].ea = 0;  // a may have overwritten them
  } else {
    if (one_model)
      ls.model[1].ea = 0;
    else
      fetch_model(ls.model[1], model_b, task.b);
    fetch_state(ls.state[1], state_b, task.b);
  }
  wait_for_all();  // also until the contacts of the task before are stored
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
  // Nothing of an earlier job is there.
  ls.model[0].ea = ls.model[1].ea = ls.state[0].ea = ls.state[1].ea = 0;
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
