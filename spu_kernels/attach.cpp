// attach: solves attachments of soft bodies to the world, to rigid bodies and to each other.  [Cat05]
//
//   array       direction  element                      count    alignment
//   job         in         AttachJob, 128 bytes         1        128
//   runs        in         AttachRun, 16 bytes          <= 256   16
//   velocities  in, out    SolveVelocity, 16 bytes      <= 2048  16
//   links       in, out    AttachLink, 256 bytes        <= 48    16
//   points      in, out    AttachPoint, 96 bytes        <= 384   16
//   rows        in, out    AttachRow, 128 bytes         <= 96    16
//   entries     in, out    AttachEntry, 48 bytes        <= 1280  16
//   rigids      in, out    of SolveRigid, 80 bytes      <= 64    16
//
// The local store holds only those runs of a body's particles that have attached particles: their velocities and their pushes. Links that
// share a body see each other's changes in each iteration, without transfers in between.
//
// Budget: 224 KB. Velocities and pushes 64 KB, points 36 KB, entries 60 KB, links and rows 12 KB each, runs and rigid bodies 4 KB each;
// the rest for code and 2 KB of stack.
//
// Compiles unchanged with a real SPU g++ (7 to 9, -std=c++17).

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "attach/solve.h"
#include "attach_job.h"
#include "common/dma.h"

namespace softcell::spu {
namespace {

enum Tag : uint32_t { kTagJob = 0, kTagIn = 1, kTagOut = 2 };

/// Everything this kernel keeps in local store beside its code and stack.
struct alignas(128) LocalStoreMap {
  AttachJob job;
  alignas(128) vec_float4 velocities[kAttachMaxSlots];
  alignas(128) vec_float4 pushes[kAttachMaxSlots];
  alignas(128) AttachRigid rigid_list[kAttachMaxRigids];
  alignas(128) RigidInMotion rigids[kAttachMaxRigids];
  alignas(128) Link links[kAttachMaxLinks];
  alignas(128) Point points[kAttachMaxPoints];
  alignas(128) Row rows[kAttachMaxRows];
  alignas(128) Entry entries[kAttachMaxEntries];
  alignas(128) AttachRun runs[kAttachMaxRuns];
};
LocalStoreMap ls;

template <typename T>
void get_array(T* to, uint64_t ea, uint32_t count) {
  get_large(to, ea, count * static_cast<uint32_t>(sizeof(T)), kTagIn);
}
template <typename T>
void put_array(T* from, uint64_t ea, uint32_t count) {
  put_large(from, ea, count * static_cast<uint32_t>(sizeof(T)), kTagOut);
}

bool fits(const AttachJob& job) {
  return job.run_count <= kAttachMaxRuns && job.link_count <= kAttachMaxLinks &&
         job.point_count <= kAttachMaxPoints && job.row_count <= kAttachMaxRows &&
         job.entry_count <= kAttachMaxEntries && job.rigid_count <= kAttachMaxRigids;
}

/// Calls move(slots, address, bytes) for the velocities of each run, and for its pushes if the job has pushes.
template <typename Move>
__attribute__((always_inline)) inline void each_run(const Move& move) {
  uint32_t slot = 0;
  for (uint32_t i = 0; i < ls.job.run_count; ++i) {
    const AttachRun& run = ls.runs[i];
    move(ls.velocities + slot, run.velocities_ea, run.count * 16);
    if (ls.job.pushes != 0) move(ls.pushes + slot, run.velocities_ea + run.pushes, run.count * 16);
    slot += run.count;
  }
}

/// Fetches everything that the job names. @return  false: there are too many slots
bool fetch() {
  const AttachJob& job = ls.job;
  get_array(ls.runs, job.runs_ea, job.run_count);
  get_array(ls.links, job.links_ea, job.link_count);
  get_array(ls.points, job.points_ea, job.point_count);
  get_array(ls.rows, job.rows_ea, job.row_count);
  get_array(ls.entries, job.entries_ea, job.entry_count);
  get_array(ls.rigid_list, job.rigids_ea, job.rigid_count);
  wait_for_tag(kTagIn);
  uint32_t slots = 0;
  for (uint32_t i = 0; i < job.run_count; ++i) {
    if (ls.runs[i].count > kAttachMaxSlots - slots) return false;
    slots += ls.runs[i].count;
  }
  each_run([](vec_float4* to, uint64_t ea, uint32_t bytes) { get_large(to, ea, bytes, kTagIn); });
  for (uint32_t i = 0; i < job.rigid_count; ++i)
    mfc_get(ls.rigids + i, ls.rigid_list[i].rigid_ea, sizeof(RigidInMotion), kTagIn, 0, 0);
  wait_for_tag(kTagIn);
  return true;
}

void send() {
  const AttachJob& job = ls.job;
  each_run([](vec_float4* from, uint64_t ea, uint32_t bytes) { put_large(from, ea, bytes, kTagOut); });
  put_array(ls.links, job.links_ea, job.link_count);
  put_array(ls.points, job.points_ea, job.point_count);
  put_array(ls.rows, job.rows_ea, job.row_count);
  if (job.pushes != 0) put_array(ls.entries, job.entries_ea, job.entry_count);
  for (uint32_t i = 0; i < job.rigid_count; ++i)
    mfc_put(ls.rigids + i, ls.rigid_list[i].rigid_ea, sizeof(RigidInMotion), kTagOut, 0, 0);
  wait_for_tag(kTagOut);
}

/// Calls work(parts) for each link.
template <typename Work>
__attribute__((always_inline)) inline void each_link(const Work& work) {
  // Without initialisers: compilers store lists of addresses as data, which an image must not have.
  LinkParts parts;
  parts.link = ls.links;
  parts.points = ls.points;
  parts.rows = ls.rows;
  parts.entries = ls.entries;
  for (uint32_t i = 0; i < ls.job.link_count; ++i) {
    work(parts);
    const Link& link = *parts.link++;
    parts.points += link.points;
    parts.rows += link.rows;
    parts.entries += link.entries[0] + link.entries[1];
  }
}

/// Iterates until the error hardly changes any more.
void iterate(const Held& held) {
  constexpr float kDone = 0x1.5798eep-27f;  // 1e-8: share of the squared error of the first iteration
  float first = 0.0f;
  for (uint32_t i = 0; i < ls.job.iterations; ++i) {
    float error = 0.0f;
    each_link([&](const LinkParts& parts) __attribute__((always_inline)) {
      if (parts.link->once != 0 && i != 0) return;
      const float of_link = solve(parts, held);
      if (parts.link->once == 0 && of_link > error) error = of_link;
    });
    if (i == 0) first = error;
    if (!(error > kDone * first)) return;
  }
}

}  // namespace
}  // namespace softcell::spu

/// argp: effective address of an AttachJob. Returns an AttachStatus.
int main(uint64_t, uint64_t argp, uint64_t) {
  using namespace softcell::spu;
  mfc_get(&ls.job, argp, sizeof(AttachJob), kTagJob, 0, 0);
  wait_for_tag(kTagJob);
  if (!fits(ls.job) || !fetch()) return kAttachTooLarge;
  Held held;
  held.velocities = ls.velocities;
  held.pushes = ls.pushes;
  held.rigids = ls.rigids;
  iterate(held);
  if (ls.job.ends != 0)
    each_link([&](const LinkParts& parts) __attribute__((always_inline)) { limit_pushes(parts, held); });
  send();
  return kAttachDone;
}
