#include "softcell/soft_bodies/skin_2d.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include "ppu/lattice/cell_curves.h"
#include "ppu/lattice/cells_by_index.h"
#include "ppu/lattice/skin_field.h"
#include "softcell/base/assert.h"
#include "softcell/base/text.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Eigen::Vector2i;

constexpr std::uint32_t kNone = CellsByIndex::kNone;
constexpr int kSamples = SkinField::kSamples;

/// Cuts the field's shape into triangles, cell by cell. A cell that the edge passes through has kSamples x kSamples squares; every other
/// cell is one square.
class Mesher {
 public:
  /// @param light  gives the slopes: the field of the whole shape, if `field` is a part of it
  Mesher(SkinMap& map, const CellsByIndex& cells, const SkinField& field, const SkinField& light)
      : map_(map), cells_(cells), field_(field), light_(light), block_count_(field.size() / kSamples) {
    const auto samples =
        static_cast<std::size_t>(field.size().x()) * static_cast<std::size_t>(field.size().y());
    for (auto& vertices : vertex_at_) vertices.assign(samples, kNone);
  }

  Skin2d run(float spacing) {
    skin_.spacing = spacing;
    for (int x = 0; x < block_count_.x(); ++x) {
      for (int y = 0; y < block_count_.y(); ++y) {
        if (is_inside({x, y})) {
          add_whole({x, y});
        } else {
          add_in_squares({x, y});
        }
      }
    }
    chain_outlines();
    return std::move(skin_);
  }

 private:
  /// The place of a vertex: at a sample, or between it and the next one along x or y.
  enum Place : std::uint8_t { kAtSample, kAlongX, kAlongY };

  std::size_t slot(int x, int y) const {
    return static_cast<std::size_t>(x) * static_cast<std::size_t>(field_.size().y()) +
           static_cast<std::size_t>(y);
  }

  std::uint32_t add_vertex(const Vector2f& rest, const Vector2f& slope) {
    map_.add_vertex(skin_, cells_.nearest(rest), rest);
    skin_.slopes.push_back(slope);
    return static_cast<std::uint32_t>(skin_.rest.size() - 1);
  }

  std::uint32_t at_sample(int x, int y) {
    std::uint32_t& vertex = vertex_at_[kAtSample][slot(x, y)];
    if (vertex == kNone) vertex = add_vertex(field_.grid_position(x, y), light_.slope(x, y));
    return vertex;
  }

  /// The vertex at which the edge passes between two neighbouring samples.
  std::uint32_t crossing(const Vector2i& a, const Vector2i& b) {
    const bool along_x = a.x() != b.x();
    const Vector2i from = a.cwiseMin(b), to = a.cwiseMax(b);
    std::uint32_t& vertex = vertex_at_[along_x ? kAlongX : kAlongY][slot(from.x(), from.y())];
    if (vertex != kNone) return vertex;
    const float before = field_.at(from.x(), from.y()), behind = field_.at(to.x(), to.y());
    // Kept away from the samples, so that no triangle has two vertices at one place.
    const float t = std::clamp((SkinField::kEdge - before) / (behind - before), 1.0f / 16, 15.0f / 16);
    vertex = add_vertex(
        (1 - t) * field_.grid_position(from.x(), from.y()) + t * field_.grid_position(to.x(), to.y()),
        (1 - t) * light_.slope(from.x(), from.y()) + t * light_.slope(to.x(), to.y()));
    return vertex;
  }

  bool is_inside(const Vector2i& block) const {
    if ((block.array() < 0).any() || (block.array() >= block_count_.array()).any()) return false;
    for (int x = 0; x <= kSamples; ++x) {
      for (int y = 0; y <= kSamples; ++y) {
        if (!field_.contains(kSamples * block.x() + x, kSamples * block.y() + y)) return false;
      }
    }
    return true;
  }

