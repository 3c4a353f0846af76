#pragma once
// Embeds a mesh in a lattice: finds each vertex's cell and its place in the cell, packed for the kernel skin.

#include <span>
#include <vector>

#include "ppu/lattice/locate.h"
#include "skin_job.h"
#include "softcell/soft_bodies/lattice.h"

namespace softcell::ppu {

/// The part of a body that one skin job works on: groups [first_group, first_group + group_count) and the
/// particles it reads as at most two contiguous runs. `SkinGroup::corner` of those groups counts through
/// window 0, then window 1.
struct SkinPart {
  std::uint32_t first_group = 0;
  std::uint32_t group_count = 0;
  struct Run {
    std::uint32_t first_particle = 0;
    std::uint32_t count = 0;
  } window[2];

  /// The number of the particle that corner index `corner` of this part stands for.
  std::uint32_t particle(std::uint32_t corner) const {
    return corner < window[0].count ? window[0].first_particle + corner
                                    : window[1].first_particle + (corner - window[0].count);
  }
};

/// The most groups in one part: 2880 vertices, 90 KB in and 45 KB out. Small enough that six SPEs share one body (a mesh of 35,000 vertices
/// makes some 13 parts, two for each). Large compared with the up to 32 KB of corners that every part fetches for itself, and with the
/// start of a job: with 512, skinning took some 5 % longer.
inline constexpr std::uint32_t kMaxPartGroups = 720;

/// Shared by all bodies of one model, immutable.
struct Embedding {
  std::vector<spu::SkinGroup> groups;  ///< sorted by part, then by cell
  std::vector<SkinPart> parts;         ///< cover all groups, in order
  /// Mesh vertex -> output slot 4 * group + lane (the vertex's own slot, not a repeat).
  std::vector<std::uint32_t> slot_of_vertex;
  std::vector<std::uint32_t> vertex_of_slot;  ///< output slot -> mesh vertex; repeats included
  TriangleMesh mesh;                          ///< as passed to embed()
  std::vector<std::uint32_t> indices;  ///< three output slots per mesh triangle: the index buffer for drawing
};

/// @pre  `lattice` covers `mesh`, as voxelize() makes it.
/// @throws std::runtime_error  a vertex lies in no cell, or one layer of the lattice cannot be cut into jobs.
Embedding embed(const TriangleMesh& mesh, const Lattice<3>& lattice);
/// The same with a given place for each vertex: in a lattice with cracks, the place in space does not determine the cell.
Embedding embed(const TriangleMesh& mesh, std::span<const PlaceInCell> places, const Lattice<3>& lattice);

}  // namespace softcell::ppu
