#pragma once
// The contract of the kernel `contact_find`: plain data in main memory, the same bytes for both sides.
// Freestanding; included by the kernel and by the PPU side. All scalars are in the machine's own byte order.

#include <stdint.h>

#include "contact_solve_job.h"

namespace softcell::spu {

/// A cell of a model: its corners, the points in it that touch, and the distance from the surface at rest.
struct alignas(16) FindCell {
  uint16_t corner[8];                 ///< particles; corner k = bx + 2 by + 4 bz
  int16_t grid[4];                    ///< place in the lattice, x y z and 0
  uint16_t first_group, group_count;  ///< its FindGroups
  uint16_t inner_cell;                ///< has a place well inside of the body, near this cell; or kFindNoCell
  uint16_t inner_node;                ///< the place: x + 4 y + 16 z of its 3 x 3 x 3 nodes
  /// In the cell no distance is less than least.xyz . (xi - 1/2) + least.w.
  float least[4];
  float field[28];  ///< distances at 3 x 3 x 3 nodes, in cells, below 0 inside; x fastest; the last is 0
};
static_assert(sizeof(FindCell) == 160, "ten quadwords");

constexpr uint16_t kFindNoCell = 0xFFFF;

/// Four points that touch, in one cell. A group that is not full has points whose allowance is kFindNoPoint.
struct alignas(16) FindGroup {
  float along_x[4], along_y[4], along_z[4];  ///< xi - 1/2 in the cell: -1/2..1/2, a lane to a point
  float allowance[4];                        ///< metres: how deep in others a point may be
};
static_assert(sizeof(FindGroup) == 64, "four quadwords");
constexpr float kFindNoPoint = 0x1.93e594p+99f;  // 1e30

/// The boxes of four cells of a body, at the step's end. The last group is filled up with copies of the last cell.
struct alignas(16) FindBoxes {
  float low_x[4], low_y[4], low_z[4];
  float high_x[4], high_y[4], high_z[4];
};

/// The position of a particle at the step's beginning, and the root of its inverse mass, which is 0 if nothing moves it.
struct alignas(16) FindBegin {
  float x, y, z, root;
};
/// The position of a particle at the end of the step if there were no contacts.
struct alignas(16) FindEnd {
  float x, y, z, zero;
};

struct FindBody {
  uint64_t cells_ea;   ///< cell_count FindCell, of the model
  uint64_t groups_ea;  ///< group_count FindGroup, of the model
  /// Of the body: (cell_count + 3) / 4 FindBoxes, particle_count FindEnd, and as many FindBegin.
  uint64_t state_ea;
  uint32_t cell_count, group_count, particle_count;
  float spacing;    ///< of cells, metres
  float middle[4];  ///< metres, about: of the box around the body; x y z 0
  uint32_t pad[2];
};
static_assert(sizeof(FindBody) == 64, "half a line");

/// Up to four groups of points of a cell, and a cell of the other body that is near them.
struct FindCandidate {
  uint16_t cell;       ///< the cell that has the points
  uint16_t other;      ///< the cell of the other body
  uint16_t first;      ///< number of the first of four groups
  uint16_t of_groups;  ///< bit i: group first + i is near; kFindOfB: `cell` belongs to b, and `other` to a
};
static_assert(sizeof(FindCandidate) == 8, "half a quadword");
constexpr uint16_t kFindOfB = 0x8000;

/// A task finds the points of a in b, then those of b in a; or the points of a body in the body itself. All contacts are as seen from a.
///
/// It works in two steps: it finds candidates by bounds, and then contacts among them. Candidates can be used again as long as
/// nothing in one body has moved by more than `margin` against anything in the other since they were found.
struct alignas(128) FindTask {
  FindBody a, b;           ///< equal if the task is about one body with itself
  uint64_t candidates_ea;  ///< room for kFindMaxCandidates FindCandidate; 0: the kernel writes none
  /// How many candidates are known from a task before; kFindUnknown: the kernel looks for them.
  uint32_t candidate_count;
  float margin;           ///< metres, 0 or more: of candidates that the kernel looks for
  float low[4], high[4];  ///< the box that both bodies' ends have in common; x y z 0
  float step;             ///< seconds
  float inverse_step;
  float friction;
  uint32_t itself;  ///< not 0: a and b are one body
  uint32_t pad[16];
};
static_assert(sizeof(FindTask) == 256, "two lines");

enum FindOverflow : uint32_t {
  kFindNoOverflow = 0,
  kFindTooMany = 1,    ///< there is no room for all cells that are near, or for all contacts
  kFindJobIsFull = 2,  ///< earlier tasks of the job have left too little room for contacts
};

struct alignas(16) FindResult {
  uint32_t count;     ///< number of contacts; they lie after those of the job's earlier tasks
  uint32_t pushes;    ///< not 0: at least one contact pushes
  uint32_t overflow;  ///< a FindOverflow; if it is not kFindNoOverflow, there are no contacts
  /// How many there are at candidates_ea; kFindUnknown: the margin was too large, or there are more than fit.
  uint32_t candidate_count;
};
constexpr uint32_t kFindUnknown = 0xFFFFFFFFu;

constexpr uint32_t kFindMaxContacts = 256;  ///< of a task
/// Most bytes of a task: of its two models, or one, and of its bodies.
constexpr uint32_t kFindMaxBytes = 151552;
constexpr uint32_t kFindMaxParticles = 1024;
constexpr uint32_t kFindMaxNear = 240;  ///< cells of one body that are near another body
constexpr uint32_t kFindMaxCandidates = 448;

/// Bytes of FindBody::state_ea.
inline uint32_t find_state_bytes(const FindBody& body) {
  return (body.cell_count + 3) / 4 * static_cast<uint32_t>(sizeof(FindBoxes)) +
         body.particle_count * static_cast<uint32_t>(sizeof(FindEnd) + sizeof(FindBegin));
}
/// Bytes of its FindCells and FindGroups.
inline uint32_t find_model_bytes(const FindBody& body) {
  return body.cell_count * static_cast<uint32_t>(sizeof(FindCell)) +
         body.group_count * static_cast<uint32_t>(sizeof(FindGroup));
}
/// All bytes that a task needs. Two bodies of one model share its bytes.
inline uint32_t find_bytes(const FindTask& task) {
  const uint32_t first = find_model_bytes(task.a) + find_state_bytes(task.a);
  if (task.itself != 0) return first;
  return first + (task.a.cells_ea == task.b.cells_ea ? 0 : find_model_bytes(task.b)) +
         find_state_bytes(task.b);
}

/// The job's descriptor, one line in main memory.
struct alignas(128) FindJob {
  uint64_t tasks_ea;       ///< task_count FindTask
  uint64_t results_ea;     ///< room for a FindResult of each
  uint64_t contacts_ea;    ///< room for contacts_room SolveContact of all tasks
  uint32_t task_count;     ///< any number, 0 included
  uint32_t contacts_room;  ///< any number; kFindMaxContacts for each task are enough
  uint32_t pad[24];
};
static_assert(sizeof(FindJob) == 128, "one line");

/// Depth in cells at rest: a deeper point leaves by the face by which it has come in (contacts/entered_face.h).
constexpr float kFindDeep = 0x1.99999ap-4f;  // 0.1
/// Distance in cells: a point that comes nearer than this in a step is in contact.
constexpr float kFindNear = 0.005f;
/// Distance in cells: a body does not touch itself in cells whose middles are nearer than this at rest.
constexpr int32_t kFindApart = 3;
/// A depth of up to kFindSlop cells is not corrected. Of a greater depth, a step removes the share kFindPushShare of the excess, and no
/// more than kFindMostPush cells.
constexpr float kFindSlop = 0.01f, kFindPushShare = 0x1.99999ap-4f, kFindMostPush = 0.02f;  // 0.1

/// What the kernel's main returns.
enum FindStatus : uint32_t { kFindDone = 0, kFindTooLarge = 1 };

}  // namespace softcell::spu
