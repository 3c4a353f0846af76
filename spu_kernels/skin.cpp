// skin: mesh vertices from the particles of their lattice cells.  [LSM07, embedding]
//
//   x = sum_k N_k(xi, eta, zeta) x_k        trilinear, over the cell's eight corners
//   F = (dx/dxi, dx/deta, dx/dzeta)         deformation gradient, times the spacing (which the normalisation
//   removes) n = normalize(cof(F) N)                 cof(F) = [f2 x f3, f3 x f1, f1 x f2], N the rest normal
//
//   array     direction  element                count         alignment
//   job       in         SkinJob, 128 bytes     1             128
//   corners   in         SkinCorner, 16 bytes   <= 2048       16
//   groups    in         SkinGroup, 128 bytes   any           128
//   vertices  out        SkinnedVertex, 16 bytes  4 per group   128
//
// Budget: 96 KB. Corners 32 KB, two buffers of 16 KB in and 8 KB out, about 6 KB of code and tables, 4 KB of
// stack. DMA: 128 bytes in and 64 bytes out for four vertices, and 16 bytes for a corner once a job.
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

constexpr uint32_t kChunkGroups = 128;  // 16 KB in, the most one command moves, and 8 KB out
constexpr float kFlat =
    1e-12f;  // epsilon of the normals, in m^2: against the squared size of a cell, nothing

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
static_assert(sizeof(LocalStoreMap) <= 84 * 1024, "leaves 12 KB of the budget for code and stack");
LocalStoreMap ls;

/// One component of a cell's trilinear map as a polynomial, each coefficient in all lanes:
/// c + cx xi + cy eta + cz zeta + cxy xi eta + cyz eta zeta + czx zeta xi + cxyz xi eta zeta.
struct Polynomial {
  vec_float4 c, cx, cy, cz, cxy, cyz, czx, cxyz;
};

