#include "ppu/matching/regions.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "softcell/base/assert.h"

namespace softcell::ppu {

Csr find_regions(const Csr& neighbours, int half_width) {
  if (half_width < 0 || half_width > kMaxHalfWidth)
    throw std::runtime_error("region half width " + std::to_string(half_width) + ": expected 0 to " +
                             std::to_string(kMaxHalfWidth));
  const auto particles = static_cast<std::uint32_t>(neighbours.size());
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
    if (regions.items.size() + found.size() > kMaxRegionMembers)
      throw std::runtime_error("regions of half width " + std::to_string(half_width) + " on a lattice of " +
                               std::to_string(particles) + " particles hold more than " +
                               std::to_string(kMaxRegionMembers) +
                               " entries; use a smaller half width or larger cells");
    std::sort(found.begin(), found.end());
    regions.push(found);
  }
  return regions;
}

}  // namespace softcell::ppu