  void add_triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c, const Vector2i& block) {
    const Vector2i cell = field_.origin() + block;
    const std::uint32_t own = cells_.number(cell);
    const Vector2f middle = (skin_.rest[a] + skin_.rest[b] + skin_.rest[c]) / 3;
    skin_.triangles.push_back({a, b, c});
    skin_.cells.push_back(own != kNone ? own : cells_.nearest(middle));
  }

  /// Adds a cell that no edge passes through. It includes the vertices of neighbouring cells in squares, so that no gap opens.
  void add_whole(const Vector2i& block) {
    constexpr std::array<std::array<int, 2>, 4> kSteps{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
    constexpr std::array<std::array<int, 2>, 4> kBeside{{{0, -1}, {1, 0}, {0, 1}, {-1, 0}}};
    ring_.clear();
    Vector2i at = kSamples * block;
    for (std::size_t side = 0; side < 4; ++side) {
      const Vector2i step(kSteps[side][0], kSteps[side][1]);
      const bool coarse = is_inside(block + Vector2i(kBeside[side][0], kBeside[side][1]));
      for (int i = 0; i < kSamples; ++i) {
        if (i == 0 || !coarse) ring_.push_back(at_sample(at.x(), at.y()));
        at += step;
      }
    }
    if (ring_.size() == 4) {
      add_triangle(ring_[0], ring_[1], ring_[2], block);
      add_triangle(ring_[0], ring_[2], ring_[3], block);
      return;
    }
    const std::uint32_t middle =
        at_sample(kSamples * block.x() + kSamples / 2, kSamples * block.y() + kSamples / 2);
    for (std::size_t i = 0; i < ring_.size(); ++i)
      add_triangle(middle, ring_[i], ring_[(i + 1) % ring_.size()], block);
  }

  void add_in_squares(const Vector2i& block) {
    for (int x = kSamples * block.x(); x < kSamples * (block.x() + 1); ++x) {
      for (int y = kSamples * block.y(); y < kSamples * (block.y() + 1); ++y) add_square({x, y}, block);
    }
  }

  /// The part of a square between four samples that lies inside: marching squares.
  void add_square(const Vector2i& low, const Vector2i& block) {
    const std::array<Vector2i, 4> corners{low, low + Vector2i(1, 0), low + Vector2i(1, 1),
                                          low + Vector2i(0, 1)};
    std::array<bool, 4> inside{};
    for (std::size_t i = 0; i < 4; ++i) inside[i] = field_.contains(corners[i].x(), corners[i].y());
    const auto count = std::count(inside.begin(), inside.end(), true);
    if (count == 0) return;
    if (count == 2 && inside[0] == inside[2]) {  // opposite corners: two pieces
      for (std::size_t i = inside[0] ? 0 : 1; i < 4; i += 2) {
        const Vector2i &corner = corners[i], &next = corners[(i + 1) % 4], &before = corners[(i + 3) % 4];
        const std::uint32_t out = crossing(corner, next), in = crossing(before, corner);
        add_triangle(at_sample(corner.x(), corner.y()), out, in, block);
        next_on_outline_.push_back({out, in});
      }
      return;
    }
    ring_.clear();
    std::uint32_t out = kNone, in = kNone;  // where the square's boundary leaves the shape and comes back
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t next = (i + 1) % 4;
      if (inside[i]) ring_.push_back(at_sample(corners[i].x(), corners[i].y()));
      if (inside[i] == inside[next]) continue;
      ring_.push_back(crossing(corners[i], corners[next]));
      (inside[i] ? out : in) = ring_.back();
    }
    for (std::size_t i = 2; i < ring_.size(); ++i) add_triangle(ring_[0], ring_[i - 1], ring_[i], block);
    if (out != kNone) next_on_outline_.push_back({out, in});
  }

  void chain_outlines() {
    std::sort(next_on_outline_.begin(), next_on_outline_.end());
    std::vector<bool> used(next_on_outline_.size());
    for (std::size_t start = 0; start < next_on_outline_.size(); ++start) {
      if (used[start]) continue;
      std::vector<std::uint32_t>& loop = skin_.outlines.emplace_back();
      for (std::size_t at = start; !used[at];) {
        used[at] = true;
        loop.push_back(next_on_outline_[at][0]);
        const auto next = std::lower_bound(next_on_outline_.begin(), next_on_outline_.end(),
                                           std::array<std::uint32_t, 2>{next_on_outline_[at][1], 0});
        SC_ASSERT(next != next_on_outline_.end() && (*next)[0] == next_on_outline_[at][1],
                  "an outline ends at vertex {}", next_on_outline_[at][1]);
        at = static_cast<std::size_t>(next - next_on_outline_.begin());
      }
    }
  }

  SkinMap& map_;
  const CellsByIndex& cells_;
  const SkinField& field_;
  const SkinField& light_;
  Vector2i block_count_;
  Skin2d skin_;
  std::array<std::vector<std::uint32_t>, 3> vertex_at_;  // by Place and sample
  std::vector<std::uint32_t> ring_;
  std::vector<std::array<std::uint32_t, 2>> next_on_outline_;  // from one vertex to the next
};

}  // namespace