struct CellPolynomial {
  Polynomial x, y, z;
};

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
  const auto component = [&](vec_uchar16 splat) __attribute__((always_inline))->Polynomial {
    const auto all = [splat](vec_float4 v) { return spu_shuffle(v, v, splat); };
    return {all(x0), all(cx), all(cy), all(cz), all(cxy), all(cyz), all(czx), all(cxyz)};
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

struct Surface {
  Vector3x4 position, normal;
};

/// normalize(cof(F) N + epsilon N): where the cell is flat and cof(F) vanishes, N is left, without a choice
/// to be made. With F's columns f1 f2 f3, cof(F) N = Nx f2 x f3 + Ny f3 x f1 + Nz f1 x f2 = f2 x (Nx f3 - Nz
/// f1) + Ny f3 x f1.
inline Vector3x4 deformed_normal(const Vector3x4& f1, const Vector3x4& f2, const Vector3x4& f3,
                                 const Vector3x4& rest) {
  const Vector3x4 across = {spu_msub(f3.x, rest.x, spu_mul(f1.x, rest.z)),
                            spu_msub(f3.y, rest.x, spu_mul(f1.y, rest.z)),
                            spu_msub(f3.z, rest.x, spu_mul(f1.z, rest.z))};
  const Vector3x4 n = scale_add(rest, spu_splats(kFlat), scale_add(cross(f3, f1), rest.y, cross(f2, across)));
  return scale(n, reciprocal_sqrt(dot(n, n)));
}

/// Two halves to a word: what is drawn of one vector. The first in memory is in the high half.
struct HalfVector {
  vec_uint4 xy, zw;
};

/// `fourth` follows x y z, as a half in the high half of its word.
inline HalfVector pack(vec_uint4 x, vec_uint4 y, vec_uint4 z, vec_uint4 fourth) {
  const vec_uchar16 high_halves = {0, 1, 16, 17, 4, 5, 20, 21, 8, 9, 24, 25, 12, 13, 28, 29};
  return {spu_shuffle(x, y, high_halves), spu_shuffle(z, fourth, high_halves)};
}

constexpr uint32_t kHalfOneInHigh = 0x3C000000u;

inline bool any_sign(vec_uint4 words) { return spu_extract(spu_orx(words), 0) >= 0x80000000u; }

inline HalfVector to_half_any(const Vector3x4& v, vec_uint4 fourth) {
  return pack(high_half_of_any(v.x), high_half_of_any(v.y), high_half_of_any(v.z), fourth);
}

/// The fast ways are for positive positions (the PPU side puts the origin below the body) and for normals
/// without tiny components, which a flat side along an axis has.
inline void to_half(const Surface& s, HalfVector& position, HalfVector& normal) {
  const vec_uint4 one = spu_splats(kHalfOneInHigh), zero = spu_splats(0u);
  const vec_uint4 odd_positions =
      spu_or(spu_or(outside_positive_half_normal(s.position.x), outside_positive_half_normal(s.position.y)),
             outside_positive_half_normal(s.position.z));
  const vec_uint4 odd_normals = spu_or(spu_or(below_half_normal(s.normal.x), below_half_normal(s.normal.y)),
                                       below_half_normal(s.normal.z));
  position = pack(high_half_of_positive(s.position.x), high_half_of_positive(s.position.y),
                  high_half_of_positive(s.position.z), one);
  normal = pack(high_half_of_normal(s.normal.x), high_half_of_normal(s.normal.y),
                high_half_of_normal(s.normal.z), zero);
  if (__builtin_expect(any_sign(spu_or(odd_positions, odd_normals)), 0)) {
    if (any_sign(odd_positions)) position = to_half_any(s.position, one);
    if (any_sign(odd_normals)) normal = to_half_any(s.normal, zero);
  }
}

/// Four vertices of 16 bytes: transposes the 4 x 4 words, one vertex to a quadword.
inline void store(const HalfVector& position, const HalfVector& normal, vec_ushort8* out) {
  const vec_uchar16 low = {0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23};
  const vec_uchar16 high = {8, 9, 10, 11, 24, 25, 26, 27, 12, 13, 14, 15, 28, 29, 30, 31};
  const vec_uint4 a = spu_shuffle(position.xy, normal.xy, low), b = spu_shuffle(position.xy, normal.xy, high);
  const vec_uint4 c = spu_shuffle(position.zw, normal.zw, low), d = spu_shuffle(position.zw, normal.zw, high);
  out[0] = (vec_ushort8)spu_shuffle(a, c, low);
  out[1] = (vec_ushort8)spu_shuffle(a, c, high);
  out[2] = (vec_ushort8)spu_shuffle(b, d, low);
  out[3] = (vec_ushort8)spu_shuffle(b, d, high);
}

inline void skin_group(const CellPolynomial& p, const Group& g, vec_ushort8* out) {
  const Component x = evaluate(p.x, g.xi, g.eta, g.zeta);
  const Component y = evaluate(p.y, g.xi, g.eta, g.zeta);
  const Component z = evaluate(p.z, g.xi, g.eta, g.zeta);
  const Surface surface = {
      {x.position, y.position, z.position},
      deformed_normal({x.f1, y.f1, z.f1}, {x.f2, y.f2, z.f2}, {x.f3, y.f3, z.f3}, g.normal)};
  HalfVector position, normal;
  to_half(surface, position, normal);
  store(position, normal, out);
}

/// One buffer of groups to one buffer of vertices.
void skin_chunk(const Group* groups, uint32_t count, vec_ushort8* vertices) {
  CellPolynomial p = polynomial_of(groups[0].corner);
  for (uint32_t i = 0; i < count; ++i) {
    // A chunk may begin in the middle of a cell; the first group's polynomial is always made.
    if (i != 0 && spu_extract(groups[i].continues, 0) == 0) p = polynomial_of(groups[i].corner);
    skin_group(p, groups[i], vertices + 4 * i);
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
          groups_in_chunk(chunk) * 4 * static_cast<uint32_t>(sizeof(SkinnedVertex)), kTagVertices + buffer, 0,
          0);
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
  if (ls.job.window[0].count > kSkinMaxCorners ||
      ls.job.window[1].count > kSkinMaxCorners - ls.job.window[0].count) {
    return kSkinTooManyCorners;
  }

  //   get   [0 A][1 B]     [2 A]     [3 B]          A, B: the two buffers in each direction, each with its
  //   own tag group work       [0 A]     [1 B]     [2 A]          an input buffer is free again when its work
  //   is done, put             [0 A]     [1 B]     [2 A]     an output buffer when its put of two chunks ago
  //   is
  const uint32_t chunks = (ls.job.group_count + kChunkGroups - 1) / kChunkGroups;
  if (chunks != 0) fetch_chunk(0);
  load_corners();
  for (uint32_t chunk = 0; chunk < chunks; ++chunk) {
    const uint32_t buffer = chunk & 1u;
    if (chunk + 1 < chunks) fetch_chunk(chunk + 1);
    wait_for_tags(1u << (kTagGroups + buffer) | 1u << (kTagVertices + buffer));
    skin_chunk(ls.groups[buffer], groups_in_chunk(chunk), ls.vertices[buffer]);
    put_chunk(chunk);
  }
  wait_for_tags(3u << kTagVertices);
  return kSkinDone;
}
