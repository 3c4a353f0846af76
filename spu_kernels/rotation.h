#pragma once
// The rotation nearest to a matrix, for four regions at a time: R = argmax <R, A>.
//
// Newton's method on SO(3) from the last step's quaternion: [KKB18] with the safeguards below.
//
//   S = R^T A                    the matrix in the body's frame
//   g = axial(S)                 gradient;  g = 0 and H > 0 only at the optimum, all else are saddles
//   H = (tr S + mu) 1 - sym(S)   minus the Hessian; eigenvalues s_j + s_k + mu at the optimum
//   omega = H^-1 g,  q := normalize(q (1, omega / 2))
//
// With signed singular values s1 >= s2 >= |s3|, A does not determine rotations about an axis with s_j + s_k = 0: the twist of a line, any
// rotation of a point. About such an axis g has no component and mu keeps H invertible, so the rotation about it does not change. A of
// rank 2 determines the rotation. The result is made from a unit quaternion, so it is a proper rotation for every A.
//
// Lanes in which H is not positive, or which have not converged after the last iteration, start again from Davenport's matrix
// (rotation_cold.h). That is rare: after teleports, and in bodies that are turned inside out within a step.

#include <spu_intrinsics.h>

#include "common/lane_mask.h"
#include "common/matrix3.h"
#include "common/reciprocal.h"
#include "common/unit_scale.h"
#include "rotation_cold.h"

