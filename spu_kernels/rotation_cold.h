#pragma once
// The rotation nearest to a matrix, without an estimate to begin with, for four regions at a time: the eigenvector of Davenport's 4x4
// matrix with the largest eigenvalue, by Jacobi rotations.  [HORN87]
//
//   K = [ A + A^T - tr(A) 1   z     ]      z = axial(A);  q^T K q = <R(q), A> for unit q = (x, y, z, w)
//       [ z^T                 tr(A) ]
//
// It is slow and seldom runs, so it is written with loops. Its result is right to about 1e-3 rad, from where Newton's method continues. The
// rotation before has a weight of 1e-4, so that it decides what A does not determine.

#include <spu_intrinsics.h>

#include "common/lane_mask.h"
#include "common/matrix3.h"
#include "common/reciprocal.h"

namespace softcell::spu {

namespace rotation_detail {

constexpr float kPastWeight = 1e-4f;      // of the rotation before, in a matrix whose elements sum to 1..2
constexpr int kJacobiSweeps = 6;          // four or five do
constexpr float kTiny = 0x1.4484cp-100f;  // 1e-30: keeps 0 / 0 away

struct Symmetric4 {
  vec_float4 m[4][4];
};

inline Symmetric4 davenport_matrix(const Matrix3x4& a, const Quaternion4& before) {
  const Matrix3x4 past = matrix_of(before);
  const vec_float4 weight = spu_splats(kPastWeight);
  const Vector3x4 x = scale_add(past.x, weight, a.x);
  const Vector3x4 y = scale_add(past.y, weight, a.y);
  const Vector3x4 z = scale_add(past.z, weight, a.z);
  const auto twice_minus = [](vec_float4 diagonal, vec_float4 trace) {
    return spu_msub(diagonal, spu_splats(2.0f), trace);
  };
  const vec_float4 trace = spu_add(spu_add(x.x, y.y), z.z);
  Symmetric4 k;
  k.m[0][0] = twice_minus(x.x, trace);
  k.m[1][1] = twice_minus(y.y, trace);
  k.m[2][2] = twice_minus(z.z, trace);
  k.m[3][3] = trace;
  k.m[0][1] = k.m[1][0] = spu_add(x.y, y.x);
  k.m[0][2] = k.m[2][0] = spu_add(x.z, z.x);
  k.m[1][2] = k.m[2][1] = spu_add(y.z, z.y);
  k.m[0][3] = k.m[3][0] = spu_sub(z.y, y.z);
  k.m[1][3] = k.m[3][1] = spu_sub(x.z, z.x);
  k.m[2][3] = k.m[3][2] = spu_sub(y.x, x.y);
  return k;
}

/// Cosine and sine of the rotation that makes k[p][q] zero; of two such angles, the smaller one.
struct Plane {
  vec_float4 cosine, sine;
};

inline Plane annihilate(vec_float4 pp, vec_float4 qq, vec_float4 pq) {
  const vec_float4 one = spu_splats(1.0f), tiny = spu_splats(kTiny);
  const vec_float4 d = spu_sub(qq, pp), b = spu_add(pq, pq);
  const vec_float4 square = spu_madd(d, d, spu_madd(b, b, tiny));
  const vec_float4 length = spu_mul(square, reciprocal_sqrt(square));
  const vec_uint4 sign = spu_and((vec_uint4)d, spu_splats(0x80000000u));
  const vec_float4 t_magnitude = spu_mul(b, reciprocal(spu_add(spu_add(absolute(d), length), tiny)));
  const vec_float4 t = (vec_float4)spu_xor((vec_uint4)t_magnitude, sign);
  const vec_float4 cosine = reciprocal_sqrt(spu_madd(t, t, one));
  return {cosine, spu_mul(t, cosine)};
}

/// (a, b) := (c a - s b, s a + c b).
inline void turn_pair(vec_float4& a, vec_float4& b, const Plane& plane) {
  const vec_float4 turned = spu_msub(plane.cosine, a, spu_mul(plane.sine, b));
  b = spu_madd(plane.sine, a, spu_mul(plane.cosine, b));
  a = turned;
}

/// Diagonalises k: its diagonal becomes the eigenvalues, and v's columns the eigenvectors.
inline void diagonalise(Symmetric4& k, Symmetric4& v) {
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) v.m[i][j] = spu_splats(i == j ? 1.0f : 0.0f);
  for (int sweep = 0; sweep < kJacobiSweeps; ++sweep) {
    for (int p = 0; p < 3; ++p) {
      for (int q = p + 1; q < 4; ++q) {
        const Plane plane = annihilate(k.m[p][p], k.m[q][q], k.m[p][q]);
        for (int i = 0; i < 4; ++i) turn_pair(k.m[i][p], k.m[i][q], plane);
        for (int i = 0; i < 4; ++i) turn_pair(k.m[p][i], k.m[q][i], plane);
        for (int i = 0; i < 4; ++i) turn_pair(v.m[i][p], v.m[i][q], plane);
      }
    }
  }
}

/// @param a       matrices whose elements' magnitudes sum to 1..2, or 0
/// @param before  quaternions of length one to within 1e-5
/// @return        quaternions of length one to within 5e-6, so a proper rotation for every a
inline Quaternion4 davenport(const Matrix3x4& a, const Quaternion4& before) {
  Symmetric4 k = davenport_matrix(a, before), v;
  diagonalise(k, v);
  vec_float4 best = k.m[0][0];
  Quaternion4 q = {v.m[0][0], v.m[1][0], v.m[2][0], v.m[3][0]};
  for (int column = 1; column < 4; ++column) {
    const vec_uint4 better = spu_cmpgt(k.m[column][column], best);
    best = spu_sel(best, k.m[column][column], better);
    q = {spu_sel(q.x, v.m[0][column], better), spu_sel(q.y, v.m[1][column], better),
         spu_sel(q.z, v.m[2][column], better), spu_sel(q.w, v.m[3][column], better)};
  }
  const vec_float4 scale = reciprocal_sqrt(dot(q, q));
  return {spu_mul(q.x, scale), spu_mul(q.y, scale), spu_mul(q.z, scale), spu_mul(q.w, scale)};
}

}  // namespace rotation_detail

}  // namespace softcell::spu
