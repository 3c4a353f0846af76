#pragma once
// Coarser versions of a mesh that use its own vertices, for where its triangles are smaller than can be seen.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "softcell/render/renderer.h"

namespace softcell::render {

/// A version of a mesh.
struct MeshLevel {
  float spacing = 0;  ///< metres by which a vertex is moved at most, mostly along the surface
  float error = 0;    ///< metres by which vertices leave the surface, the root of the mean square
  std::vector<Triangle> triangles;  ///< of the mesh's own vertices
};

/// Joins vertices that share a cube of `spacing` a side and face the same octant. Planes keep triangles of about that size, because a
/// soft body bends: that is why no simplifier of a library is used here, which would leave out what is flat. Vertices at one place
/// stay together, so that creases do not open.
/// @param positions,normals  one of each for each vertex, finite; normals of any length
/// @param spacing            metres, above 0
/// @pre triangles have only vertices that there are
MeshLevel coarser(std::span<const Eigen::Vector3f> positions, std::span<const Eigen::Vector3f> normals,
                  std::span<const Triangle> triangles, float spacing);

/// Versions with fewer and fewer triangles, each at most 0.7 of those before it; none of a mesh that has few, or whose positions are
/// not finite.
std::vector<MeshLevel> coarser_levels(std::span<const Eigen::Vector3f> positions,
                                      std::span<const Eigen::Vector3f> normals,
                                      std::span<const Triangle> triangles);

}  // namespace softcell::render