namespace softcell::spu {

/// The limits of the iteration. Residuals are |axial(R^T A)| over the sum of |A|'s elements, roughly an angle.
struct RotationEffort {
  uint32_t least;  ///< iterations that are always made
  uint32_t most;   ///< iterations after which to stop in any case, `least` or more
};

/// Always two iterations. They find a turn of 0.3 rad in one step to within 1e-3 rad, and one of 0.05 rad to within 1e-6 rad.
constexpr RotationEffort kTwoIterations = {2, 2};
/// As many iterations as it takes for the residual to fall below kRotationResidual: none for a body at rest.
constexpr RotationEffort kAdaptive = {0, 6};

constexpr float kRotationResidual = 2e-6f;       ///< some roundings
constexpr float kRotationLost = 0x1.89374cp-9f;  ///< 0.003: a lane with a larger residual starts again

struct Rotation4 {
  Matrix3x4 matrix;
  vec_float4 residual_square;  ///< of this matrix
};

namespace rotation_detail {

constexpr float kMu = 0x1.0624dep-11f;  // 0.0005, against matrices whose elements sum to 1..2
constexpr float kLongestStep = 0.75f;   // of omega / 2: 1.3 rad
constexpr int kPolishing = 6;           // iterations after a cold start

/// Gradient and Hessian at one candidate rotation. The minors are those of 2 H: its adjugate and determinant.
struct Estimate {
  Matrix3x4 r;
  Vector3x4 gradient;
  vec_float4 minor_xx, minor_xy, minor_xz, minor_yy, minor_yz, minor_zz, determinant;
  vec_float4 trace;
  vec_float4 residual_square;
  vec_uint4 indefinite;  // top bit set where H is not safely positive
};

__attribute__((always_inline)) inline Estimate estimate(const Matrix3x4& a, const Quaternion4& q) {
  Estimate e;
  e.r = matrix_of(q);
  const Matrix3x4& r = e.r;
  const auto column_product = [](vec_float4 rx, vec_float4 ry, vec_float4 rz, vec_float4 ax, vec_float4 ay,
                                 vec_float4 az) __attribute__((always_inline)) {
    return spu_madd(rx, ax, spu_madd(ry, ay, spu_mul(rz, az)));
  };
  const vec_float4 sxx = column_product(r.x.x, r.y.x, r.z.x, a.x.x, a.y.x, a.z.x);
  const vec_float4 sxy = column_product(r.x.x, r.y.x, r.z.x, a.x.y, a.y.y, a.z.y);
  const vec_float4 sxz = column_product(r.x.x, r.y.x, r.z.x, a.x.z, a.y.z, a.z.z);
  const vec_float4 syx = column_product(r.x.y, r.y.y, r.z.y, a.x.x, a.y.x, a.z.x);
  const vec_float4 syy = column_product(r.x.y, r.y.y, r.z.y, a.x.y, a.y.y, a.z.y);
  const vec_float4 syz = column_product(r.x.y, r.y.y, r.z.y, a.x.z, a.y.z, a.z.z);
  const vec_float4 szx = column_product(r.x.z, r.y.z, r.z.z, a.x.x, a.y.x, a.z.x);
  const vec_float4 szy = column_product(r.x.z, r.y.z, r.z.z, a.x.y, a.y.y, a.z.y);
  const vec_float4 szz = column_product(r.x.z, r.y.z, r.z.z, a.x.z, a.y.z, a.z.z);
  e.gradient = {spu_sub(szy, syz), spu_sub(sxz, szx), spu_sub(syx, sxy)};
  e.residual_square = dot(e.gradient, e.gradient);
  e.trace = spu_add(spu_add(sxx, syy), szz);

  // 2 H, whose solution is omega / 2, so that nothing has to be halved.
  const vec_float4 mu = spu_splats(kMu), two = spu_splats(2.0f), two_mu = spu_splats(2 * kMu);
  const vec_float4 hxx = spu_madd(two, spu_add(syy, szz), two_mu);
  const vec_float4 hyy = spu_madd(two, spu_add(sxx, szz), two_mu);
  const vec_float4 hzz = spu_madd(two, spu_add(sxx, syy), two_mu);
  const vec_float4 minus_hxy = spu_add(sxy, syx);
  const vec_float4 minus_hxz = spu_add(sxz, szx);
  const vec_float4 minus_hyz = spu_add(syz, szy);
  e.minor_xx = spu_msub(hyy, hzz, spu_mul(minus_hyz, minus_hyz));
  e.minor_xy = spu_madd(minus_hxz, minus_hyz, spu_mul(minus_hxy, hzz));
  e.minor_xz = spu_madd(minus_hxy, minus_hyz, spu_mul(minus_hxz, hyy));
  e.minor_yy = spu_msub(hxx, hzz, spu_mul(minus_hxz, minus_hxz));
  e.minor_yz = spu_madd(minus_hxy, minus_hxz, spu_mul(hxx, minus_hyz));
  e.minor_zz = spu_msub(hxx, hyy, spu_mul(minus_hxy, minus_hxy));
  e.determinant = spu_msub(hxx, e.minor_xx, spu_madd(minus_hxy, e.minor_xy, spu_mul(minus_hxz, e.minor_xz)));

  // The pivots h_zz, minor_xx / h_zz and determinant / minor_xx of 2 H are at least 2 mu at the optimum; half of that is safely positive.
  e.indefinite = spu_or(spu_or(less(hzz, mu), less(e.minor_xx, spu_mul(mu, hzz))),
                        less(e.determinant, spu_mul(mu, e.minor_xx)));
  return e;
}

/// omega / 2 by Newton's method. Without meaning in lanes in which H is not positive.
__attribute__((always_inline)) inline Vector3x4 newton_half(const Estimate& e) {
  const Vector3x4& g = e.gradient;
  const Vector3x4 adjugate_g = {
      spu_madd(e.minor_xx, g.x, spu_madd(e.minor_xy, g.y, spu_mul(e.minor_xz, g.z))),
      spu_madd(e.minor_xy, g.x, spu_madd(e.minor_yy, g.y, spu_mul(e.minor_yz, g.z))),
      spu_madd(e.minor_xz, g.x, spu_madd(e.minor_yz, g.y, spu_mul(e.minor_zz, g.z)))};
  return scale(adjugate_g, rough_reciprocal(e.determinant));
}

/// omega / 2 for lanes in which Newton's step is unusable or too long: a step along the gradient where H is not positive, and no step
/// longer than kLongestStep. It computes the estimate again from a and q, which are in memory anyway: an estimate as an argument would be
/// written to memory in each iteration, also in those that do not call this function.
__attribute__((noinline)) inline Vector3x4 safe_half(const Matrix3x4& a, const Quaternion4& q) {
  const Estimate e = estimate(a, q);
  const Vector3x4 newton = newton_half(e);
  const vec_float4 step = reciprocal(spu_madd(spu_splats(2.0f), absolute(e.trace), spu_splats(2.0f)));
  const vec_uint4 indefinite = negative_lanes(e.indefinite);
  const Vector3x4 half = {spu_sel(newton.x, spu_mul(e.gradient.x, step), indefinite),
                          spu_sel(newton.y, spu_mul(e.gradient.y, step), indefinite),
                          spu_sel(newton.z, spu_mul(e.gradient.z, step), indefinite)};
  const vec_float4 square = dot(half, half);
  const vec_uint4 far = negative_lanes(less(spu_splats(kLongestStep * kLongestStep), square));
  const vec_float4 shorter = spu_mul(spu_splats(kLongestStep), reciprocal_sqrt(square));
  return scale(half, spu_sel(spu_splats(1.0f), shorter, far));
}

/// @param e  estimate(a, q)
__attribute__((always_inline)) inline Quaternion4 improve(const Estimate& e, const Matrix3x4& a,
                                                          const Quaternion4& q) {
  Vector3x4 half = newton_half(e);
  const vec_uint4 far = less(spu_splats(kLongestStep * kLongestStep), dot(half, half));
  if (__builtin_expect(any_negative(spu_or(e.indefinite, far)), 0)) half = safe_half(a, q);
  return turn(q, half);
}

/// Top bit set in lanes whose rotation cannot be trusted.
/// @param indefinite  where H is not positive, from this estimate or the one before
inline vec_uint4 lost(const Estimate& e, vec_uint4 indefinite) {
  return spu_or(indefinite, less(spu_splats(kRotationLost * kRotationLost), e.residual_square));
}

inline Quaternion4 select(const Quaternion4& a, const Quaternion4& b, vec_uint4 mask) {
  return {spu_sel(a.x, b.x, mask), spu_sel(a.y, b.y, mask), spu_sel(a.z, b.z, mask), spu_sel(a.w, b.w, mask)};
}

/// A times a power of two that makes its elements' magnitudes sum to 1..2; zero where A is noise.
__attribute__((always_inline)) inline Matrix3x4 normalise(const Matrix3x4& a, const RotationNoise& noise_of) {
  const vec_float4 sum = spu_add(
      spu_add(spu_add(spu_add(absolute(a.x.x), absolute(a.x.y)), spu_add(absolute(a.x.z), absolute(a.y.x))),
              spu_add(spu_add(absolute(a.y.y), absolute(a.y.z)), spu_add(absolute(a.z.x), absolute(a.z.y)))),
      absolute(a.z.z));
  const vec_float4 by = unit_scale(sum, noise_of).by;
  return {scale(a.x, by), scale(a.y, by), scale(a.z, by)};
}

}  // namespace rotation_detail

/// Four matrices, scaled, and another vector of each region. It overwrites the sums from which it is made.
struct __attribute__((may_alias)) RotationProblem {
  Matrix3x4 a;        ///< as normalised() makes it
  Vector3x4 payload;  ///< for the caller; not used here
};

/// Scales `a` for a RotationProblem: multiplies by a power of two, or by zero where it is noise.
/// @param a  matrices of finite numbers, of any rank and with either sign of the determinant. If the magnitudes of a matrix's elements do
///           not sum to 1e-37..1.7e38, it counts as noise.
__attribute__((always_inline)) inline Matrix3x4 normalised(const Matrix3x4& a, const RotationNoise& noise) {
  return rotation_detail::normalise(a, noise);
}

namespace rotation_detail {

/// Makes one iteration for all groups, one or more.
///
/// The iteration of a group is a chain of dependent operations, which takes five times as long as its operations would. Groups do not
/// depend on each other. So each round of the loop estimates one group and finishes the one before it, and the processor overlaps the two.
__attribute__((always_inline)) inline void improve_all(const RotationProblem* problems, Quaternion4* q,
                                                       vec_uint4* indefinite, uint32_t count) {
  Estimate before = estimate(problems[0].a, q[0]);
  indefinite[0] = before.indefinite;
  for (uint32_t g = 1; g < count; ++g) {
    const Estimate e = estimate(problems[g].a, q[g]);
    indefinite[g] = e.indefinite;
    q[g - 1] = improve(before, problems[g - 1].a, q[g - 1]);
    before = e;
  }
  q[count - 1] = improve(before, problems[count - 1].a, q[count - 1]);
}

}  // namespace rotation_detail

/// Turns `count` groups of four quaternions towards the optima, within the limits of `effort`.
/// @param q           in: the last step's quaternions, of length one to within 1e-5; out: to within 5e-6
/// @param count       one or more
/// @param indefinite  out, for each group: top bit set where H was not positive in the last estimate
__attribute__((noinline)) inline void improve_rotations(const RotationProblem* problems, Quaternion4* q,
                                                        vec_uint4* indefinite, uint32_t count,
                                                        RotationEffort effort) {
  using namespace rotation_detail;
  for (uint32_t g = 0; g < count; ++g) indefinite[g] = spu_splats(0u);
  const uint32_t least = effort.least < effort.most ? effort.least : effort.most;
  for (uint32_t pass = 0; pass < least; ++pass) improve_all(problems, q, indefinite, count);

  const vec_float4 good = spu_splats(kRotationResidual * kRotationResidual);
  for (uint32_t pass = least; pass < effort.most; ++pass) {
    bool all_good = true;
    for (uint32_t g = 0; g < count; ++g) {
      const Estimate e = estimate(problems[g].a, q[g]);
      indefinite[g] = e.indefinite;
      // Lanes that are good do not change, so the result of a region does not depend on the other regions of its group.
      const vec_uint4 bad = spu_or(e.indefinite, less(good, e.residual_square));
      if (!any_negative(bad)) continue;
      q[g] = select(q[g], improve(e, problems[g].a, q[g]), negative_lanes(bad));
      all_good = false;
    }
    if (all_good) return;
  }
}

namespace rotation_detail {

/// The same, not inlined, for code that seldom runs.
__attribute__((noinline)) inline Estimate estimate_slowly(const Matrix3x4& a, const Quaternion4& q) {
  return estimate(a, q);
}

/// Finds the rotations of the lanes in `mask` by Davenport's matrix and improves them by Newton's method. Where A does not determine the
/// rotation, the present `q` decides.
__attribute__((noinline)) inline Rotation4 start_again(const RotationProblem& problem, Quaternion4& q,
                                                       vec_uint4 mask) {
  const Quaternion4 found = davenport(problem.a, q);
  Quaternion4 polished = found;
  vec_uint4 indefinite;
  improve_rotations(&problem, &polished, &indefinite, 1, {kPolishing, kPolishing});
  const Estimate last = estimate_slowly(problem.a, polished);
  const vec_uint4 failed = negative_lanes(lost(last, last.indefinite));
  q = select(q, select(polished, found, failed), mask);
  const Estimate e = estimate_slowly(problem.a, q);
  return {e.r, e.residual_square};
}

}  // namespace rotation_detail

/// The matrices of quaternions that improve_rotations() has made. Lanes that have not converged start again without the past; their `q`
/// changes.
///
/// These are lanes with a large residual, and lanes in which H was not positive in the last estimate. H at the present rotation is not
/// tested, because that would be half of the work. From a place where H is positive, Newton's method hardly ever arrives exactly at a
/// saddle; if it does, the first estimate of the next step finds that.
__attribute__((always_inline)) inline Rotation4 rotation_of(const RotationProblem& problem, Quaternion4& q,
                                                            vec_uint4 indefinite) {
  using namespace rotation_detail;
  const Estimate e = estimate(problem.a, q);
  const vec_uint4 restart = lost(e, indefinite);
  if (__builtin_expect(any_negative(restart), 0)) return start_again(problem, q, negative_lanes(restart));
  return {e.r, e.residual_square};
}

/// Finds the optimum without the past: `q` decides only what the problem does not determine. Several times as slow.
inline Rotation4 find_rotation(const RotationProblem& problem, Quaternion4& q) {
  return rotation_detail::start_again(problem, q, spu_splats(0xFFFFFFFFu));
}

}  // namespace softcell::spu
