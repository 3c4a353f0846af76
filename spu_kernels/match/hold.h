#pragma once
// Keeps the pull from moving the body as a whole.
//
// The sum of m (g - x) over a body is zero except for rounding errors. But truncation always errs in the same direction, so a body at rest
// would begin to drift. Therefore the kernels sum it up and subtract it from the velocities. They add integers: such a sum is exact and so
// the same in any order, and several SPEs may each add some particles.

#include <spu_intrinsics.h>
#include <stdint.h>

#include "common/lane_mask.h"
#include "common/vector3.h"
#include "match_job.h"

namespace softcell::spu {

/// The sum of m (g - x) over particles, in units of 1 / MatchHold::scale: 65536 times `high` plus `low`, summed over
/// lanes. For up to 65,536 particles in each lane.
struct PullSum {
  vec_int4 high[3];
  vec_uint4 low[3];
  vec_uint4 far;  ///< top bit set: a pull is too large for the unit, and the sum is useless
};
constexpr uint32_t kPullSumWords = 28;
static_assert(sizeof(PullSum) == 4 * kPullSumWords, "seven quadwords");

inline PullSum no_pulls() {
  const vec_int4 zero = spu_splats(0);
  const vec_uint4 none = spu_splats(0u);
  return {{zero, zero, zero}, {none, none, none}, none};
}

/// Copies a sum member by member: for a whole structure some compilers call memcpy(), and there is none in a local store.
inline void copy_sum(const PullSum& from, PullSum& to) {
  to.high[0] = from.high[0];
  to.high[1] = from.high[1];
  to.high[2] = from.high[2];
  to.low[0] = from.low[0];
  to.low[1] = from.low[1];
  to.low[2] = from.low[2];
  to.far = from.far;
}

/// Rounds to the nearest integers. Truncation would be the very error that the sum shall remove.
inline vec_int4 to_nearest(vec_float4 units) {
  const vec_int4 halves = spu_convts(units, 1);
  return spu_rlmaska(spu_add(spu_add(halves, 1), spu_rlmaska(halves, -31)), -1);
}

/// @param weight  m times MatchHold::scale
inline void add_pulls(PullSum& sum, const Vector3x4& to_goal, vec_float4 weight) {
  const vec_float4 pulls[3] = {spu_mul(to_goal.x, weight), spu_mul(to_goal.y, weight),
                               spu_mul(to_goal.z, weight)};
  for (int d = 0; d < 3; ++d) {
    const vec_int4 units = to_nearest(pulls[d]);
    sum.high[d] = spu_add(sum.high[d], spu_rlmaska(units, -16));
    sum.low[d] = spu_add(sum.low[d], spu_and((vec_uint4)units, spu_splats(0xFFFFu)));
    sum.far = spu_or(sum.far, not_less(absolute(pulls[d]), spu_splats(kMatchPullLimit)));
  }
}

/// Moves the bits of `low` above 16 to `high`, so that 65,536 such sums can be added.
inline void carry(PullSum& sum) {
  for (int d = 0; d < 3; ++d) {
    sum.high[d] = spu_add(sum.high[d], (vec_int4)spu_rlmask(sum.low[d], -16));
    sum.low[d] = spu_and(sum.low[d], spu_splats(0xFFFFu));
  }
}

/// @pre `low` does not overflow: carry() was called for both sums, or they have few particles
inline void add_sums(PullSum& sum, const PullSum& other) {
  for (int d = 0; d < 3; ++d) {
    sum.high[d] = spu_add(sum.high[d], other.high[d]);
    sum.low[d] = spu_add(sum.low[d], other.low[d]);
  }
  sum.far = spu_or(sum.far, other.far);
}

/// The velocity that all pulls together give the body, which has to be subtracted.
/// @param share  MatchHold::share times the pull, 1 / s
inline Vector3x4 drift_of(const PullSum& pulls, float share) {
  PullSum sum;
  copy_sum(pulls, sum);
  carry(sum);
  const bool far = any_negative(sum.far);
  const auto component = [&](int d) {
    int32_t high = 0;
    uint32_t low = 0;
    for (int lane = 0; lane < 4; ++lane) {
      high += spu_extract(sum.high[d], lane);
      low += spu_extract(sum.low[d], lane);
    }
    high += static_cast<int32_t>(low >> 16);
    const float units = static_cast<float>(high) * 65536.0f + static_cast<float>(low & 0xFFFFu);
    return spu_splats(far ? 0.0f : units * share);
  };
  return {component(0), component(1), component(2)};
}

}  // namespace softcell::spu
