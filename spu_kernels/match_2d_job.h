#pragma once
// The contract of the kernel `match_2d`: plain data in main memory, the same bytes for both sides.
// Freestanding; included by the kernel and by the PPU side. All scalars are in the machine's own byte order.
//
// The same as match_job.h in two dimensions, where a rotation has a closed form and a slot is one quadword. The bodies of one model lie one
// after the other in two arrays: one that the SPEs only read, and one that they change. Each body begins on a line of 128 bytes:
//
//     positions   particles, padded to a multiple of four            match_2d_positions_stride() each
//     states      MatchResult2d, velocities, directions of regions   match_2d_state_stride() each

#include <stdint.h>

#include "sum_list_job.h"

namespace softcell::spu {

constexpr uint32_t kMatch2dSlotBytes = 16;

/// Metres, or m/s.
struct MatchVector2d {
  float x, y;
};

/// Constants of four particles. The last group is filled up with particles without mass.
struct alignas(16) MatchParticles2d {
  float rest_x[4];         ///< x0, the rest position, about the body's rest centre; metres
  float rest_y[4];         ///< y0
  float modified_mass[4];  ///< m~ = m / |R_i|, kg; 0 for padding
  float share[4];          ///< 1 / |R_i|; 0 for padding
  float mass[4];           ///< m, kg; 0 for padding
  uint32_t region[4];      ///< offset of the slot of the particle's region
};
static_assert(sizeof(MatchParticles2d) == 96, "six quadwords");

/// Constants of four regions. The last group is filled up with regions without particles.
struct alignas(16) MatchRegions2d {
  float centre_x[4];  ///< c0, the rest centre, about the body's rest centre; metres
  float centre_y[4];
  float inverse_mass[4];  ///< 1 / M_r, M_r the sum of m~; 0 for padding
};
static_assert(sizeof(MatchRegions2d) == 48, "three quadwords");

/// The directions of the x axes of four regions. A region whose sum has no direction keeps the direction of the last step.
struct alignas(16) MatchDirections {
  float cosine[4], sine[4];
};
static_assert(sizeof(MatchDirections) == 32, "two quadwords");

/// A plan's first line. The other parts follow at the given offsets, in bytes from the header's start, each a
/// multiple of 16. Sum lists are those of sum_list_job.h.
struct alignas(128) MatchPlanHeader2d {
  uint32_t bytes;               ///< of the whole plan, header included; a multiple of 128
  uint32_t particles;           ///< 1 or more
  uint32_t regions;             ///< distinct ones, 1 or more
  uint32_t slots;               ///< of each buffer, slot 0 and padding included
  uint32_t particle_constants;  ///< offset of MatchParticles2d, groups_of(particles) of them
  uint32_t region_constants;    ///< offset of MatchRegions2d, groups_of(regions) of them
  uint32_t bars_of_particles;   ///< offset of a sum list: from particles
  uint32_t bars_of_regions;     ///< offset of a sum list: from each particle's region
  uint32_t regions_of_bars;     ///< offset of a sum list: from bars
  float noise_floor;            ///< m^2: a region whose |C| + |S| is at most this times M_r has no direction
  float grid;                   ///< metres: the body's origin is a multiple of this power of two
  float inverse_mass;           ///< 1 / kg, of the body
  float inverse_particles;      ///< 1 / particles: the bits of an SPU's division depend on its compiler
  uint32_t pad[19];
};
static_assert(sizeof(MatchPlanHeader2d) == 128, "one line");

/// The result of one body's step: the first quadword of its state.
struct alignas(16) MatchResult2d {
  uint32_t finite;  ///< 0: a position or velocity is not finite, and nothing else was written
  uint32_t pad[3];
};

/// The job's descriptor, one line in main memory: bodies of one model, stepped one after the other.
struct alignas(128) MatchJob2d {
  uint64_t plan_ea;       ///< a MatchPlanHeader2d and what follows it, 128-byte aligned
  uint64_t positions_ea;  ///< of the first body, 128-byte aligned; read only
  uint64_t states_ea;     ///< of the first body, 128-byte aligned; changed in place
  uint32_t body_count;    ///< any number, 0 included
  float pull;             ///< alpha / h, 1/s
  float damping;          ///< k, 0..1
  uint32_t pad[23];
};
static_assert(sizeof(MatchJob2d) == 128, "one line");

/// What the kernel's main returns.
enum Match2dStatus : uint32_t { kMatch2dDone = 0, kMatch2dTooLarge = 1 };

/// Bytes of one body's positions, or velocities.
constexpr uint32_t match_2d_vectors_bytes(const MatchPlanHeader2d& plan) {
  return groups_of(plan.particles) * 4 * static_cast<uint32_t>(sizeof(MatchVector2d));
}

/// Offset of the directions in a body's state, and size of the state, in bytes.
constexpr uint32_t match_2d_directions_at(const MatchPlanHeader2d& plan) {
  return static_cast<uint32_t>(sizeof(MatchResult2d)) + match_2d_vectors_bytes(plan);
}
constexpr uint32_t match_2d_state_bytes(const MatchPlanHeader2d& plan) {
  return match_2d_directions_at(plan) +
         groups_of(plan.regions) * static_cast<uint32_t>(sizeof(MatchDirections));
}

/// Distance in bytes from one body to the next.
constexpr uint32_t match_2d_positions_stride(const MatchPlanHeader2d& plan) {
  return whole_lines(match_2d_vectors_bytes(plan));
}
constexpr uint32_t match_2d_state_stride(const MatchPlanHeader2d& plan) {
  return whole_lines(match_2d_state_bytes(plan));
}

/// Bytes of local store for the plan, two bodies (the kernel fetches one while it steps the other), centres
/// of regions and two buffers of slots.
constexpr uint32_t match_2d_local_store_bytes(const MatchPlanHeader2d& plan) {
  return plan.bytes + 2 * (match_2d_positions_stride(plan) + match_2d_state_stride(plan)) +
         groups_of(plan.regions) * 32 + 2 * plan.slots * kMatch2dSlotBytes;
}

/// Bytes of local store that the kernel has for these.
constexpr uint32_t kMatch2dArenaBytes = 192 * 1024;

/// True if a plan and its bodies fit. Accepts any numbers in the header.
constexpr bool match_2d_fits(const MatchPlanHeader2d& plan) {
  const uint32_t most = kMatch2dArenaBytes / 16;  // of any count; up to this, sizes do not overflow
  return plan.bytes <= kMatch2dArenaBytes && plan.particles <= most && plan.regions <= most &&
         plan.slots <= most && match_2d_local_store_bytes(plan) <= kMatch2dArenaBytes;
}

}  // namespace softcell::spu
