#pragma once
// The arithmetic of shape matching between the sums: the payload of a particle, the best rigid motion of a region, and the goals.  [LSM07]
//
//   up      row k of a slot:   m~ x_k (x0, y0, z0, 1)
//   region  c = P / M,  A = sum m~ x x0^T - P c0^T,  R = rotation of A,  t = c - R c0
//   down    row k of a slot:   (R_k0, R_k1, R_k2, t_k)
//   goal    g_k = 1 / m_i  (sum of row k) . m~ (x0, y0, z0, 1)

#include <spu_intrinsics.h>

#include "common/sums.h"
#include "common/transpose.h"
#include "match/local_store.h"
#include "rotation.h"

namespace softcell::spu {

/// Computes the payload of four particles.
inline void match_moments(const RestMoments& rest_moment, const Vector3x4& x, Slot* out) {
  const auto particle = [&](int lane) __attribute__((always_inline)) {
    const vec_float4 moment = rest_moment[lane];
    out[lane].row[0] = spu_mul(spu_splats(spu_extract(x.x, lane)), moment);
    out[lane].row[1] = spu_mul(spu_splats(spu_extract(x.y, lane)), moment);
    out[lane].row[2] = spu_mul(spu_splats(spu_extract(x.z, lane)), moment);
  };
  particle(0);
  particle(1);
  particle(2);
  particle(3);
}

/// Row `k` of four slots, transposed: one component of all four slots in each register.
inline Rows4 load_row(const Slot* slots, int k) {
  return transpose({slots[0].row[k], slots[1].row[k], slots[2].row[k], slots[3].row[k]});
}

template <typename AnySlot>
inline void store_row(AnySlot* slots, int k, const Rows4& components) {
  const Rows4 t = transpose(components);
  slots[0].row[k] = t.a;
  slots[1].row[k] = t.b;
  slots[2].row[k] = t.c;
  slots[3].row[k] = t.d;
}

/// The rotation problem of four regions in the place of four slots: A, and as payload P = sum m~ x.
inline RotationProblem* problem_at(Slot* slots) { return reinterpret_cast<RotationProblem*>(slots); }
static_assert(sizeof(RotationProblem) == 4 * sizeof(Slot), "one takes the other's place");

/// Computes A and P of four regions from their sums, in the place of four slots: the sums' own, or others.
__attribute__((always_inline)) inline void make_problem(const RegionConstants& r, const Slot* sums,
                                                        Slot* slots, vec_float4 noise_floor) {
  const Rows4 x = load_row(sums, 0), y = load_row(sums, 1), z = load_row(sums, 2);
  const auto row_of_a = [&](const Rows4& sum) __attribute__((always_inline)) {
    return Vector3x4{spu_nmsub(sum.d, r.centre.x, sum.a), spu_nmsub(sum.d, r.centre.y, sum.b),
                     spu_nmsub(sum.d, r.centre.z, sum.c)};
  };
  *problem_at(slots) = {normalised({row_of_a(x), row_of_a(y), row_of_a(z)}, {r.inverse_mass, noise_floor}),
                        {x.d, y.d, z.d}};
}

/// Computes the motions (R | t) of four regions from R and P, in the place of their rotation problem.
__attribute__((always_inline)) inline void store_motions(const RegionConstants& r, const Matrix3x4& rotation,
                                                         const Vector3x4& momentum, Slot* slots) {
  const auto store = [&](int k, const Vector3x4& row, vec_float4 moment) __attribute__((always_inline)) {
    const vec_float4 turned = dot(row, r.centre);
    store_row(slots, k, {row.x, row.y, row.z, spu_msub(moment, r.inverse_mass, turned)});
  };
  store(0, rotation.x, momentum.x);
  store(1, rotation.y, momentum.y);
  store(2, rotation.z, momentum.z);
}

/// The goals of four particles.
/// @param region  offsets of the totals of their regions
inline Vector3x4 goals(const RestMoments& rest_moment, vec_float4 inverse_mass, const uint32_t (&region)[4],
                       const Slot* totals) {
  const Slot &a = slot_at(totals, region[0]), &b = slot_at(totals, region[1]);
  const Slot &c = slot_at(totals, region[2]), &d = slot_at(totals, region[3]);
  const auto component = [&](int k) __attribute__((always_inline)) {
    const vec_float4 sum =
        sums_of_rows({spu_mul(a.row[k], rest_moment[0]), spu_mul(b.row[k], rest_moment[1]),
                      spu_mul(c.row[k], rest_moment[2]), spu_mul(d.row[k], rest_moment[3])});
    return spu_mul(sum, inverse_mass);
  };
  return {component(0), component(1), component(2)};
}

}  // namespace softcell::spu
