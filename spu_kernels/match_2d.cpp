// match_2d: lattice shape matching and damping in two dimensions, of bodies that fit a local store.  [LSM07]
//
//   array       direction  element                      count                     alignment
//   job         in         MatchJob2d, 128 bytes        1                         128
//   plan        in         MatchPlanHeader2d and lists  once a job                128
//   positions   in         x y, 8 bytes                 one for each particle     128, of a body
//   state       in, out    MatchResult2d, then          one for each body         128
//                          x y of velocities, then      one for each particle
//                          MatchDirections, 32 bytes    one for four regions
//
// One SPE steps a whole body: data stay in local store between the stages of a step. The kernel fetches one
// body while it steps another:
//
//   get   [0 A][1 B]          [2 A]          [3 B]     A, B: two places in local store, a tag group each;
//   work       [   0 A   ]    [   1 B   ]    [ 2 A     a get has a fence: it waits for the put of the body
//   put                  [0 A]          [1 B]          that was in the same place before
//
// Budget: 224 KB. 192 KB for plan, bodies and sums (about 140 bytes a particle: 1300 fit), the rest for code
// and 2 KB of stack.
//
// Compiles unchanged with a real SPU g++ (7 to 9, -std=c++17).

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "common/dma.h"
#include "common/finite.h"
#include "match_2d/localise.h"
#include "match_2d/step.h"
#include "match_2d_job.h"

namespace softcell::spu {
namespace {

/// Each of the two places of bodies has a tag group: kTagBody and kTagBody + 1. Job and plan, which are fetched before all bodies, use the
/// first one.
enum Tag : uint32_t { kTagJob = 0, kTagBody = 0 };

/// Everything this kernel keeps in local store beside its code and stack.
struct alignas(128) LocalStoreMap {
  MatchJob2d job;
  alignas(128) char arena[kMatch2dArenaBytes];
};
LocalStoreMap ls;

const MatchPlanHeader2d& plan() { return *reinterpret_cast<const MatchPlanHeader2d*>(ls.arena); }

/// Fetches the plan. @return  false: plan and bodies do not fit into the arena, and only the plan's header was fetched
bool load_plan() {
  mfc_get(ls.arena, ls.job.plan_ea, sizeof(MatchPlanHeader2d), kTagJob, 0, 0);
  wait_for_tag(kTagJob);
  if (!match_2d_fits(plan())) return false;
  get_large(ls.arena + sizeof(MatchPlanHeader2d), ls.job.plan_ea + sizeof(MatchPlanHeader2d),
            plan().bytes - static_cast<uint32_t>(sizeof(MatchPlanHeader2d)), kTagJob);
  wait_for_tag(kTagJob);
  return true;
}

/// Where a body is in main memory.
struct BodyPlace {
  uint64_t positions_ea, state_ea;
};

/// The place of the next body. Addresses are added up, because an SPU has no 64-bit multiplication.
BodyPlace behind(const BodyPlace& body) {
  return {body.positions_ea + match_2d_positions_stride(plan()),
          body.state_ea + match_2d_state_stride(plan())};
}

/// Begins to fetch a body. The gets have a fence, so they wait for the puts of the body that was in this place before.
void fetch(const BodyMap2d& map, const BodyPlace& body, uint32_t tag) {
  getf_large(map.positions, body.positions_ea, match_2d_vectors_bytes(plan()), tag);
  getf_large(map.result, body.state_ea, match_2d_state_bytes(plan()), tag);
}

/// Steps one body in local store. Positions and velocities arrive and leave as pairs of particles.
/// @return  the number of bytes of its state that have to be written to main memory
uint32_t step(const PlanMap2d& map, const BodyMap2d& body) {
  const uint32_t particles = plan().particles, pairs = 2 * map.particle_groups;
  vec_float4* const x = particle_pairs(body.positions);
  vec_float4* const v = particle_pairs(body.velocities);
  pad_pairs(x, particles, first_of_pair(x[0]));
  pad_pairs(v, particles, spu_splats(0.0f));
  *body.result = {all_finite(x, pairs) && all_finite(v, pairs), {0, 0, 0}};
  if (body.result->finite == 0) return sizeof(MatchResult2d);

  to_components(body.positions, map.particle_groups,
                origin_of_pairs(x, particles, plan().inverse_particles, plan().grid));
  to_components(body.velocities, map.particle_groups, spu_splats(0.0f));
  step_body(map, body, ls.job.pull, ls.job.damping);
  to_pairs(body.velocities, map.particle_groups);
  return match_2d_state_bytes(plan());
}

}  // namespace
}  // namespace softcell::spu

/// argp: effective address of a MatchJob2d. Returns a Match2dStatus.
int main(uint64_t, uint64_t argp, uint64_t) {
  using namespace softcell::spu;
  mfc_get(&ls.job, argp, sizeof(MatchJob2d), kTagJob, 0, 0);
  wait_for_tag(kTagJob);
  if (ls.job.body_count == 0) return kMatch2dDone;
  if (!load_plan()) return kMatch2dTooLarge;

  const ArenaMap2d map = map_of_2d(ls.arena);
  clear(map.plan.first[0]);
  clear(map.plan.second[0]);
  BodyPlace body = {ls.job.positions_ea, ls.job.states_ea};
  fetch(map.body[0], body, kTagBody);
  for (uint32_t i = 0; i < ls.job.body_count; ++i) {
    const uint32_t side = i % 2, other = 1 - side;
    const BodyPlace next = behind(body);
    if (i + 1 < ls.job.body_count) fetch(map.body[other], next, kTagBody + other);
    wait_for_tag(kTagBody + side);
    const uint32_t bytes = step(map.plan, map.body[side]);
    put_large(map.body[side].result, body.state_ea, bytes, kTagBody + side);
    body = next;
  }
  wait_for_tags(1u << kTagBody | 1u << (kTagBody + 1));
  return kMatch2dDone;
}
