// strain: how much a body is strained, so that the PPU knows whether it may yield or break.  [LSM07, fracture]
//
//   lengths   the largest | |x_to - x_from|^2 / d^2 - 1 |, d the distance at rest: of edges, and of diagonals
//   faces     the number of those that may break:  |m_high - m_low| > (1 + stretch) spacing,  or
//                                                  |F_high - F_low| > sqrt(2) turn / pi
//             m is the mean of a cell's corners, F its mean edges over the spacing. Two rotations that are `turn` apart differ by
//             sqrt(2) turn / pi at least, and so do the F from which they come (ppu/fracture/break_test.cpp).
//
//   array      direction  element                      count      alignment
//   job        in         StrainJob, 128 bytes         1          128
//   positions  in         x y z 0, 16 bytes, or        <= 10240   16
//                         x y, 8 bytes
//   lengths    in         StrainLengths, 32 bytes      any        16
//   faces      in         StrainFaces, 112 bytes       any        16
//   result     out        StrainResult, 16 bytes       1          16
//
// The result is a hint: the kernel also counts faces somewhat below their limits, and the PPU computes exactly for a body that has any. So
// no state depends on how this kernel rounds.
//
// Budget: 208 KB. Positions 160 KB, two buffers of 16 KB for lists, the rest for code and 1 KB of stack. Lists pass through the buffers
// once and in order, so a body may have any number of cells.
//
// Compiles unchanged with a real SPU g++ (7 to 9, -std=c++17).

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "common/dma.h"
#include "common/lane_mask.h"
#include "common/transpose.h"
#include "strain_job.h"

namespace softcell::spu {
namespace {

enum Tag : uint32_t {
  kTagBody = 0,  // the descriptor, then positions, then the result
  kTagList = 1   // 1 and 2: the two buffers
};

/// A StrainLengths as registers.
struct Lengths {
  vec_ushort8 ends;  // from, then to
  vec_float4 inverse_square;
};
static_assert(sizeof(Lengths) == sizeof(StrainLengths), "the same bytes");

/// A StrainFaces as registers: two faces to a quadword.
struct Faces {
  vec_ushort8 low[2], between[2], high[2];
  vec_float4 strength;
};
static_assert(sizeof(Faces) == sizeof(StrainFaces), "the same bytes");

/// Everything this kernel keeps in local store beside its code and stack.
struct alignas(128) LocalStoreMap {
  StrainJob job;
  vec_float4 positions[kStrainMaxParticles];  // x y z 0
  alignas(128) char lists[2][kMaxTransferBytes];
  StrainResult result;
};
LocalStoreMap ls;

/// The offsets of eight particles' positions, in bytes. Two multiplications compute all eight; to extract halfwords would take an SPU
/// several instructions each. With this, and without loops over corners, a face takes 40 cycles instead of 300.
struct Places {
  __attribute__((always_inline)) explicit Places(vec_ushort8 particles)
      : even(spu_mule(particles, spu_splats(uint16_t{16}))),
        odd(spu_mulo(particles, spu_splats(uint16_t{16}))) {}

  __attribute__((always_inline)) vec_float4 position(int lane) const {
    const uint32_t place = spu_extract(lane % 2 == 0 ? even : odd, lane / 2);
    return *reinterpret_cast<const vec_float4*>(reinterpret_cast<const char*>(ls.positions) + place);
  }

