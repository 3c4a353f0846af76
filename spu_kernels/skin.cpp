// skin: mesh vertices from the particles of their lattice cells.  [LSM07, embedding]
//
//   x = sum_k N_k(xi, eta, zeta) x_k        trilinear, over the cell's eight corners
//   F = (dx/dxi, dx/deta, dx/dzeta)         deformation gradient times the spacing, which drops out of n
//   n = normalize(cof(F) N)                 cof(F) = [f2 x f3, f3 x f1, f1 x f2], N the rest normal
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
#include "common/lane_mask.h"
#include "skin/cell.h"
#include "skin/drawn_vertex.h"
#include "skin_job.h"

namespace softcell::spu {
namespace {

constexpr uint32_t kChunkGroups = 128;  // 16 KB in, the most one command moves, and 8 KB out

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

/// Four points of the surface: positions as half floats, normals of any length.
struct Surface {
  HalfVectors position;
  Vector3x4 normal;
};

template <Positions kPositions>
__attribute__((always_inline)) inline Surface surface_of(const CellPolynomial& p, const Group& g,
                                                         vec_float4 zeta) {
  const Component x = evaluate(p.x, g.xi, g.eta, zeta);
  const Component y = evaluate(p.y, g.xi, g.eta, zeta);
  const Component z = evaluate(p.z, g.xi, g.eta, zeta);
  return {half_positions<kPositions>({x.position, y.position, z.position}),
          deformed_normal({x.f1, y.f1, z.f1}, {x.f2, y.f2, z.f2}, {x.f3, y.f3, z.f3}, g.normal)};
}

/// Makes the vertices of one buffer of groups, one or more.
///
/// A group is one chain of dependent operations: some 95 cycles on a host, where the arithmetic alone would take 40. So
/// each pass of the loop evaluates a group and finishes the normals of the one before it, and the two
/// overlap. A pass also loads whether the next group is in the same cell, because an SPU takes 19 cycles to load that and to branch.
template <Positions kPositions>
void skin_chunk(const Group* groups, uint32_t count, vec_ushort8* vertices) {
  CellPolynomial p = polynomial_of(ls.corner, groups[0].corner);  // a chunk may begin in the middle of a cell
  Surface before = surface_of<kPositions>(p, groups[0], groups[0].zeta);
  const Group* group = groups + (count > 1);
  uint32_t same_cell = spu_extract(group->continues, 0);
  vec_float4 zeta = group->zeta;
  for (uint32_t i = 1; i < count; ++i, vertices += 4) {
    if (__builtin_expect(same_cell == 0, 0)) p = polynomial_of(ls.corner, group->corner);
    const Surface surface = surface_of<kPositions>(p, *group, zeta);
    group = groups + (i + (i + 1 < count));  // without a branch
    same_cell = spu_extract(group->continues, 0);
    zeta = group->zeta;
    store(before.position, half_normals<kPositions>(before.normal), vertices);
    before = surface;
  }
  store(before.position, half_normals<kPositions>(before.normal), vertices);
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

/// Fetches both windows of corners, one behind the other.
void fetch_corners() {
  const SkinWindow& first = ls.job.window[0];
  const SkinWindow& second = ls.job.window[1];
  get_large(ls.corner, first.ea, first.count * 16u, kTagCorners);
  get_large(ls.corner + first.count, second.ea, second.count * 16u, kTagCorners);
}

/// Waits for the corners and subtracts the origin from them.
/// @return  how positions between these corners have to be converted
Positions prepare_corners() {
  wait_for_tag(kTagCorners);
  const vec_float4 origin = {ls.job.origin[0], ls.job.origin[1], ls.job.origin[2], 0.0f};
  vec_uint4 odd = spu_splats(0u);
  const uint32_t count = ls.job.window[0].count + ls.job.window[1].count;
  for (uint32_t i = 0; i < count; ++i) {
    ls.corner[i] = spu_sub(ls.corner[i], origin);
    odd = note_odd(odd, ls.corner[i]);
  }
  const vec_uint4 xyz = {0xFFFFFFFFu, 0xFFFFFFFFu, 0xFFFFFFFFu, 0};
  return any_negative(spu_and(odd, xyz)) ? Positions::kAny : Positions::kOrdinary;
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

  //   get   [0 A][1 B]     [2 A]     [3 B]        A, B: the two buffers of each direction, with a tag group each
  //   work       [0 A]     [1 B]     [2 A]        an input buffer is free again when its work is done,
  //   put             [0 A]     [1 B]     [2 A]   an output buffer when its put of two chunks ago is complete
  //
  const uint32_t chunks = (ls.job.group_count + kChunkGroups - 1) / kChunkGroups;
  fetch_corners();
  if (chunks != 0) fetch_chunk(0);  // arrives while the corners are prepared
  const Positions positions = prepare_corners();
  const auto skin =
      positions == Positions::kOrdinary ? skin_chunk<Positions::kOrdinary> : skin_chunk<Positions::kAny>;
  for (uint32_t chunk = 0; chunk < chunks; ++chunk) {
    const uint32_t buffer = chunk & 1u;
    if (chunk + 1 < chunks) fetch_chunk(chunk + 1);
    wait_for_tags(1u << (kTagGroups + buffer) | 1u << (kTagVertices + buffer));
    skin(ls.groups[buffer], groups_in_chunk(chunk), ls.vertices[buffer]);
    put_chunk(chunk);
  }
  wait_for_tags(3u << kTagVertices);
  return kSkinDone;
}
