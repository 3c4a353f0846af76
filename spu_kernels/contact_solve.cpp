// contact_solve: solves contacts of soft bodies with each other, with rigid bodies and with things that nothing moves.  [Cat05]
//
//   array       direction  element                        count          alignment
//   job         in         SolveJob, 128 bytes            1              128
//   tasks       in         SolveTask, 128 bytes           any            128
//   velocities  in, out    SolveVelocity, 16 bytes        of two bodies  16
//   contacts    in, out    SolveContact, 176 bytes        <= 512         16
//   rigids      in, out    SolveRigid, 224 bytes          <= 64          16
//   cells       in         SolveCell, 16 bytes            <= 1024        16
//   positions   in         x y z and anything, 16 bytes   <= 1023        16
//   start       in         SolveVelocity, 16 bytes        <= 1023        16
//
// A task keeps two bodies and all contacts between them in the local store during all its iterations. The kernel does the tasks of a job
// in order, so a task may have a body of an earlier one.
//
// Budget: 192 KB. Contacts 88 KB, or cells and positions in their place; velocities and pushes of two bodies 64 KB; rigid bodies 14 KB;
// the rest for code and 4 KB of stack.
//
// Compiles unchanged with a real SPU g++ (7 to 9, -std=c++17).

#include <spu_intrinsics.h>
#include <spu_mfcio.h>

#include "common/dma.h"
#include "contact_solve_job.h"
#include "contacts/sequential_impulses.h"
#include "contacts/stiffening.h"

namespace softcell::spu {
namespace {

enum Tag : uint32_t { kTagIn = 0, kTagOut = 1, kTagTask = 2 };

struct Stiffening {
  vec_ushort8 cells[kSolveMaxCells];
  vec_float4 positions[kSolveMaxParticles + 1];
  vec_float4 start[kSolveMaxParticles + 1];
};

/// Everything this kernel keeps in local store beside its code and stack.
struct alignas(128) LocalStoreMap {
  SolveJob job;
  SolveTask task;
  alignas(128) vec_float4 a[solve_slots(kSolveMaxParticles)];
  alignas(128) vec_float4 b[solve_slots(kSolveMaxParticles)];
  alignas(128) HeldRigid rigids[kSolveMaxRigids];
  union alignas(128) {
    SolvedContact contacts[kSolveMaxContacts];
    Stiffening stiffening;
  };
};
LocalStoreMap ls;

bool fits(const SolveTask& task) {
  return task.a_count <= kSolveMaxParticles && task.b_count <= kSolveMaxParticles &&
         task.contact_count <= kSolveMaxContacts && task.rigid_count <= kSolveMaxRigids &&
         task.cell_count <= kSolveMaxCells;
}

/// Velocities, and pushes only where somebody pushes.
inline uint32_t bytes_of(uint32_t particles, bool pushes) {
  return (pushes ? solve_slots(particles) : particles + 1) * 16;
}

template <With kWith>
void solve(const SolveTask& task, vec_float4* a, vec_float4* b) {
  vec_float4* const pushes_a = a + task.a_count + 1;
  vec_float4* const pushes_b = b + task.b_count + 1;
  for (uint32_t i = 0; i < task.iterations; ++i)
    for (uint32_t c = 0; c < task.contact_count; ++c)
      solve_velocities<kWith>(ls.contacts[c], a, b, ls.rigids);
  if (task.pushes == 0) return;
  for (uint32_t i = 0; i < task.iterations; ++i)
    for (uint32_t c = 0; c < task.contact_count; ++c)
      if (spu_extract(ls.contacts[c].terms, 2) > 0.0f) solve_push<kWith>(ls.contacts[c], pushes_a, pushes_b);
}

void solve_contacts(const SolveTask& task) {
  const bool pushes = task.pushes != 0, two = task.b_ea != 0, itself = task.b_ea == task.a_ea;
  const uint32_t bytes = task.contact_count * static_cast<uint32_t>(sizeof(SolvedContact));
  const uint32_t bytes_of_rigids = task.rigid_count * static_cast<uint32_t>(sizeof(SolveRigid));
  get_large(ls.contacts, task.contacts_ea, bytes, kTagIn);
  get_large(ls.rigids, task.rigids_ea, bytes_of_rigids, kTagIn);
  if (two && !itself) get_large(ls.b, task.b_ea, bytes_of(task.b_count, pushes), kTagIn);
  wait_for_tag(kTagIn);
  if (task.rigid_count != 0)
    solve<With::kRigid>(task, ls.a, ls.b);
  else if (two)
    solve<With::kSoft>(task, ls.a, itself ? ls.a : ls.b);
  else
    solve<With::kNothingThatMoves>(task, ls.a, ls.b);
  put_large(ls.contacts, task.contacts_ea, bytes, kTagOut);
  put_large(ls.rigids, task.rigids_ea, bytes_of_rigids, kTagOut);
  if (two && !itself && task.b_sleeps == 0)
    put_large(ls.b, task.b_ea, bytes_of(task.b_count, pushes), kTagOut);
  wait_for_tag(kTagOut);
}

void stiffen_cells(const SolveTask& task) {
  get_large(ls.stiffening.cells, task.cells_ea, task.cell_count * 16, kTagIn);
  get_large(ls.stiffening.positions, task.positions_ea, task.a_count * 16, kTagIn);
  get_large(ls.stiffening.start, task.start_ea, task.a_count * 16, kTagIn);
  wait_for_tag(kTagIn);
  for (uint32_t i = 0; i < task.cell_count; ++i)
    stiffen(ls.stiffening.cells[i], ls.a, ls.stiffening.start, ls.stiffening.positions, task.stiffening,
            task.inverse_spacing);
}

void do_task(const SolveTask& task) {
  if (task.contact_count == 0 && task.cell_count == 0) return;
  const uint32_t bytes = bytes_of(task.a_count, task.pushes != 0);
  get_large(ls.a, task.a_ea, bytes, kTagIn);
  if (task.contact_count != 0) solve_contacts(task);
  if (task.cell_count != 0) stiffen_cells(task);
  if (task.a_sleeps != 0) return;
  put_large(ls.a, task.a_ea, bytes, kTagOut);
  wait_for_tag(kTagOut);
}

}  // namespace
}  // namespace softcell::spu

/// argp: effective address of a SolveJob. Returns a SolveStatus.
int main(uint64_t, uint64_t argp, uint64_t) {
  using namespace softcell::spu;
  mfc_get(&ls.job, argp, sizeof(SolveJob), kTagTask, 0, 0);
  wait_for_tag(kTagTask);
  for (uint32_t i = 0; i < ls.job.task_count; ++i) {
    mfc_get(&ls.task, ls.job.tasks_ea + i * sizeof(SolveTask), sizeof(SolveTask), kTagTask, 0, 0);
    wait_for_tag(kTagTask);
    if (!fits(ls.task)) return kSolveTooLarge;
    do_task(ls.task);
  }
  return kSolveDone;
}
