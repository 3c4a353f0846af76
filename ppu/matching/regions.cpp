#include "ppu/matching/regions.h"

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

/// A lower bound for the members of all regions, from one search over the lattice. A region is a cube of (2 k + 1)^3 particles after k
/// rounds if all particles that it grew from have the 26 neighbours of a particle inside a lattice. In two dimensions no particle has so
/// many, and the bound is the number of particles.
std::uint64_t least_members(const Csr& neighbours, int half_width) {
  constexpr std::size_t kNeighboursInside = 26;
  // Links to the next particle that has fewer neighbours, at most half_width.
  std::vector<int> depth(neighbours.size(), half_width);
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < neighbours.size(); ++i) {
    if (neighbours[i].size() >= kNeighboursInside) continue;
    depth[i] = 0;
    found.push_back(i);
  }
  for (std::size_t f = 0; f < found.size(); ++f) {
    for (const std::uint32_t next : neighbours[found[f]]) {
      SC_ASSERT(next < depth.size(), "particle {} has neighbour {} of {}", found[f], next, depth.size());
      if (depth[next] <= depth[found[f]] + 1) continue;
      depth[next] = depth[found[f]] + 1;
      found.push_back(next);
    }
  }
  std::uint64_t members = 0;
  for (const int links : depth) {
    const auto edge = static_cast<std::uint64_t>(2 * links + 1);
    members += edge * edge * edge;
  }
  return members;
}

}  // namespace

Csr find_regions(const Csr& neighbours, int half_width) {
  if (half_width < 0 || half_width > kMaxHalfWidth)
    throw std::runtime_error("region half width " + std::to_string(half_width) + ": expected 0 to " +
                             std::to_string(kMaxHalfWidth));
  const auto particles = static_cast<std::uint32_t>(neighbours.size());
  const auto check_members = [&](std::uint64_t members) {
    if (members <= kMaxRegionMembers) return;
    throw std::runtime_error("regions of half width " + std::to_string(half_width) + " on a lattice of " +
                             std::to_string(particles) + " particles hold more than " +
                             std::to_string(kMaxRegionMembers) +
                             " entries; use a smaller half width or larger cells");
  };
  // Refuses most lattices that are too large before that takes seconds and memory.
  check_members(least_members(neighbours, half_width));
  Csr regions;
  std::vector<std::uint32_t> visited(particles, particles);  // the last centre whose search came here
  std::vector<std::uint32_t> found;
  for (std::uint32_t centre = 0; centre < particles; ++centre) {
    found.assign(1, centre);
    visited[centre] = centre;
    std::size_t ring = 0;  // found[ring..] are the particles of the last round
    for (int round = 0; round < half_width && ring < found.size(); ++round) {
      const std::size_t end = found.size();
      for (; ring < end; ++ring) {
        for (const std::uint32_t next : neighbours[found[ring]]) {
          SC_ASSERT(next < particles, "particle {} has neighbour {} of {}", found[ring], next, particles);
          if (visited[next] == centre) continue;
          visited[next] = centre;
          found.push_back(next);
        }
      }
    }
    check_members(regions.items.size() + found.size());
    std::sort(found.begin(), found.end());
    regions.push(found);
  }
  return regions;
}

}  // namespace softcell::ppu
