#pragma once
// A lattice cell's trilinear map, for four vertices at a time.  [LSM07, embedding]
//
//   x(xi, eta, zeta) = sum_k N_k x_k over the cell's eight corners, as a polynomial:
//   c + cx xi + cy eta + cz zeta + cxy xi eta + cyz eta zeta + czx zeta xi + cxyz xi eta zeta

#include <spu_intrinsics.h>

#include "common/vector3.h"

namespace softcell::spu {

/// One component of the map, each coefficient in all lanes.
struct Polynomial {
  vec_float4 c, cx, cy, cz, cxy, cyz, czx, cxyz;
};

struct CellPolynomial {
  Polynomial x, y, z;
};

/// @param corners  x y z and anything
/// @param index    of the cell's eight corners; corner k = bx + 2 by + 4 bz
__attribute__((always_inline)) inline CellPolynomial polynomial_of(const vec_float4* corners,
                                                                   vec_ushort8 index) {
  const vec_float4 x0 = corners[spu_extract(index, 0)], x1 = corners[spu_extract(index, 1)];
  const vec_float4 x2 = corners[spu_extract(index, 2)], x3 = corners[spu_extract(index, 3)];
  const vec_float4 x4 = corners[spu_extract(index, 4)], x5 = corners[spu_extract(index, 5)];
  const vec_float4 x6 = corners[spu_extract(index, 6)], x7 = corners[spu_extract(index, 7)];
  const vec_float4 cx = spu_sub(x1, x0), cy = spu_sub(x2, x0), cz = spu_sub(x4, x0);
  const vec_float4 upper = spu_sub(x5, x4);
  const vec_float4 cxy = spu_sub(spu_sub(x3, x2), cx);
  const vec_float4 cyz = spu_sub(spu_sub(x6, x4), cy);
  const vec_float4 czx = spu_sub(upper, cx);
  const vec_float4 cxyz = spu_sub(spu_sub(spu_sub(x7, x6), upper), cxy);
  const auto component = [&](vec_uchar16 splat) __attribute__((always_inline)) {
    const auto all = [splat](vec_float4 v) { return spu_shuffle(v, v, splat); };
    return Polynomial{all(x0), all(cx), all(cy), all(cz), all(cxy), all(cyz), all(czx), all(cxyz)};
  };
  const vec_uchar16 first = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
  const vec_uchar16 second = {4, 5, 6, 7, 4, 5, 6, 7, 4, 5, 6, 7, 4, 5, 6, 7};
  const vec_uchar16 third = {8, 9, 10, 11, 8, 9, 10, 11, 8, 9, 10, 11, 8, 9, 10, 11};
  return {component(first), component(second), component(third)};
}

/// One component of a position, and of the three columns of the deformation gradient: its derivatives by xi,
/// eta, zeta.
struct Component {
  vec_float4 position, f1, f2, f3;
};

inline Component evaluate(const Polynomial& p, vec_float4 xi, vec_float4 eta, vec_float4 zeta) {
  const vec_float4 along_xy = spu_madd(p.cxyz, zeta, p.cxy);
  const vec_float4 along_y = spu_madd(p.cyz, zeta, p.cy);
  const vec_float4 f1 = spu_madd(along_xy, eta, spu_madd(p.czx, zeta, p.cx));
  const vec_float4 f2 = spu_madd(along_xy, xi, along_y);
  const vec_float4 f3 = spu_madd(spu_madd(p.cxyz, xi, p.cyz), eta, spu_madd(p.czx, xi, p.cz));
  const vec_float4 position = spu_madd(f1, xi, spu_madd(along_y, eta, spu_madd(p.cz, zeta, p.c)));
  return {position, f1, f2, f3};
}

/// m^2: negligible against the squared size of a cell.
constexpr float kFlat = 1e-12f;

/// cof(F) N + kFlat N, not of unit length. In a flat cell, where cof(F) is zero, N remains, without a branch.
/// With the columns f1 f2 f3 of F:
///
///   cof(F) N = Nx f2 x f3 + Ny f3 x f1 + Nz f1 x f2 = f2 x (Nx f3 - Nz f1) + Ny f3 x f1
///
/// @param rest  N, the rest normal
inline Vector3x4 deformed_normal(const Vector3x4& f1, const Vector3x4& f2, const Vector3x4& f3,
                                 const Vector3x4& rest) {
  const Vector3x4 across = {spu_msub(f3.x, rest.x, spu_mul(f1.x, rest.z)),
                            spu_msub(f3.y, rest.x, spu_mul(f1.y, rest.z)),
                            spu_msub(f3.z, rest.x, spu_mul(f1.z, rest.z))};
  return scale_add(rest, spu_splats(kFlat), scale_add(cross(f3, f1), rest.y, cross(f2, across)));
}

}  // namespace softcell::spu
