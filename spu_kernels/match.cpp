// match: lattice shape matching and damping of bodies that fit a local store.  [LSM07]
//
//   array       direction  element                     count                     alignment
//   job         in         MatchJob, 128 bytes         1                         128
//   plan        in         MatchPlanHeader and lists   once a job                128
//   body        in         MatchBody, 128 bytes        one for each body         128
//   positions   in         x y z 0, 16 bytes           one for each particle     16
//   velocities  in, out    x y z 0, 16 bytes           one for each particle     16
//   rotations   in, out    MatchRotations, 64 bytes    one for four regions      16
//   result      out        MatchResult, 16 bytes       1                         16
//
// A body is stepped whole: between its stages nothing goes through main memory. Particles are corners of the
// lattice's cells, so their positions are all that skinning needs, and those do not change here.
//
// Budget: 243 KB. 216 KB for plan, state and sums (about 220 bytes a particle: a solid block of 1000 fits),
// the rest for code and 4 KB of stack.
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

enum Tag : uint32_t { kTagIn = 0, kTagOut = 1 };

#ifdef SOFTCELL_CHECKED
constexpr uint32_t kArenaBytes = kMatchCheckedArenaBytes;
#else
constexpr uint32_t kArenaBytes = kMatchArenaBytes;
#endif

/// Everything this kernel keeps in local store beside its code and stack.
struct alignas(128) LocalStoreMap {
  MatchJob job;
  MatchBody body;
  MatchResult result;
  alignas(128) char arena[kArenaBytes];
};
LocalStoreMap ls;

const MatchPlanHeader& plan() { return *reinterpret_cast<const MatchPlanHeader*>(ls.arena); }

/// @return false when plan and state do not fit the arena; only the header is there then.
bool load_plan() {
  mfc_get(ls.arena, ls.job.plan_ea, sizeof(MatchPlanHeader), kTagIn, 0, 0);
  wait_for_tag(kTagIn);
  if (!match_fits(plan(), kArenaBytes)) return false;
  get_large(ls.arena + sizeof(MatchPlanHeader), ls.job.plan_ea + sizeof(MatchPlanHeader),
            plan().bytes - static_cast<uint32_t>(sizeof(MatchPlanHeader)), kTagIn);
  wait_for_tag(kTagIn);
  return true;
}

void load_body(const BodyMap& map) {
  const uint32_t vectors = plan().particles * 16;
  get_large(map.positions, ls.body.positions_ea, vectors, kTagIn);
  get_large(map.velocities, ls.body.velocities_ea, vectors, kTagIn);
  get_large(map.rotations, ls.body.rotations_ea, match_rotations_bytes(plan()), kTagIn);
  wait_for_tag(kTagIn);
}

void store_body(const BodyMap& map) {
  put_large(map.velocities, ls.body.velocities_ea, plan().particles * 16, kTagOut);
  put_large(map.rotations, ls.body.rotations_ea, match_rotations_bytes(plan()), kTagOut);
}

void step(const BodyMap& map) {
  const uint32_t particles = plan().particles;
  load_body(map);
  vec_float4* const x = particle_quadwords(map.positions);
  vec_float4* const v = particle_quadwords(map.velocities);
  ls.result = {0, all_finite(x, particles) && all_finite(v, particles), {0, 0}};
  if (ls.result.finite != 0) {
    vec_float4 samples[kMatchSamples];
    for (uint32_t i = 0; i < kMatchSamples; ++i) samples[i] = x[plan().samples[i]];
    to_components(map.positions, particles, origin_of(samples, kMatchSamples, plan().grid));
    to_components(map.velocities, particles, spu_splats(0.0f));
    const vec_float4 residual = step_body(map, {ls.body.pull,
                                                ls.body.damping,
                                                {ls.job.least_iterations, ls.job.most_iterations},
                                                ls.body.cold != 0});
    ls.result.residual_square = largest_lane(residual);
    to_particles(map.velocities, map.particle_groups);
    store_body(map);
  }
  mfc_put(&ls.result, ls.body.result_ea, sizeof(MatchResult), kTagOut, 0, 0);
}

}  // namespace
}  // namespace softcell::spu

/// argp: effective address of a MatchJob. Returns a MatchStatus.
int main(uint64_t, uint64_t argp, uint64_t) {
  using namespace softcell::spu;
  mfc_get(&ls.job, argp, sizeof(MatchJob), kTagIn, 0, 0);
  wait_for_tag(kTagIn);
  if (ls.job.body_count == 0) return kMatchDone;
  if (!load_plan()) return kMatchTooLarge;

  const BodyMap map = map_of(ls.arena);
  clear(map.first[0]);
  clear(map.second[0]);
  for (uint32_t i = 0; i < ls.job.body_count; ++i) {
    mfc_get(&ls.body, ls.job.bodies_ea + static_cast<uint64_t>(i) * sizeof(MatchBody), sizeof(MatchBody),
            kTagIn, 0, 0);
    wait_for_tags(1u << kTagIn | 1u << kTagOut);  // the body before has left
    step(map);
  }
  wait_for_tag(kTagOut);
  return kMatchDone;
}
