#pragma once
// The contract of the kernel `skin`: plain data in main memory, the same bytes for both sides.
// Freestanding; included by the kernel and by the PPU side. All scalars are in the machine's own byte order.

#include <stdint.h>

namespace softcell::spu {

/// Four mesh vertices of one lattice cell, one 128-byte line. The embedding packs each cell's vertices into
/// groups of four. The last group of a cell is filled up with copies of its last vertex.
struct alignas(128) SkinGroup {
  float xi[4];        ///< position in the cell along x, 0..1, one lane per vertex
  float eta[4];       ///< along y
  float zeta[4];      ///< along z
  float normal_x[4];  ///< rest normal, unit length
  float normal_y[4];
  float normal_z[4];
  /// The cell's corners as indices into the job's corner array; corner k = bx + 2 by + 4 bz.
  uint16_t corner[8];
  /// [0] is 1 if the group has the same eight corners as the group before it, else 0.
  uint16_t continues[8];
};
static_assert(sizeof(SkinGroup) == 128, "one line");

/// A particle's position, written by the PPU side.
struct alignas(16) SkinCorner {
  float x, y, z, pad;
};

/// A vertex to draw: half floats relative to the job's origin. 16 bytes; a group makes four of them.
struct alignas(16) SkinnedVertex {
  uint16_t position[4];  ///< x y z 1
  uint16_t normal[4];    ///< x y z 0, unit length
};

/// Most corners in one job: the kernel holds them all in local store.
constexpr uint32_t kSkinMaxCorners = 2048;

/// A contiguous run of corners in main memory.
struct SkinWindow {
  uint64_t ea;     ///< of the first SkinCorner, a multiple of 16
  uint32_t count;  ///< corners, 0..kSkinMaxCorners
  uint32_t pad;
};

/// The job's descriptor, one line in main memory.
struct alignas(128) SkinJob {
  uint64_t groups_ea;    ///< group_count SkinGroups, 128-byte aligned
  uint64_t vertices_ea;  ///< room for 4 * group_count SkinnedVertex, a multiple of 16 (128 is fastest)
  /// The job's corner array: window[0] followed by window[1], at most kSkinMaxCorners together.
  SkinWindow window[2];
  float origin[4];       ///< subtracted from every corner; x y z and 0
  uint32_t group_count;  ///< any number, 0 included
  uint32_t pad[15];
};
static_assert(sizeof(SkinJob) == 128, "one line");

/// What the kernel's main returns.
enum SkinStatus : uint32_t { kSkinDone = 0, kSkinTooManyCorners = 1 };

}  // namespace softcell::spu
