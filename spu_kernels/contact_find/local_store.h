#pragma once
// The layout of the local store of the kernel `contact_find`: a task, two bodies, their cells that are near the other body, candidates and
// contacts; and the transfers of these.

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "common/dma.h"
#include "contact_find_job.h"
#include "contacts/body_in_store.h"
#include "contacts/deformed_cell.h"
#include "contacts/embedded_contact.h"

namespace softcell::spu {
namespace {  // a part of contact_find.cpp, which alone includes it

enum Tag : uint32_t { kTagTask = 0, kTagIn = 1, kTagOut = 2 };

#ifdef SOFTCELL_CHECKED  // its code is twice as large
constexpr uint32_t kBatch = 1, kInverses = 8, kContactBatch = 4;
#else
constexpr uint32_t kBatch = 16;         // tasks that are fetched together
constexpr uint32_t kInverses = 64;      // that are kept
constexpr uint32_t kContactBatch = 64;  // contacts that go to main memory together
#endif
constexpr uint32_t kGroups = 4;  // of a FindCandidate
/// A part of main memory of which the local store has a copy.
struct Part {
  uint64_t ea;  // 0: nothing
  uint32_t offset;
};

/// Cells of a body that are near the other one: their boxes, as in FindBoxes but close together.
struct NearCells {
  uint32_t count;
  alignas(16) float box[6][kFindMaxNear + 4];
  vec_float4 block[kFindMaxNear / 16]
                  [6];  // of 16 cells: lane i is around the cells i, i + 4, i + 8 and i + 12
  uint16_t cell[kFindMaxNear];
};
static_assert(kFindMaxNear % 16 == 0, "whole blocks");

/// Bounds of near cells, one in each lane, as RoughInverse: a point may be in the cell if it is within a distance of the three pairs of
/// planes and of the plane below the surface.
struct NearBounds {
  enum Row : uint32_t {
    kMiddle = 0,   // x y z
    kRow1 = 3,     // x y z of each of the inverse's rows
    kReach = 12,   // by s1 s2 s3
    kLength = 15,  // of the three rows, 1/m: converts metres to the unit of kReach
    kSlope = 18,   // x y z: of the plane below the field, in the world
    kLimit = 21,   // largest value of this plane's function for points that may be near
    kSteep = 22,   // length of the slope
    kRows = 23
  };
  alignas(16) float row[kRows][kFindMaxNear + 4];
};

/// Everything this kernel keeps in local store beside its code and stack.
struct alignas(128) LocalStoreMap {
  FindJob job;
  FindTask tasks[kBatch];
  FindResult results[kBatch];
  FindResult result;
  alignas(128) char bytes[kFindMaxBytes];  // model and state of a, then those of b
  Part model[2], state[2];
  alignas(128) SolvedContact contacts[kContactBatch];  // the newest contacts
  uint32_t contacts_sent;                              // number of contacts that were stored before these
  uint32_t contacts_most;                              // the most that the task may have
  uint64_t contacts_ea;                                // of the task
  NearCells near[2];                                   // of a, of b
  uint16_t inverse_of[kInverses];                      // the cell of each inverse
  uint16_t meets[kFindMaxNear];
  alignas(128) FindCandidate candidates[kFindMaxCandidates];
  uint32_t candidate_count;
  union {
    alignas(16) float along[2][kFindMaxParticles];  // places of particles between the two bodies
    NearBounds bounds;                              // behind that
    RoughInverse inverse[kInverses];  // if candidates are known; of a cell: at its number modulo kInverses
  };
  uint32_t under_way;  // tag groups with transfers
};
LocalStoreMap ls;

/// The places of a body's parts.
BodyInStore body_in_store(uint32_t model, uint32_t state, const FindBody& body) {
  const auto at = [](uint32_t offset) { return reinterpret_cast<const vec_float4*>(ls.bytes + offset); };
  const uint32_t ends = state + (body.cell_count + 3) / 4 * static_cast<uint32_t>(sizeof(FindBoxes));
  return {reinterpret_cast<const CellAtRest*>(ls.bytes + model),
          at(model + body.cell_count * static_cast<uint32_t>(sizeof(FindCell))),
          at(state),
          at(ends),
          at(ends + body.particle_count * 16),
          body.cell_count,
          body.particle_count,
          body.spacing};
}

/// The PPU side orders tasks so that much is in the local store already.
inline bool is_there(Part& part, uint64_t ea, uint32_t offset) {
  const bool is = part.ea == ea && part.offset == offset;
  part = {ea, offset};
  return is;
}

void fetch_model(Part& part, uint32_t offset, const FindBody& body) {
  if (is_there(part, body.cells_ea, offset)) return;
  const uint32_t cells = body.cell_count * static_cast<uint32_t>(sizeof(FindCell));
  get_large(ls.bytes + offset, body.cells_ea, cells, kTagIn);
  get_large(ls.bytes + offset + cells, body.groups_ea,
            body.group_count * static_cast<uint32_t>(sizeof(FindGroup)), kTagIn);
  ls.under_way |= 1u << kTagIn;
}

void fetch_state(Part& part, uint32_t offset, const FindBody& body) {
  if (is_there(part, body.state_ea, offset)) return;
  get_large(ls.bytes + offset, body.state_ea, find_state_bytes(body), kTagIn);
  ls.under_way |= 1u << kTagIn;
}

/// Rounds up to whole quadwords.
inline uint32_t bytes_of_candidates(uint32_t count) {
  return (count + 1) / 2 * 2 * static_cast<uint32_t>(sizeof(FindCandidate));
}

/// Waits until all transfers of bodies and contacts are complete.
void wait_for_all() {
  if (ls.under_way != 0) wait_for_tags(ls.under_way);
  ls.under_way = 0;
}

/// Stores the contacts in main memory.
void send_contacts() {
  const uint32_t count = ls.result.count - ls.contacts_sent;
  if (count == 0) return;
  constexpr uint32_t kBytes = sizeof(SolvedContact);
  static_assert(kContactBatch * kBytes <= 16384, "one command");
  mfc_put(ls.contacts, ls.contacts_ea + ls.contacts_sent * kBytes, count * kBytes, kTagOut, 0, 0);
  ls.under_way |= 1u << kTagOut;
  ls.contacts_sent = ls.result.count;
}

/// The place of the next contact.
SolvedContact& room_for_contact() {
  if (ls.result.count - ls.contacts_sent == kContactBatch) {
    send_contacts();
    wait_for_all();
  }
  return ls.contacts[ls.result.count - ls.contacts_sent];
}

}  // namespace
}  // namespace softcell::spu
