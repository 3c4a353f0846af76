// match: lattice shape matching and damping of bodies that fit a local store.  [LSM07]
//
//   array       direction  element                     count                     alignment
//   job         in         MatchJob, 128 bytes         1                         128
//   plan        in         MatchPlanHeader and lists   once a job                128
//   bodies      in         MatchBody, 16 bytes         one for each body         16
//   positions   in         x y z 0, 16 bytes           one for each particle     16, of a body
//   state       in, out    MatchResult, then           one for each body         16, of a body
//                          x y z 0 of velocities, then one for each particle
//                          MatchRotations, 64 bytes    one for four regions
//
// One SPE steps a whole body: data stay in local store between the stages of a step. Skinning needs only the
// positions of particles, which are the corners of lattice cells; this kernel does not change them.
//
// Budget: 244 KB. 216 KB for plan, state and sums (about 220 bytes a particle: a solid block of 1000 fits),
// the rest for code and 5 KB of stack.
//
// Compiles unchanged with a real SPU g++ (7 to 9, -std=c++17).

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "common/dma.h"
#include "common/finite.h"
#include "common/reciprocal.h"
#include "match/step.h"
#include "match_job.h"

namespace softcell::spu {
namespace {

/// A tag group for the job and the plan, and one for the body that is stepped.
enum Tag : uint32_t { kTagJob = 0, kTagBody = 1 };

constexpr uint32_t kBodiesAtOnce = 64;  // MatchBody records fetched by one get

#ifdef SOFTCELL_CHECKED
constexpr uint32_t kArenaBytes = kMatchCheckedArenaBytes;
#else
constexpr uint32_t kArenaBytes = kMatchArenaBytes;
#endif

/// Everything this kernel keeps in local store beside its code and stack.
struct alignas(128) LocalStoreMap {
  MatchJob job;
  alignas(128) MatchBody bodies[kBodiesAtOnce];
  alignas(128) char arena[kArenaBytes];
};
LocalStoreMap ls;

const MatchPlanHeader& plan() { return *reinterpret_cast<const MatchPlanHeader*>(ls.arena); }

/// Fetches the plan. @return  false: plan and state do not fit into the arena, and only the plan's header was fetched
bool load_plan() {
  mfc_get(ls.arena, ls.job.plan_ea, sizeof(MatchPlanHeader), kTagJob, 0, 0);
  wait_for_tag(kTagJob);
  if (!match_fits(plan(), kArenaBytes)) return false;
  get_large(ls.arena + sizeof(MatchPlanHeader), ls.job.plan_ea + sizeof(MatchPlanHeader),
            plan().bytes - static_cast<uint32_t>(sizeof(MatchPlanHeader)), kTagJob);
  wait_for_tag(kTagJob);
  return true;
}

/// Steps one body. Its gets have a fence, so they wait for the puts of the body before, which lies in the same place.
void step(const MatchBody& body, const BodyMap& map) {
  const uint32_t particles = plan().particles;
  getf_large(map.positions, body.positions_ea, particles * 16, kTagBody);
  getf_large(map.result, body.state_ea, match_state_bytes(plan()), kTagBody);
  wait_for_tag(kTagBody);

  vec_float4* const x = particle_quadwords(map.positions);
  vec_float4* const v = particle_quadwords(map.velocities);
  const bool cold = map.result->cold != 0;
  if (!all_finite(x, particles) || !all_finite(v, particles)) {
    *map.result = {0, 0, cold, 0};
    mfc_put(map.result, body.state_ea, sizeof(MatchResult), kTagBody, 0, 0);
    return;
  }
  vec_float4 samples[kMatchSamples];
  for (uint32_t i = 0; i < kMatchSamples; ++i) samples[i] = x[plan().samples[i]];
  to_components(map.positions, particles, origin_of(samples, plan().grid));
  to_components(map.velocities, particles, spu_splats(0.0f));
  const vec_float4 residual =
      step_body(map, {ls.job.pull, ls.job.damping, {ls.job.least_iterations, ls.job.most_iterations}, cold});
  to_particles(map.velocities, map.particle_groups);
  *map.result = {largest_lane(residual), 1, 0, 0};
  put_large(map.result, body.state_ea, match_state_bytes(plan()), kTagBody);
}

}  // namespace
}  // namespace softcell::spu

/// argp: effective address of a MatchJob. Returns a MatchStatus.
int main(uint64_t, uint64_t argp, uint64_t) {
  using namespace softcell::spu;
  mfc_get(&ls.job, argp, sizeof(MatchJob), kTagJob, 0, 0);
  wait_for_tag(kTagJob);
  if (ls.job.body_count == 0) return kMatchDone;
  if (!load_plan()) return kMatchTooLarge;

  const BodyMap map = map_of(ls.arena);
  clear(map.first[0]);
  clear(map.second[0]);
  for (uint32_t first = 0; first < ls.job.body_count; first += kBodiesAtOnce) {
    const uint32_t left = ls.job.body_count - first, count = left < kBodiesAtOnce ? left : kBodiesAtOnce;
    mfc_get(ls.bodies, ls.job.bodies_ea + static_cast<uint64_t>(first) * sizeof(MatchBody),
            count * static_cast<uint32_t>(sizeof(MatchBody)), kTagJob, 0, 0);
    wait_for_tag(kTagJob);
    for (uint32_t i = 0; i < count; ++i) step(ls.bodies[i], map);
  }
  wait_for_tag(kTagBody);
  return kMatchDone;
}
