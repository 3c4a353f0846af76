#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "ppu/lattice/cell_curves.h"
#include "ppu/lattice/locate.h"
#include "ppu/numbers/disjoint_sets.h"
#include "softcell/base/assert.h"
#include "softcell/soft_bodies/skin_2d.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;

constexpr std::uint32_t kNowhere = std::numeric_limits<std::uint32_t>::max();

/// Makes the skin of one piece.
///
/// Each triangle of the whole's skin belongs to one cell, and goes to that cell's piece. Two triangles with a common side stay joined if
/// their cells do: then the corners at the side's ends stay one vertex. So a vertex of the whole becomes one vertex for each fan of
/// triangles around it.
class PieceSkinMaker {
 public:
  PieceSkinMaker(const Skin2d& whole, const Lattice<2>& lattice, const Lattice<2>& piece)
      : whole_(whole), lattice_(lattice), piece_(piece), curves_(piece) {
    for (const auto& cell : lattice.cells) cells_.push_back(find_cell<2>(piece, cell).value_or(kNowhere));
  }

  Skin2d run() {
    skin_.spacing = whole_.spacing;
    for (std::uint32_t t = 0; t < whole_.triangles.size(); ++t)
      if (cells_[whole_.cells[t]] != kNowhere) taken_.push_back(t);
    fans_.reset(3 * taken_.size());
    unite_corners();
    add_vertices();
    if (!whole_.outlines.empty()) add_outlines();
    return std::move(skin_);
  }

 private:
  std::uint32_t vertex_of(std::uint32_t corner) const {
    return whole_.triangles[taken_[corner / 3]][corner % 3];
  }
  std::uint32_t cell_of(std::uint32_t corner) const { return whole_.cells[taken_[corner / 3]]; }

  /// Whether two cells of the piece still share all particles that they shared in the whole.
  bool hold(std::uint32_t a, std::uint32_t b) const {
    const auto in_common = [](const auto& of_a, const auto& of_b) {
      return std::count_if(of_a.begin(), of_a.end(), [&](std::uint32_t particle) {
        return std::find(of_b.begin(), of_b.end(), particle) != of_b.end();
      });
    };
    return a == b || in_common(piece_.corners[cells_[a]], piece_.corners[cells_[b]]) ==
                         in_common(lattice_.corners[a], lattice_.corners[b]);
  }

  void unite_corners() {
    // Maps the ends of a side in the whole, in the direction of one triangle, to this triangle's corner at the begin.
    std::map<std::array<std::uint32_t, 2>, std::uint32_t> begins;
    for (std::uint32_t corner = 0; corner < fans_.numbers(); ++corner)
      begins.emplace(std::array{vertex_of(corner), vertex_of(next(corner))}, corner);
    for (const auto& [side, corner] : begins) {
      const auto other = begins.find({side[1], side[0]});
      if (side[0] > side[1] || other == begins.end() || !hold(cell_of(corner), cell_of(other->second)))
        continue;
      fans_.unite(corner, next(other->second));
      fans_.unite(next(corner), other->second);
    }
  }
  /// The next corner of the same triangle.
  static std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

  /// Chooses a cell for each vertex: the one to which the vertex belongs in the whole, else the nearest.
  void add_vertices() {
    std::map<std::uint32_t, std::uint32_t> cell_of_set;
    for (std::uint32_t corner = 0; corner < fans_.numbers(); ++corner) {
      const auto [found, is_first] = cell_of_set.try_emplace(fans_.find(corner), cell_of(corner));
      if (!is_first && is_better(vertex_of(corner), cell_of(corner), found->second))
        found->second = cell_of(corner);
    }
    std::map<std::uint32_t, std::uint32_t> number_of_set;
    for (const auto& [set, cell] : cell_of_set) {
      number_of_set.emplace(set, static_cast<std::uint32_t>(skin_.rest.size()));
      const std::uint32_t vertex = vertex_of(set);
      curves_.add_vertex(skin_, cells_[cell], whole_.rest[vertex]);
      skin_.slopes.push_back(whole_.slopes[vertex]);
    }
    for (std::uint32_t corner = 0; corner < fans_.numbers(); corner += 3) {
      auto& triangle = skin_.triangles.emplace_back();
      for (std::uint32_t k = 0; k < 3; ++k) triangle[k] = number_of_set.at(fans_.find(corner + k));
      skin_.cells.push_back(cells_[cell_of(corner)]);
    }
  }
  bool is_better(std::uint32_t vertex, std::uint32_t cell, std::uint32_t than) const {
    const std::uint32_t of_whole = whole_.vertex_cells[vertex];
    if (cell == of_whole || than == of_whole) return cell == of_whole;
    return distance(vertex, cell) < distance(vertex, than);
  }
  float distance(std::uint32_t vertex, std::uint32_t cell) const {
    const Vector2f in = whole_.rest[vertex] - lattice_.cells[cell].cast<float>();
    return (-in).cwiseMax(in - Vector2f::Ones()).cwiseMax(Vector2f::Zero()).squaredNorm();
  }

  /// Outlines consist of sides of one triangle only, in its direction. One of them begins at each vertex, as a vertex's triangles form one
  /// fan.
  void add_outlines() {
    std::set<std::array<std::uint32_t, 2>> sides;
    for (const auto& triangle : skin_.triangles)
      for (std::size_t k = 0; k < 3; ++k) sides.insert({triangle[k], triangle[(k + 1) % 3]});
    std::map<std::uint32_t, std::uint32_t> next_on_outline;
    for (const auto& side : sides)
      if (!sides.contains({side[1], side[0]})) next_on_outline.emplace(side[0], side[1]);
    while (!next_on_outline.empty()) {
      std::vector<std::uint32_t>& loop = skin_.outlines.emplace_back();
      for (auto at = next_on_outline.begin(); at != next_on_outline.end();) {
        loop.push_back(at->first);
        const std::uint32_t to = at->second;
        next_on_outline.erase(at);
        at = next_on_outline.find(to);
        SC_ASSERT(at != next_on_outline.end() || to == loop.front(), "an outline ends at vertex {}", to);
      }
    }
  }

  const Skin2d& whole_;
  const Lattice<2>& lattice_;
  const Lattice<2>& piece_;
  CellCurves curves_;
  std::vector<std::uint32_t> cells_;  // for each cell of the whole: its number in the piece, or kNowhere
  std::vector<std::uint32_t> taken_;  // triangles of the whole that this piece has
  // For each corner of these, 3 triangle + corner: the set of corners that are one vertex. The lowest corner represents it.
  DisjointSets fans_;
  Skin2d skin_;
};

}  // namespace

Skin2d skin_of_piece(const Skin2d& whole, const Lattice<2>& lattice, const Lattice<2>& piece) {
  SC_ASSERT(whole.cells.size() == whole.triangles.size() && piece.cells.size() <= lattice.cells.size(),
            "a piece of {} cells of {}", piece.cells.size(), lattice.cells.size());
  return PieceSkinMaker(whole, lattice, piece).run();
}

}  // namespace softcell::ppu
