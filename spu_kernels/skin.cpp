// skin: mesh vertices from the particles of their lattice cells.  [LSM07, embedding]
//
//   x = sum_k N_k(xi, eta, zeta) x_k        trilinear, over the cell's eight corners
//   F = (dx/dxi, dx/deta, dx/dzeta)         deformation gradient, times the spacing (which the normalisation removes)
//   n = normalize(cof(F) N)                 cof(F) = [f2 x f3, f3 x f1, f1 x f2], N the rest normal
//
//   array     direction  element                count         alignment
//   job       in         SkinJob, 128 bytes     1             128
//   corners   in         SkinCorner, 16 bytes   <= 2048       16
//   groups    in         SkinGroup, 128 bytes   any           128
//   vertices  out        SkinnedVertex, 16 bytes  4 per group   128
//
// Budget: 96 KB. Corners 32 KB, two buffers of 8 KB in and 4 KB out, about 6 KB of code and tables, 4 KB of stack.
// DMA: 128 bytes in and 64 bytes out for four vertices, and 16 bytes for a corner once a job.
//
// Compiles unchanged with a real SPU g++ (7 to 9, -std=c++17).

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "common/dma.h"
#include "common/half.h"
#include "common/vector3.h"
#include "skin_job.h"

namespace softcell::spu {
namespace {

constexpr uint32_t kChunkGroups = 64;         // 8 KB in, 4 KB out: long enough to hide a transfer's latency
constexpr float kSmallestNormalSquared = 1e-20f;  // of |cof(F) N|, in m^4: below it the cell is flat and has no normal

enum Tag : uint32_t {
  kTagCorners = 0,  // the descriptor, then the corners
  kTagGroups = 1,   // 1 and 2: the two input buffers
  kTagVertices = 3  // 3 and 4: the two output buffers
};

/// A SkinGroup as registers.
struct Group {
  vec_float4 xi, eta, zeta;
  Vector3x4 normal;
  vec_ushort8 corner;
  vec_ushort8 continues;
};
static_assert(sizeof(Group) == sizeof(SkinGroup), "the same bytes");

/// Everything this kernel keeps in local store beside its code and stack.
struct alignas(128) LocalStoreMap {
  SkinJob job;
  vec_float4 corner[kSkinMaxCorners];  // x y z 0, relative to the origin once they have arrived
  alignas(128) Group groups[2][kChunkGroups];
  alignas(128) vec_ushort8 vertices[2][kChunkGroups * 4];
};
static_assert(sizeof(LocalStoreMap) <= 64 * 1024, "leaves a third of the budget for code and stack");
LocalStoreMap ls;

/// The trilinear map of one cell as a polynomial: c + cx xi + cy eta + cz zeta + cxy xi eta + ... + cxyz xi eta zeta.
struct CellPolynomial {
  Vector3x4 c, cx, cy, cz, cxy, cyz, czx, cxyz;
};

inline Vector3x4 splat_xyz(vec_float4 v) {
  const vec_uchar16 x = {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3};
  const vec_uchar16 y = {4, 5, 6, 7, 4, 5, 6, 7, 4, 5, 6, 7, 4, 5, 6, 7};
  const vec_uchar16 z = {8, 9, 10, 11, 8, 9, 10, 11, 8, 9, 10, 11, 8, 9, 10, 11};
  return {spu_shuffle(v, v, x), spu_shuffle(v, v, y), spu_shuffle(v, v, z)};
}

inline CellPolynomial polynomial_of(vec_ushort8 corner) {
  const vec_float4 x0 = ls.corner[spu_extract(corner, 0)];
  const vec_float4 x1 = ls.corner[spu_extract(corner, 1)];
  const vec_float4 x2 = ls.corner[spu_extract(corner, 2)];
  const vec_float4 x3 = ls.corner[spu_extract(corner, 3)];
  const vec_float4 x4 = ls.corner[spu_extract(corner, 4)];
  const vec_float4 x5 = ls.corner[spu_extract(corner, 5)];
  const vec_float4 x6 = ls.corner[spu_extract(corner, 6)];
  const vec_float4 x7 = ls.corner[spu_extract(corner, 7)];
  const vec_float4 cx = spu_sub(x1, x0), cy = spu_sub(x2, x0), cz = spu_sub(x4, x0);
  const vec_float4 upper = spu_sub(x5, x4);
  const vec_float4 cxy = spu_sub(spu_sub(x3, x2), cx);
  const vec_float4 cyz = spu_sub(spu_sub(x6, x4), cy);
  const vec_float4 czx = spu_sub(upper, cx);
  const vec_float4 cxyz = spu_sub(spu_sub(spu_sub(x7, x6), upper), cxy);
  return {splat_xyz(x0),  splat_xyz(cx),  splat_xyz(cy),  splat_xyz(cz),
          splat_xyz(cxy), splat_xyz(cyz), splat_xyz(czx), splat_xyz(cxyz)};
}

struct Surface {
  Vector3x4 position, normal;
};

inline Surface evaluate(const CellPolynomial& p, const Group& g) {
  const Vector3x4 along_xy = scale_add(p.cxyz, g.zeta, p.cxy);
  const Vector3x4 along_yz = scale_add(p.cxyz, g.xi, p.cyz);
  const Vector3x4 along_y = scale_add(p.cyz, g.zeta, p.cy);
  const Vector3x4 f1 = scale_add(along_xy, g.eta, scale_add(p.czx, g.zeta, p.cx));
  const Vector3x4 f2 = scale_add(along_xy, g.xi, along_y);
  const Vector3x4 f3 = scale_add(along_yz, g.eta, scale_add(p.czx, g.xi, p.cz));
  const Vector3x4 position = scale_add(f1, g.xi, scale_add(along_y, g.eta, scale_add(p.cz, g.zeta, p.c)));

  const Vector3x4 n = scale_add(cross(f1, f2), g.normal.z,
                                scale_add(cross(f3, f1), g.normal.y, scale(cross(f2, f3), g.normal.x)));
  const vec_float4 squared = dot(n, n);
  const vec_uint4 flat = spu_cmpgt(spu_splats(kSmallestNormalSquared), squared);
  return {position, select(scale(n, reciprocal_sqrt(squared)), g.normal, flat)};
}

/// Rounds to halves and stores four vertices of 16 bytes.
inline void store(const Surface& s, vec_ushort8* out) {
  const vec_uint4 rare = spu_or(
      spu_or(spu_or(outside_half_normal(s.position.x), outside_half_normal(s.position.y)),
             spu_or(outside_half_normal(s.position.z), outside_half_normal(s.normal.x))),
      spu_or(outside_half_normal(s.normal.y), outside_half_normal(s.normal.z)));
  vec_uint4 x, y, z, nx, ny, nz;
  if (__builtin_expect(spu_extract(spu_gather(rare), 0) == 0, 1)) {
    x = half_of_normal(s.position.x), y = half_of_normal(s.position.y), z = half_of_normal(s.position.z);
    nx = half_of_normal(s.normal.x), ny = half_of_normal(s.normal.y), nz = half_of_normal(s.normal.z);
  } else {
    x = half_of_any(s.position.x), y = half_of_any(s.position.y), z = half_of_any(s.position.z);
    nx = half_of_any(s.normal.x), ny = half_of_any(s.normal.y), nz = half_of_any(s.normal.z);
  }
  // Two halves to a word, the first in the high half, which is the first in memory.
  const vec_uint4 xy = spu_or(spu_sl(x, 16), y);
  const vec_uint4 z1 = spu_or(spu_sl(z, 16), spu_splats(0x3C00u));
  const vec_uint4 nxy = spu_or(spu_sl(nx, 16), ny);
  const vec_uint4 nz0 = spu_sl(nz, 16);
  // Transpose the 4 x 4 words: one vertex to a quadword.
  const vec_uchar16 low = {0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23};
  const vec_uchar16 high = {8, 9, 10, 11, 24, 25, 26, 27, 12, 13, 14, 15, 28, 29, 30, 31};
  const vec_uint4 a = spu_shuffle(xy, nxy, low), b = spu_shuffle(xy, nxy, high);
  const vec_uint4 c = spu_shuffle(z1, nz0, low), d = spu_shuffle(z1, nz0, high);
  out[0] = (vec_ushort8)spu_shuffle(a, c, low);
  out[1] = (vec_ushort8)spu_shuffle(a, c, high);
  out[2] = (vec_ushort8)spu_shuffle(b, d, low);
  out[3] = (vec_ushort8)spu_shuffle(b, d, high);
}

/// One buffer of groups to one buffer of vertices.
void skin_chunk(const Group* groups, uint32_t count, vec_ushort8* vertices) {
  CellPolynomial p = polynomial_of(groups[0].corner);
  for (uint32_t i = 0; i < count; ++i) {
    // A chunk may begin in the middle of a cell; the first group's polynomial is always made.
    if (i != 0 && spu_extract(groups[i].continues, 0) == 0) p = polynomial_of(groups[i].corner);
    store(evaluate(p, groups[i]), vertices + 4 * i);
  }
}

inline uint32_t groups_in_chunk(uint32_t chunk) {
  const uint32_t left = ls.job.group_count - chunk * kChunkGroups;
  return left < kChunkGroups ? left : kChunkGroups;
}

inline void fetch_chunk(uint32_t chunk) {
  const uint32_t buffer = chunk & 1u;
  mfc_get(ls.groups[buffer], ls.job.groups_ea + static_cast<uint64_t>(chunk) * kChunkGroups * sizeof(Group),
          groups_in_chunk(chunk) * static_cast<uint32_t>(sizeof(Group)), kTagGroups + buffer, 0, 0);
}

inline void put_chunk(uint32_t chunk) {
  const uint32_t buffer = chunk & 1u;
  mfc_put(ls.vertices[buffer],
          ls.job.vertices_ea + static_cast<uint64_t>(chunk) * kChunkGroups * 4 * sizeof(SkinnedVertex),
          groups_in_chunk(chunk) * 4 * static_cast<uint32_t>(sizeof(SkinnedVertex)), kTagVertices + buffer, 0, 0);
}

/// Fetches both windows of corners, one behind the other, and takes the origin off them.
void load_corners() {
  const SkinWindow& first = ls.job.window[0];
  const SkinWindow& second = ls.job.window[1];
  get_large(ls.corner, first.ea, first.count * 16u, kTagCorners);
  get_large(ls.corner + first.count, second.ea, second.count * 16u, kTagCorners);
  wait_for_tag(kTagCorners);
  const vec_float4 origin = {ls.job.origin[0], ls.job.origin[1], ls.job.origin[2], 0.0f};
  for (uint32_t i = 0; i < first.count + second.count; ++i) ls.corner[i] = spu_sub(ls.corner[i], origin);
}

}  // namespace
}  // namespace softcell::spu

