#include "ppu/fracture/cell_faces.h"

#include <algorithm>
#include <utility>

#include "ppu/lattice/links.h"
#include "ppu/lattice/locate.h"
#include "ppu/numbers/disjoint_sets.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

constexpr std::uint32_t kNone = ~0u;

/// Visits the corners of a face: their numbers in the low cell, and in the high cell, where the bit of the axis is 0.
template <int kDimension, class Work>
void for_each_corner(const CellFace& face, const Work& work) {
  const unsigned bit = 1u << face.axis;
  for (unsigned k = 0; k < Lattice<kDimension>::kCorners; ++k)
    if ((k & bit) != 0) work(k, k & ~bit);
}

/// For each corner of each cell, numbered kCorners cell + corner: the set of corners that are one particle.
template <int kDimension>
DisjointSets corners_that_hold(const Lattice<kDimension>& lattice, std::span<const CellFace> faces,
                               const std::vector<bool>& broken) {
  constexpr auto kCorners = static_cast<std::uint32_t>(Lattice<kDimension>::kCorners);
  DisjointSets corners(kCorners * lattice.cells.size());
  std::vector<bool> is_touched(lattice.particles.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (!broken[f]) continue;
    for_each_corner<kDimension>(faces[f], [&](unsigned low, unsigned high) {
      is_touched[lattice.corners[faces[f].low][low]] = is_touched[lattice.corners[faces[f].high][high]] =
          true;
    });
  }
  for (std::size_t f = 0; f < faces.size(); ++f) {
    if (broken[f]) continue;
    for_each_corner<kDimension>(faces[f], [&](unsigned low, unsigned high) {
      corners.unite(kCorners * faces[f].low + low, kCorners * faces[f].high + high);
    });
  }
  std::vector<std::uint32_t> first(lattice.particles.size(), kNone);
  for (std::uint32_t c = 0; c < lattice.cells.size(); ++c)
    for (std::uint32_t k = 0; k < kCorners; ++k) {
      const std::uint32_t particle = lattice.corners[c][k];
      if (is_touched[particle]) continue;
      if (first[particle] == kNone) first[particle] = kCorners * c + k;
      corners.unite(first[particle], kCorners * c + k);
    }
  return corners;
}

/// The cells of each piece, ascending.
template <int kDimension>
std::vector<std::vector<std::uint32_t>> cells_of_pieces(const Lattice<kDimension>& lattice,
                                                        DisjointSets& corners) {
  constexpr auto kCorners = static_cast<std::uint32_t>(Lattice<kDimension>::kCorners);
  const auto count = static_cast<std::uint32_t>(lattice.cells.size());
  DisjointSets cells(count);
  for (std::uint32_t i = 0; i < kCorners * count; ++i) cells.unite(i / kCorners, corners.find(i) / kCorners);
  std::vector<std::vector<std::uint32_t>> pieces;
  std::vector<std::uint32_t> piece_of(count, kNone);
  for (std::uint32_t c = 0; c < count; ++c) {
    std::uint32_t& piece = piece_of[cells.find(c)];
    if (piece == kNone) {
      piece = static_cast<std::uint32_t>(pieces.size());
      pieces.emplace_back();
    }
    pieces[piece].push_back(c);
  }
  const auto largest = std::max_element(pieces.begin(), pieces.end(),
                                        [](const auto& a, const auto& b) { return a.size() < b.size(); });
  std::rotate(pieces.begin(), largest, largest + 1);
  return pieces;
}

}  // namespace

template <int kDimension>
std::vector<CellFace> faces_of(const Lattice<kDimension>& lattice) {
  using GridIndex = typename Lattice<kDimension>::GridIndex;
  std::vector<CellFace> faces;
  for (std::uint32_t c = 0; c < lattice.cells.size(); ++c)
    for (std::uint32_t axis = 0; axis < kDimension; ++axis)
      if (const auto next =
              find_cell<kDimension>(lattice, lattice.cells[c] + GridIndex(GridIndex::Unit(axis))))
        faces.push_back({c, *next, axis});
  return faces;
}

template <int kDimension>
std::vector<LatticePiece<kDimension>> split(const Lattice<kDimension>& lattice,
                                            std::span<const CellFace> faces,
                                            const std::vector<bool>& broken) {
  constexpr auto kCorners = static_cast<std::uint32_t>(Lattice<kDimension>::kCorners);
  SC_ASSERT(broken.size() == faces.size(), "{} of {} faces are broken or not", broken.size(), faces.size());
  DisjointSets corners = corners_that_hold(lattice, faces, broken);
  std::vector<LatticePiece<kDimension>> pieces;
  for (std::vector<std::uint32_t>& cells : cells_of_pieces(lattice, corners)) {
    LatticePiece<kDimension>& piece = pieces.emplace_back();
    piece.lattice.spacing = lattice.spacing;
    piece.lattice.origin = lattice.origin;
    // Particles are sorted by their numbers in the whole, copies by the cells that have them.
    // Number in the whole; the corner that represents the particle.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> particles;
    for (const std::uint32_t c : cells)
      for (std::uint32_t k = 0; k < kCorners; ++k)
        if (const std::uint32_t corner = kCorners * c + k; corners.find(corner) == corner)
          particles.emplace_back(lattice.corners[c][k], corner);
    std::sort(particles.begin(), particles.end());
    for (const auto& [particle, corner] : particles) {
      piece.lattice.particles.push_back(lattice.particles[particle]);
      piece.particle_of.push_back(particle);
    }
    const auto number_of = [&](std::uint32_t c, std::uint32_t k) {
      const std::pair<std::uint32_t, std::uint32_t> wanted(lattice.corners[c][k],
                                                           corners.find(kCorners * c + k));
      const auto found = std::lower_bound(particles.begin(), particles.end(), wanted);
      SC_ASSERT(found != particles.end() && *found == wanted, "corner {} of cell {} is no particle", k, c);
      return static_cast<std::uint32_t>(found - particles.begin());
    };
    for (const std::uint32_t c : cells) {
      piece.lattice.cells.push_back(lattice.cells[c]);
      piece.lattice.fill.push_back(lattice.fill[c]);
      auto& own = piece.lattice.corners.emplace_back();
      for (std::uint32_t k = 0; k < kCorners; ++k) own[k] = number_of(c, k);
    }
    piece.lattice.neighbours = find_neighbours(piece.lattice);
    piece.cell_of = std::move(cells);
  }
  return pieces;
}

template std::vector<CellFace> faces_of(const Lattice<2>&);
template std::vector<CellFace> faces_of(const Lattice<3>&);
template std::vector<LatticePiece<2>> split(const Lattice<2>&, std::span<const CellFace>,
                                            const std::vector<bool>&);
template std::vector<LatticePiece<3>> split(const Lattice<3>&, std::span<const CellFace>,
                                            const std::vector<bool>&);

}  // namespace softcell::ppu