namespace {

SkinField field_of(const CellsByIndex& cells, float margin, const Outside2d& outside) {
  if (!(margin >= 0 && margin <= kMaxSkinMargin))
    throw std::invalid_argument("a skin with a margin of " + base::shortest(margin) +
                                " cells; expected 0 to " + base::shortest(kMaxSkinMargin));
  return outside ? SkinField::of_shape(cells, margin, outside) : SkinField::of_cells(cells, margin);
}

/// A shape that cells only approximate shows no stairs, however it is deformed.
std::unique_ptr<SkinMap> map_of(const Lattice<2>& lattice, const Outside2d& outside) {
  if (outside) return std::make_unique<MeanMap>(lattice);
  return std::make_unique<CellCurves>(lattice);
}

}  // namespace

void validate(const Skin2d& skin, const Lattice<2>& lattice) {
  const auto refuse = [&](const std::string& what, const std::string& of_lattice) {
    throw std::invalid_argument("a skin was made for another lattice: it has " + what +
                                ", and the lattice has " + of_lattice);
  };
  if (skin.spacing != lattice.spacing)
    refuse("cells of " + base::shortest(skin.spacing) + " m",
           "cells of " + base::shortest(lattice.spacing) + " m");
  for (const std::uint32_t cell : skin.vertex_cells)
    if (cell >= lattice.cells.size())
      refuse("a cell of number " + std::to_string(cell), std::to_string(lattice.cells.size()) + " cells");
  for (const Pull2d& pull : skin.pulls)
    if (pull.particle >= lattice.particles.size())
      refuse("a particle of number " + std::to_string(pull.particle),
             std::to_string(lattice.particles.size()) + " particles");
}

Skin2d make_skin_2d(const Lattice<2>& lattice, float margin, const Outside2d& outside) {
  const CellsByIndex cells(lattice);
  const SkinField field = field_of(cells, margin, outside);
  const auto map = map_of(lattice, outside);
  return Mesher(*map, cells, field, field).run(lattice.spacing);
}

std::vector<Skin2d> make_skin_parts_2d(const Lattice<2>& lattice, float margin, const Outside2d& outside,
                                       std::span<const std::uint32_t> parts) {
  SC_ASSERT(parts.size() == lattice.cells.size(), "{} parts of {} cells", parts.size(), lattice.cells.size());
  const CellsByIndex cells(lattice);
  const SkinField all = field_of(cells, margin, outside);
  const auto map = map_of(lattice, outside);
  const std::uint32_t count = 1 + *std::ranges::max_element(parts);
  std::vector<Skin2d> skins;
  // Makes each part from what it and those above it cover, minus what those above it cover: so no gaps are left where three parts meet.
  std::vector<bool> above(parts.size(), true);
  SkinField covered = all;
  for (std::uint32_t part = 0; part < count; ++part) {
    for (std::size_t cell = 0; cell < parts.size(); ++cell) above[cell] = parts[cell] > part;
    const SkinField next = all.part(above);
    skins.push_back(Mesher(*map, cells, covered.without(next), all).run(lattice.spacing));
    covered.take(next);
  }
  return skins;
}