/// argp: effective address of a SkinJob. Returns a SkinStatus.
int main(uint64_t, uint64_t argp, uint64_t) {
  using namespace softcell::spu;
  mfc_get(&ls.job, argp, sizeof(SkinJob), kTagCorners, 0, 0);
  wait_for_tag(kTagCorners);
  if (ls.job.window[0].count > kSkinMaxCorners || ls.job.window[1].count > kSkinMaxCorners - ls.job.window[0].count) {
    return kSkinTooManyCorners;
  }

  //   get   [0 A][1 B]     [2 A]     [3 B]          A, B: the two buffers in each direction, each with its own tag group
  //   work       [0 A]     [1 B]     [2 A]          an input buffer is free again when its work is done,
  //   put             [0 A]     [1 B]     [2 A]     an output buffer when its put of two chunks ago is
  const uint32_t chunks = (ls.job.group_count + kChunkGroups - 1) / kChunkGroups;
  if (chunks != 0) fetch_chunk(0);
  load_corners();
  for (uint32_t chunk = 0; chunk < chunks; ++chunk) {
    const uint32_t buffer = chunk & 1u;
    if (chunk + 1 < chunks) fetch_chunk(chunk + 1);
    wait_for_tag(kTagVertices + buffer);
    wait_for_tag(kTagGroups + buffer);
    skin_chunk(ls.groups[buffer], groups_in_chunk(chunk), ls.vertices[buffer]);
    put_chunk(chunk);
  }
  wait_for_tag(kTagVertices);
  wait_for_tag(kTagVertices + 1);
  return kSkinDone;
}
