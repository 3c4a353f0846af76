#pragma once
// Removes a share of the relative motion of a cell's corners, and keeps linear and angular momentum. So the cell as a whole
// at once feels what a contact does to one corner.

#include <spu_intrinsics.h>
#include <stdint.h>

#include "common/reciprocal.h"
#include "contact_solve_job.h"
#include "contacts/quad_vector.h"

namespace softcell::spu {

/// Stiffens one cell. V + omega x r, with r in cells from the centre of mass, is the rigid motion with the momentum and the angular
/// momentum of the corners. The differences from it shrink. Velocities are relative to the first corner.
/// @param changes    changes of velocities times the root of the mass, and 0
/// @param start      the velocities before these changes times the root of the mass, and that root
/// @param positions  x y z and anything, metres
inline void stiffen(vec_ushort8 corner, vec_float4* changes, const vec_float4* start,
                    const vec_float4* positions, float share, float inverse_spacing) {
  const vec_float4 zero = spu_splats(0.0f);
  // Relative to the first corner: far from the origin, or at high speed, sums would lose digits, and SPUs truncate all of them the same
  // way.
  const uint32_t first_corner = spu_extract(corner, 0);
  const vec_float4 first = positions[first_corner];
  const vec_float4 carried = spu_mul(only_xyz(spu_add(start[first_corner], changes[first_corner])),
                                     reciprocal(splat_lane<3>(start[first_corner])));
  vec_float4 arm[8], root[8], now[8];
  vec_float4 mass = zero, moment = zero, momentum = zero;
  for (int k = 0; k < 8; ++k) {
    const uint32_t particle = spu_extract(corner, k);
    root[k] = splat_lane<3>(start[particle]);
    now[k] = only_xyz(spu_nmsub(root[k], carried, spu_add(start[particle], changes[particle])));
    const vec_float4 m = spu_mul(root[k], root[k]);
    arm[k] = spu_mul(spu_sub(positions[particle], first), spu_splats(inverse_spacing));
    mass = spu_add(mass, m);
    moment = spu_madd(m, arm[k], moment);
    momentum = spu_madd(root[k], now[k], momentum);
  }
  const vec_float4 by_mass = reciprocal(mass);
  const vec_float4 centre = spu_mul(moment, by_mass);
  const vec_float4 velocity = spu_mul(momentum, by_mass);

  // Inertia by rows, and angular momentum, both divided by the mass.
  vec_float4 squares = zero, spin = zero;  // x x, y y, z z
  vec_float4 mixed = zero;                 // x y, y z, z x
  for (int k = 0; k < 8; ++k) {
    const vec_float4 r = only_xyz(spu_sub(arm[k], centre));
    arm[k] = r;
    const vec_float4 m = spu_mul(spu_mul(root[k], root[k]), by_mass);
    const vec_float4 weighted = spu_mul(m, r);
    squares = spu_madd(weighted, r, squares);
    mixed = spu_madd(weighted, turned_left(r), mixed);
    spin = spu_madd(spu_mul(root[k], by_mass), cross_of(r, now[k]), spin);
  }
  // A cell that is pressed to a line has no inertia about it, so a little is added.
  const vec_float4 little = spu_splats(0x1.0p-13f);
  const vec_float4 diagonal = spu_add(spu_sub(sum_of_lanes(squares), squares), little);
  const vec_float4 off = spu_sub(zero, mixed);  // of rows and columns x y, y z, z x
  // off: xy yz zx.
  const vec_uchar16 first_row = {0, 1, 2, 3, 16, 17, 18, 19, 24, 25, 26, 27, 28, 29, 30, 31};
  const vec_uchar16 second_row = {16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23, 28, 29, 30, 31};
  const vec_uchar16 third_row = {24, 25, 26, 27, 20, 21, 22, 23, 8, 9, 10, 11, 28, 29, 30, 31};
  const vec_float4 row_x = spu_shuffle(diagonal, off, first_row);
  const vec_float4 row_y = spu_shuffle(diagonal, off, second_row);
  const vec_float4 row_z = spu_shuffle(diagonal, off, third_row);
  const vec_float4 c1 = cross_of(row_y, row_z), c2 = cross_of(row_z, row_x), c3 = cross_of(row_x, row_y);
  const vec_float4 by_determinant = reciprocal(dot_in_all_lanes(row_x, c1));
  const auto turn_of = [&](vec_float4 s) __attribute__((always_inline)) {
    return spu_mul(
        spu_madd(splat_lane<0>(s), c1, spu_madd(splat_lane<1>(s), c2, spu_mul(splat_lane<2>(s), c3))),
        by_determinant);
  };
  // Restores the part of the rotation that the addition has removed; the remaining error is of second order.
  const vec_float4 omega = turn_of(spu_madd(little, turn_of(spin), spin));

  const vec_float4 part = spu_splats(share);
  for (int k = 0; k < 8; ++k) {
    vec_float4& change = changes[spu_extract(corner, k)];
    const vec_float4 rigid = spu_mul(root[k], spu_add(velocity, cross_of(omega, arm[k])));
    change = spu_madd(part, only_xyz(spu_sub(rigid, now[k])), change);
  }
}

}  // namespace softcell::spu
