#pragma once
// The contract of the kernel `match`: plain data in main memory, the same bytes for both sides.
// Freestanding; included by the kernel and by the PPU side. All scalars are in the machine's own byte order.
//
// A plan contains what all bodies of one model share: constants of particles and regions, and lists that say
// which slots are added to which sums. The PPU side writes it once (ppu/plans/match_plan.h). Particles and regions lie in groups of four,
// one in each lane. The last group is filled up with particles without mass, or regions without particles. Particle i is in slot i + 1. A
// slot is three quadwords.

#include <stdint.h>

#include "sum_list_job.h"

namespace softcell::spu {

constexpr uint32_t kMatchSlotBytes = 48;
constexpr uint32_t kMatchSamples = 16;      ///< particles whose mean position is the body's origin
constexpr float kMatchPullLimit = 0x1p28f;  ///< limit of a pull times MatchHold::scale
constexpr uint32_t kTwistSlotBytes = 32;    ///< a slot of damping in match_tiles_job.h

/// Constants of four particles.
struct alignas(16) MatchParticles {
  float rest_moment[4][4];  ///< of each particle: m~ (x0 y0 z0 1), x0 about the rest centre, m~ = m / |R_i|
  float inverse_mass[4];    ///< 1 / m, kg^-1; 0 for padding
  float mass[4];            ///< m, kg; 0 for padding
  uint32_t region[4];       ///< offset of the slot of the particle's region
};
static_assert(sizeof(MatchParticles) == 112, "seven quadwords");

/// Constants of four regions.
struct alignas(16) MatchRegions {
  float centre_x[4];  ///< c0, the rest centre, about the body's rest centre; metres
  float centre_y[4];
  float centre_z[4];
  float inverse_mass[4];  ///< 1 / M_r, M_r the sum of m~; 0 for padding
};
static_assert(sizeof(MatchRegions) == 64, "four quadwords");

/// The rotations of four regions as unit quaternions, from which the next step starts.
struct alignas(16) MatchRotations {
  float x[4], y[4], z[4], w[4];
};
static_assert(sizeof(MatchRotations) == 64, "four quadwords");

/// Constants by which match/hold.h keeps the pull from moving the body as a whole.
struct MatchHold {
  /// 1 / (kg m), a power of two: m (g - x) times this is below kMatchPullLimit for pulls up to 1/16 of the
  /// body.
  float scale;
  float share;  ///< 1 / (scale times the body's mass)
};

/// A plan's first line. The other parts follow at the given offsets, in bytes from the header's start, each a
/// multiple of 16. Sum lists are those of sum_list_job.h.
struct alignas(128) MatchPlanHeader {
  uint32_t bytes;               ///< of the whole plan, header included; a multiple of 128
  uint32_t particles;           ///< 1 or more
  uint32_t regions;             ///< distinct ones, 1 or more
  uint32_t slots;               ///< of each buffer, slot 0 and padding included
  uint32_t particle_constants;  ///< offset of MatchParticles, groups_of(particles) of them
  uint32_t region_constants;    ///< offset of MatchRegions, groups_of(regions) of them
  uint32_t bars_of_particles;   ///< offset of a sum list: from particles
  uint32_t bars_of_regions;     ///< offset of a sum list: from each particle's region
  uint32_t plates;              ///< offset of a sum list: from bars
  uint32_t regions_of_plates;   ///< offset of a sum list: from plates
  /// m^2. In a region whose |A_r| is at most this times M_r, all particles are at one point.
  float noise_floor;
  float grid;  ///< metres: the body's origin is a multiple of this power of two
  MatchHold hold;
  uint32_t samples[kMatchSamples];  ///< indices of particles spread over the body
  uint32_t pad[2];
};
static_assert(sizeof(MatchPlanHeader) == 128, "one line");

/// The result of one body's step: the first quadword of its state.
struct alignas(16) MatchResult {
  /// Square of the largest |axial(R^T A)| over the sum of |A|'s elements, which is about an angle in radians.
  float residual_square;
  uint32_t finite;  ///< 0: a position or velocity is not finite, and nothing else was written
  uint32_t cold;    ///< in: not 0 if there are no rotations of an earlier step; out: 0
  uint32_t pad;
};

/// The addresses of one body. Both are multiples of 16 (128 is fastest).
struct alignas(16) MatchBody {
  uint64_t positions_ea;  ///< x y z and 0 of each particle, metres; read only
  /// Changed in place: a MatchResult; then velocities, x y z and 0 of each particle, m/s, padded to groups of four; then MatchRotations of
  /// all groups of regions.
  uint64_t state_ea;
};

/// The job's descriptor, one line in main memory: bodies of one model, stepped one after the other.
struct alignas(128) MatchJob {
  uint64_t plan_ea;     ///< a MatchPlanHeader and what follows it, 128-byte aligned
  uint64_t bodies_ea;   ///< body_count MatchBody, a multiple of 16
  uint32_t body_count;  ///< any number, 0 included
  float pull;           ///< alpha / h, 1/s
  float damping;        ///< k, 0..1
  /// For each rotation: 2 and 2 for a fixed effort; 0 and 6 to stop when the residual is small.
  uint32_t least_iterations;
  uint32_t most_iterations;
  uint32_t pad[23];
};
static_assert(sizeof(MatchJob) == 128, "one line");

/// What the kernel's main returns.
enum MatchStatus : uint32_t { kMatchDone = 0, kMatchTooLarge = 1 };

/// Bytes of one body's positions, or velocities, padding included.
constexpr uint32_t match_vectors_bytes(const MatchPlanHeader& plan) { return groups_of(plan.particles) * 64; }

/// Offset of the rotations in a body's state, and size of the state, in bytes.
constexpr uint32_t match_rotations_at(const MatchPlanHeader& plan) {
  return static_cast<uint32_t>(sizeof(MatchResult)) + match_vectors_bytes(plan);
}
constexpr uint32_t match_state_bytes(const MatchPlanHeader& plan) {
  return match_rotations_at(plan) + groups_of(plan.regions) * static_cast<uint32_t>(sizeof(MatchRotations));
}

/// Distance in bytes from one body to the next, and in local store from one part to the next.
constexpr uint32_t match_positions_stride(const MatchPlanHeader& plan) {
  return whole_lines(match_vectors_bytes(plan));
}
constexpr uint32_t match_state_stride(const MatchPlanHeader& plan) {
  return whole_lines(match_state_bytes(plan));
}

/// Bytes of local store for the plan, one body, momenta of regions and two buffers of slots.
constexpr uint32_t match_momenta_bytes(const MatchPlanHeader& plan) { return groups_of(plan.regions) * 48; }
constexpr uint32_t match_buffer_bytes(const MatchPlanHeader& plan) { return plan.slots * kMatchSlotBytes; }
constexpr uint32_t match_local_store_bytes(const MatchPlanHeader& plan) {
  return plan.bytes + match_positions_stride(plan) + match_state_stride(plan) + match_momenta_bytes(plan) +
         2 * match_buffer_bytes(plan);
}

/// Bytes of local store that the kernel has for these. Its checked build has twice the code, and so less room.
constexpr uint32_t kMatchArenaBytes = 216 * 1024, kMatchCheckedArenaBytes = 176 * 1024;

/// True if a plan and one body's state fit in `arena_bytes`. Accepts any numbers in the header.
constexpr bool match_fits(const MatchPlanHeader& plan, uint32_t arena_bytes) {
  const uint32_t most = arena_bytes / 16;  // of any count; up to this, sizes do not overflow
  return plan.bytes <= arena_bytes && plan.particles <= most && plan.regions <= most && plan.slots <= most &&
         match_local_store_bytes(plan) <= arena_bytes;
}

}  // namespace softcell::spu
