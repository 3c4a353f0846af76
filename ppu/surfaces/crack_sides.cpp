#include "ppu/surfaces/crack_sides.h"

#include <algorithm>

#include "ppu/fracture/cracks.h"
#include "ppu/numbers/disjoint_sets.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

/// Whether a particle of the face has been split in two.
template <int kDimension>
bool is_open(const Lattice<kDimension>& lattice, const CellFace& face) {
  const auto &low = lattice.corners[face.low], &high = lattice.corners[face.high];
  for (std::uint32_t k = 0; k < low.size(); ++k)
    if ((k >> face.axis & 1u) != 0 && low[k] != high[k & ~(1u << face.axis)]) return true;
  return false;
}

}  // namespace

template <int kDimension>
std::vector<std::uint32_t> crack_sides(const Lattice<kDimension>& lattice, const Cracks<kDimension>& cracks) {
  SC_ASSERT(cracks.faces.size() == cracks.is_broken.size(), "{} faces, of which {} may be broken",
            cracks.faces.size(), cracks.is_broken.size());
  std::vector<bool> at_crack(lattice.cells.size());
  for (std::size_t f = 0; f < cracks.faces.size(); ++f) {
    const CellFace& face = cracks.faces[f];
    if (cracks.is_broken[f] && is_open(lattice, face)) at_crack[face.low] = at_crack[face.high] = true;
  }
  if (std::ranges::find(at_crack, true) == at_crack.end()) return {};
  DisjointSets along(lattice.cells.size());
  for (std::size_t f = 0; f < cracks.faces.size(); ++f) {
    const CellFace& face = cracks.faces[f];
    if (!cracks.is_broken[f] && at_crack[face.low] && at_crack[face.high]) along.unite(face.low, face.high);
  }
  std::vector<std::uint32_t> sides(lattice.cells.size());
  for (std::uint32_t cell = 0; cell < sides.size(); ++cell)
    if (at_crack[cell]) sides[cell] = along.find(cell) + 1;
  return sides;
}

template std::vector<std::uint32_t> crack_sides(const Lattice<2>&, const Cracks<2>&);
template std::vector<std::uint32_t> crack_sides(const Lattice<3>&, const Cracks<3>&);

bool are_parted(const Lattice<3>& lattice, const std::vector<std::uint32_t>& sides, std::uint32_t a,
                std::uint32_t b) {
  if (sides.empty() || sides[a] == 0 || sides[b] == 0 || sides[a] == sides[b]) return false;
  const auto &of_a = lattice.corners[a], &of_b = lattice.corners[b];
  return std::ranges::find_first_of(of_a, of_b) == of_a.end();
}

}  // namespace softcell::ppu