  vec_uint4 even, odd;
};

/// Makes quadwords x y 0 0 of one particle from quadwords x y x y of two, in place. It begins with the last pair, so that no quadword is
/// overwritten before it has been read.
void make_solid() {
  const vec_uchar16 first = {0, 1, 2, 3, 4, 5, 6, 7, 16, 17, 18, 19, 20, 21, 22, 23};
  const vec_uchar16 second = {8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23};
  const vec_float4 zero = spu_splats(0.0f);
  for (uint32_t pairs = (ls.job.particles + 1) / 2; pairs != 0; --pairs) {
    const vec_float4 pair = ls.positions[pairs - 1];
    ls.positions[2 * pairs - 2] = spu_shuffle(pair, zero, first);
    ls.positions[2 * pairs - 1] = spu_shuffle(pair, zero, second);
  }
}

/// Calls work(groups, count) for pieces of a list, one after the other. During the work on a piece the MFC fetches the next.
template <typename Group, typename Work>
inline void for_each_piece(uint64_t ea, uint32_t count, const Work& work) {
  constexpr uint32_t kGroups = kMaxTransferBytes / sizeof(Group);
  const auto groups_in = [&](uint32_t piece) {
    const uint32_t left = count - piece * kGroups;
    return left < kGroups ? left : kGroups;
  };
  const auto fetch = [&](uint32_t piece) {
    mfc_get(ls.lists[piece & 1u], ea + static_cast<uint64_t>(piece) * kGroups * sizeof(Group),
            groups_in(piece) * static_cast<uint32_t>(sizeof(Group)), kTagList + (piece & 1u), 0, 0);
  };
  const uint32_t pieces = (count + kGroups - 1) / kGroups;
  if (pieces != 0) fetch(0);
  for (uint32_t piece = 0; piece < pieces; ++piece) {
    if (piece + 1 < pieces) fetch(piece + 1);
    wait_for_tag(kTagList + (piece & 1u));
    work(reinterpret_cast<const Group*>(ls.lists[piece & 1u]), groups_in(piece));
  }
}

/// @return  the largest change of a squared distance in `count` groups at `ea`
float largest_change(uint64_t ea, uint32_t count) {
  vec_float4 largest = spu_splats(0.0f);
  for_each_piece<Lengths>(ea, count, [&](const Lengths* group, uint32_t groups) {
    for (const Lengths* const end = group + groups; group != end; ++group) {
      const Places ends(group->ends);
      const auto squares = [&](int k) __attribute__((always_inline)) {
        const vec_float4 along = spu_sub(ends.position(4 + k), ends.position(k));
        return spu_mul(along, along);
      };
      const vec_float4 square = sums_of_rows({squares(0), squares(1), squares(2), squares(3)});
      const vec_float4 change = absolute(spu_msub(square, group->inverse_square, spu_splats(1.0f)));
      largest = spu_sel(largest, change, negative_lanes(less(largest, change)));
    }
  });
  return largest_lane(largest);
}

/// The limits of faces of strength s. Corners are summed and not averaged, so distances of middles are eight times as large, and edges four
/// times as long.
struct Limits {
  vec_float4 middles, more_middles;  // limit of the distance of middles: middles + s more_middles
  vec_float4 turn, edges_of_turn;    // rad; limit of the difference of edges: s edges_of_turn - tolerance
  vec_float4 tolerance;
};

Limits limits_of(const StrainJob& job) {
  constexpr float kShare = 1 - kStrainShare, kRootOfTwoOverPi = 0x1.ccf642p-2f;  // 0.4501...
  const float middles = 8 * job.spacing * kShare;
  return {spu_splats(middles), spu_splats(middles * job.stretch), spu_splats(job.turn),
          spu_splats(4 * job.spacing * kShare * kRootOfTwoOverPi * job.turn),
          spu_splats(kStrainSpacings * job.spacing)};
}

/// The squared differences of the two cells of a face, by x y z; they have still to be summed.
struct Differences {
  vec_float4 middles, edges;
};

/// @param low, between, high  the corners of two faces   @param first  0: of the first face, 4: of the second
template <bool kTurns>
__attribute__((always_inline)) inline Differences differences(const Places& low, const Places& between,
                                                              const Places& high, int first) {
  const auto across_at = [&](int k) __attribute__((always_inline)) {
    return spu_sub(high.position(first + k), low.position(first + k));
  };
  const vec_float4 across[4] = {across_at(0), across_at(1), across_at(2), across_at(3)};
  const vec_float4 near = spu_add(across[0], across[1]), far = spu_add(across[2], across[3]);
  const vec_float4 middles = spu_add(near, far);
  if constexpr (!kTurns) return {spu_mul(middles, middles), spu_splats(0.0f)};
  // The cells share the edges that lie in the face. The other edges along i and j differ by differences of `across`.
  const vec_float4 i = spu_add(spu_sub(across[1], across[0]), spu_sub(across[3], across[2]));
  const vec_float4 j = spu_sub(far, near);
  const auto bend_at = [&](int k) __attribute__((always_inline)) {
    const vec_float4 here = between.position(first + k);
    return spu_sub(spu_sub(high.position(first + k), here), spu_sub(here, low.position(first + k)));
  };
  const vec_float4 bend[4] = {bend_at(0), bend_at(1), bend_at(2), bend_at(3)};
  const vec_float4 along = spu_add(spu_add(bend[0], bend[1]), spu_add(bend[2], bend[3]));
  return {spu_mul(middles, middles), spu_madd(i, i, spu_madd(j, j, spu_mul(along, along)))};
}

/// @return  the number of these faces that may break, as a count in each lane
template <bool kTurns>
__attribute__((noinline)) vec_uint4 count_faces(const Faces* group, uint32_t groups, const Limits& limits) {
  vec_uint4 found = spu_splats(0u);
  for (const Faces* const end = group + groups; group != end; ++group) {
    const Places low[2] = {Places(group->low[0]), Places(group->low[1])};
    const Places between[2] = {Places(group->between[0]), Places(group->between[1])};
    const Places high[2] = {Places(group->high[0]), Places(group->high[1])};
    const Differences a = differences<kTurns>(low[0], between[0], high[0], 0);
    const Differences b = differences<kTurns>(low[0], between[0], high[0], 4);
    const Differences c = differences<kTurns>(low[1], between[1], high[1], 0);
    const Differences d = differences<kTurns>(low[1], between[1], high[1], 4);
    const vec_float4 strength = group->strength;
    const vec_float4 middles = spu_madd(strength, limits.more_middles, limits.middles);
    vec_uint4 breaks =
        less(spu_mul(middles, middles), sums_of_rows({a.middles, b.middles, c.middles, d.middles}));
    if constexpr (kTurns) {
      const vec_float4 zero = spu_splats(0.0f);
      const vec_float4 half_turn = spu_splats(0x1.921fb8p+1f);  // a little more than pi: no turn is larger
      const vec_float4 bears = spu_msub(strength, limits.edges_of_turn, limits.tolerance);
      const vec_float4 edges = spu_sel(bears, zero, negative_lanes((vec_uint4)bears));
      const vec_uint4 turns = less(spu_mul(edges, edges), sums_of_rows({a.edges, b.edges, c.edges, d.edges}));
      breaks = spu_or(breaks, spu_and(turns, less(spu_mul(strength, limits.turn), half_turn)));
    }
    found = spu_add(found, spu_rlmask(breaks, -31));
  }
  return found;
}

uint32_t faces_that_may_break() {
  const Limits limits = limits_of(ls.job);
  const bool turns = ls.job.turn < kStrainNever;
  vec_uint4 found = spu_splats(0u);
  for_each_piece<Faces>(ls.job.faces_ea, ls.job.face_groups, [&](const Faces* group, uint32_t groups) {
    found = spu_add(
        found, turns ? count_faces<true>(group, groups, limits) : count_faces<false>(group, groups, limits));
  });
  return spu_extract(found, 0) + spu_extract(found, 1) + spu_extract(found, 2) + spu_extract(found, 3);
}

}  // namespace
}  // namespace softcell::spu

/// argp: effective address of a StrainJob. Returns a StrainStatus.
int main(uint64_t, uint64_t argp, uint64_t) {
  using namespace softcell::spu;
  mfc_get(&ls.job, argp, sizeof(StrainJob), kTagBody, 0, 0);
  wait_for_tag(kTagBody);
  const StrainJob& job = ls.job;
  if (job.particles > kStrainMaxParticles) return kStrainTooLarge;
  const uint32_t groups_of_four = (job.particles + 3) / 4;
  get_large(ls.positions, job.positions_ea, groups_of_four * (job.flat != 0 ? 32 : 64), kTagBody);
  wait_for_tag(kTagBody);
  if (job.flat != 0) make_solid();
  ls.result.edges = largest_change(job.lengths_ea, job.edge_groups);
  ls.result.diagonals = largest_change(
      job.lengths_ea + static_cast<uint64_t>(job.edge_groups) * sizeof(StrainLengths), job.diagonal_groups);
  ls.result.faces = faces_that_may_break();
  ls.result.pad = 0;
  mfc_put(&ls.result, job.result_ea, sizeof(StrainResult), kTagBody, 0, 0);
  wait_for_tag(kTagBody);
  return kStrainDone;
}