Skin2d make_cover_2d(const Lattice<2>& lattice, const std::function<bool(const Vector2i&)>& drawn) {
  SC_ASSERT(static_cast<bool>(drawn), "nobody says what is drawn of {} cells", lattice.cells.size());
  constexpr int kSquares = 3;  // along a cell's edge, as the cell bends
  const CellsByIndex cells(lattice);
  CellCurves curves(lattice);
  Skin2d skin;
  skin.spacing = lattice.spacing;
  const Vector2i low = cells.low() - Vector2i::Ones(), high = cells.high() + Vector2i::Ones();
  const Vector2i size = kSquares * (high - low + Vector2i::Ones()) + Vector2i::Ones();
  std::vector<std::uint32_t> vertex_at(
      static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()), kNone);
  const auto corner = [&](const Vector2i& at) {
    std::uint32_t& vertex = vertex_at[static_cast<std::size_t>(at.x()) * static_cast<std::size_t>(size.y()) +
                                      static_cast<std::size_t>(at.y())];
    if (vertex == kNone) {
      const Vector2f rest = low.cast<float>() + at.cast<float>() / kSquares;
      vertex = static_cast<std::uint32_t>(skin.rest.size());
      curves.add_vertex(skin, cells.nearest(rest), rest);
      skin.slopes.push_back(Vector2f::Zero());
    }
    return vertex;
  };
  const auto is_near = [&](const Vector2i& cell) {
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        if (cells.has(cell + Vector2i(x, y))) return true;
      }
    }
    return false;
  };
  for (int x = low.x(); x <= high.x(); ++x) {
    for (int y = low.y(); y <= high.y(); ++y) {
      const Vector2i cell(x, y);
      if (!cells.has(cell) && !(is_near(cell) && drawn(cell))) continue;
      const std::uint32_t nearest = cells.nearest(cell.cast<float>() + Vector2f::Constant(0.5f));
      for (int square = 0; square < kSquares * kSquares; ++square) {
        const Vector2i at = kSquares * (cell - low) + Vector2i(square % kSquares, square / kSquares);
        const std::uint32_t first = corner(at), across = corner(at + Vector2i(1, 1));
        const std::uint32_t right = corner(at + Vector2i(1, 0)), above = corner(at + Vector2i(0, 1));
        for (const auto& triangle : {std::array{first, right, across}, std::array{first, across, above}}) {
          skin.triangles.push_back(triangle);
          skin.cells.push_back(nearest);
        }
      }
    }
  }
  return skin;
}

CellPoint2d point_in_cell(const Lattice<2>& lattice, std::uint32_t cell, const Vector2f& at) {
  SC_ASSERT(cell < lattice.cells.size(), "cell {} of {}", cell, lattice.cells.size());
  const Vector2f in = at - lattice.cells[cell].cast<float>();
  const float x = in.x(), y = in.y();
  return {lattice.corners[cell], {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y}};
}

CellPoint2d point_in_cells(const Lattice<2>& lattice, const Vector2f& at) {
  const CellsByIndex cells(lattice);
  return point_in_cell(lattice, cells.nearest(at), at);
}

void deform(const Skin2d& skin, std::span<const Vector2f> particles, std::span<Vector2f> positions,
            std::span<Vector2f> slopes) {
  SC_ASSERT(positions.size() == skin.rest.size() && slopes.size() == skin.rest.size(),
            "room for {} positions and {} slopes of {} vertices", positions.size(), slopes.size(),
            skin.rest.size());
  for (std::size_t i = 0; i < skin.rest.size(); ++i) {
    Vector2f position = Vector2f::Zero(), x = Vector2f::Zero(), y = Vector2f::Zero();
    for (std::uint32_t k = skin.first_pull[i]; k < skin.first_pull[i + 1]; ++k) {
      const Pull2d& pull = skin.pulls[k];
      SC_ASSERT(pull.particle < particles.size(), "vertex {} is pulled by particle {} of {}", i,
                pull.particle, particles.size());
      const Vector2f& particle = particles[pull.particle];
      position += pull.share * particle;
      x += pull.along_x * particle;
      y += pull.along_y * particle;
    }
    positions[i] = position;
    // Slopes transform as normals do: by the cofactors of the cell's deformation.
    const Vector2f& slope = skin.slopes[i];
    slopes[i] =
        Vector2f(y.y() * slope.x() - x.y() * slope.y(), x.x() * slope.y() - y.x() * slope.x()) / skin.spacing;
  }
}

}  // namespace softcell::ppu
