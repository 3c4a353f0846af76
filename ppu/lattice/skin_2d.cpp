#include "softcell/soft_bodies/skin_2d.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Eigen::Vector2i;

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// A lattice's cells by their grid index.
class CellsByIndex {
 public:
  explicit CellsByIndex(const Lattice<2>& lattice) : lattice_(lattice) {
    SC_ASSERT(!lattice.cells.empty(), "a lattice of {} particles has no cells", lattice.particles.size());
    low_ = high_ = lattice.cells.front();
    for (const Vector2i& cell : lattice.cells) {
      low_ = low_.cwiseMin(cell);
      high_ = high_.cwiseMax(cell);
    }
    const Vector2i size = high_ - low_ + Vector2i::Ones();
    numbers_.resize(static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()), kNone);
    for (std::uint32_t i = 0; i < lattice.cells.size(); ++i) numbers_[slot(lattice.cells[i])] = i;
  }

  const Vector2i& low() const { return low_; }    ///< the lowest index of a cell
  const Vector2i& high() const { return high_; }  ///< the highest

  /// The cell's number, or kNone.
  std::uint32_t number(const Vector2i& cell) const {
    if ((cell.array() < low_.array()).any() || (cell.array() > high_.array()).any()) return kNone;
    return numbers_[slot(cell)];
  }
  bool has(const Vector2i& cell) const { return number(cell) != kNone; }

  /// How far a point, in grid coordinates, is from a cell.
  static float distance(const Vector2i& cell, const Vector2f& at) {
    const Vector2f low = cell.cast<float>();
    return (low - at).cwiseMax(at - low - Vector2f::Ones()).cwiseMax(Vector2f::Zero()).norm();
  }

  /// The number of the cell that is nearest to the point, the first of those that are as near.
  std::uint32_t nearest(const Vector2f& at) const {
    const Vector2i around = at.array().floor().matrix().cast<int>();
    std::uint32_t found = kNone;
    float least = 1;  // cells as far as that may lie beyond those that are tried first
    const auto consider = [&](std::uint32_t cell) {
      const float away = distance(lattice_.cells[cell], at);
      if (away < least || (away == least && cell < found)) {
        least = away;
        found = cell;
      }
    };
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        if (const std::uint32_t cell = number(around + Vector2i(x, y)); cell != kNone) consider(cell);
      }
    }
    if (found != kNone) return found;
    least = std::numeric_limits<float>::infinity();
    for (std::uint32_t cell = 0; cell < lattice_.cells.size(); ++cell) consider(cell);
    return found;
  }

 private:
  std::size_t slot(const Vector2i& cell) const {
    const Vector2i from_low = cell - low_;
    const auto height = static_cast<std::size_t>(high_.y() - low_.y() + 1);
    return static_cast<std::size_t>(from_low.x()) * height + static_cast<std::size_t>(from_low.y());
  }

  const Lattice<2>& lattice_;
  Vector2i low_, high_;
  std::vector<std::uint32_t> numbers_;
};

CellPoint2d point_of(const Lattice<2>& lattice, std::uint32_t cell, const Vector2f& at) {
  const Vector2f in = at - lattice.cells[cell].cast<float>();
  const float x = in.x(), y = in.y();
  return {lattice.corners[cell], {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y}};
}

constexpr int kSamples = 4;  // of the field along an edge of a cell
constexpr int kPadding = 2;  // cells around the lattice in which the field is sampled

/// A smooth function over the lattice's plane, above kEdge inside of the shape that is drawn. Sampled at
/// kSamples points a cell, in rows of y.
class Field {
 public:
  static constexpr float kEdge = 0.5f;

  Field(const CellsByIndex& cells, float margin)
      : cells_(cells),
        origin_(cells.low() - Vector2i::Constant(kPadding)),
        size_(kSamples * (cells.high() - cells.low() + Vector2i::Constant(2 * kPadding + 1)) +
              Vector2i::Ones()) {
    values_.resize(static_cast<std::size_t>(size_.x()) * static_cast<std::size_t>(size_.y()));
    for (int x = 0; x < size_.x(); ++x) {
      for (int y = 0; y < size_.y(); ++y) value(x, y) = covered({x, y}, margin);
    }
    // A standard deviation of six tenths of a cell makes any stairs smooth. What is not wider than that needs
    // less.
    const int passes = margin >= 0.35f ? 6 : 2;
    for (int pass = 0; pass < passes; ++pass) {
      smooth(0);
      smooth(1);
    }
    open_gaps();
  }

  const Vector2i& origin() const { return origin_; }  ///< grid index of sample (0, 0)
  const Vector2i& size() const { return size_; }      ///< samples
  bool contains(int x, int y) const { return value(x, y) >= kEdge; }
  float at(int x, int y) const { return value(x, y); }
  /// Against the gradient, per cell: towards the edge.
  Vector2f slope(int x, int y) const {
    const auto clamped = [&](int i, int j) {
      return value(std::clamp(i, 0, size_.x() - 1), std::clamp(j, 0, size_.y() - 1));
    };
    return 0.5f * kSamples *
           Vector2f(clamped(x - 1, y) - clamped(x + 1, y), clamped(x, y - 1) - clamped(x, y + 1));
  }
  Vector2f grid_position(int x, int y) const {
    return origin_.cast<float>() + Vector2f(static_cast<float>(x), static_cast<float>(y)) * (1.0f / kSamples);
  }

 private:
  std::size_t slot(int x, int y) const {
    return static_cast<std::size_t>(x) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(y);
  }
  float& value(int x, int y) { return values_[slot(x, y)]; }
  float value(int x, int y) const { return values_[slot(x, y)]; }

  /// The cell that begins at a sample or the last one before.
  Vector2i cell_of(const Vector2i& sample) const { return origin_ + sample / kSamples; }

  /// Whether a sample lies within the cells, wider by the margin: 0 or 1, and between near the edge.
  float covered(const Vector2i& sample, float margin) const {
    const Vector2f position = grid_position(sample.x(), sample.y());
    const Vector2i cell = cell_of(sample);
    float away = 2;
    bool all_around = true;
    for (int x = -1; x <= 1; ++x) {
      for (int y = -1; y <= 1; ++y) {
        const Vector2i other = cell + Vector2i(x, y);
        const float distance = CellsByIndex::distance(other, position);
        const bool here = cells_.has(other);
        if (here) away = std::min(away, distance);
        if (!here && distance == 0) all_around = false;
      }
    }
    return all_around ? 1 : std::clamp(0.5f + (margin - away) * kSamples, 0.0f, 1.0f);
  }

  /// Replaces each sample by the binomial mean of five along `axis`: a standard deviation of one sample.
  void smooth(int axis) {
    const int length = size_[axis], lines = size_[1 - axis];
    const auto sample = [&](int line, int i) -> float& {
      return axis == 0 ? value(i, line) : value(line, i);
    };
    line_.assign(static_cast<std::size_t>(length) + 4, 0.0f);
    for (int line = 0; line < lines; ++line) {
      for (int i = 0; i < length; ++i) line_[static_cast<std::size_t>(i) + 2] = sample(line, i);
      for (int i = 0; i < length; ++i) {
        const float* const from = line_.data() + i;
        sample(line, i) = (from[0] + from[4] + 4 * (from[1] + from[3]) + 6 * from[2]) * 0.0625f;
      }
    }
  }

  /// Whether a free cell has cells on both sides of it along an axis.
  bool is_gap(const Vector2i& cell, const Vector2i& axis) const {
    return !cells_.has(cell) && cells_.has(cell - axis) && cells_.has(cell + axis);
  }

  /// Keeps both sides of a gap of one cell apart, however wide the margin. A mere notch, one cell deep, is filled.
  void open_gaps() {
    constexpr float kHalfGap = 0.12f, kSteepness = 0.65f;
    for (int x = 0; x < size_.x(); ++x) {
      for (int y = 0; y < size_.y(); ++y) {
        const Vector2i cell = cell_of({x, y});
        if (cells_.has(cell)) continue;
        const Vector2f middle = grid_position(x, y) - cell.cast<float>() - Vector2f::Constant(0.5f);
        const auto keep_open = [&](const Vector2i& axis, float from_middle) {
          const Vector2i along(axis.y(), axis.x());
          const bool here = is_gap(cell, axis), before = is_gap(cell - along, axis),
                     behind = is_gap(cell + along, axis);
          // Or beyond the end of one: the margins of its sides would close it there.
          const bool end =
              (before && is_gap(cell - 2 * along, axis)) || (behind && is_gap(cell + 2 * along, axis));
          if ((here && (before || behind)) || end)
            value(x, y) = std::min(value(x, y), kEdge + kSteepness * (std::abs(from_middle) - kHalfGap));
        };
        keep_open({1, 0}, middle.x());
        keep_open({0, 1}, middle.y());
      }
    }
  }

  const CellsByIndex& cells_;
  Vector2i origin_, size_;
  std::vector<float> values_;
  std::vector<float> line_;  // what smooth() works on
};

/// Cuts the field's shape into triangles, cell by cell. Where the edge passes, a cell has kSamples x kSamples squares;
/// elsewhere it is one.
class Mesher {
 public:
  Mesher(const Lattice<2>& lattice, const CellsByIndex& cells, const Field& field)
      : lattice_(lattice), cells_(cells), field_(field), block_count_(field.size() / kSamples) {
    const auto samples =
        static_cast<std::size_t>(field.size().x()) * static_cast<std::size_t>(field.size().y());
    for (auto& vertices : vertex_at_) vertices.assign(samples, kNone);
    skin_.spacing = lattice.spacing;
  }

  Skin2d run() {
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
  /// Where a vertex is: at a sample, or between it and the next one along x or y.
  enum Place : std::uint8_t { kAtSample, kAlongX, kAlongY };

  std::size_t slot(int x, int y) const {
    return static_cast<std::size_t>(x) * static_cast<std::size_t>(field_.size().y()) +
           static_cast<std::size_t>(y);
  }

  std::uint32_t add_vertex(const Vector2f& rest, const Vector2f& slope) {
    skin_.vertices.push_back(point_of(lattice_, cells_.nearest(rest), rest));
    skin_.rest.push_back(rest);
    skin_.slopes.push_back(slope);
    return static_cast<std::uint32_t>(skin_.vertices.size() - 1);
  }

  std::uint32_t at_sample(int x, int y) {
    std::uint32_t& vertex = vertex_at_[kAtSample][slot(x, y)];
    if (vertex == kNone) vertex = add_vertex(field_.grid_position(x, y), field_.slope(x, y));
    return vertex;
  }

  /// Where the edge passes between two samples beside each other.
  std::uint32_t crossing(const Vector2i& a, const Vector2i& b) {
    const bool along_x = a.x() != b.x();
    const Vector2i from = a.cwiseMin(b), to = a.cwiseMax(b);
    std::uint32_t& vertex = vertex_at_[along_x ? kAlongX : kAlongY][slot(from.x(), from.y())];
    if (vertex != kNone) return vertex;
    const float before = field_.at(from.x(), from.y()), behind = field_.at(to.x(), to.y());
    // Off the samples, so that no triangle has two vertices at one place.
    const float t = std::clamp((Field::kEdge - before) / (behind - before), 1.0f / 16, 15.0f / 16);
    vertex = add_vertex(
        (1 - t) * field_.grid_position(from.x(), from.y()) + t * field_.grid_position(to.x(), to.y()),
        (1 - t) * field_.slope(from.x(), from.y()) + t * field_.slope(to.x(), to.y()));
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

  /// A cell that no edge passes. Beside cells in squares it has their vertices, so that no gap opens.
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
    if (count == 2 && inside[0] == inside[2]) {  // corners across: two pieces
      for (std::size_t i = inside[0] ? 0 : 1; i < 4; i += 2) {
        const Vector2i &corner = corners[i], &next = corners[(i + 1) % 4], &before = corners[(i + 3) % 4];
        const std::uint32_t out = crossing(corner, next), in = crossing(before, corner);
        add_triangle(at_sample(corner.x(), corner.y()), out, in, block);
        next_on_outline_.push_back({out, in});
      }
      return;
    }
    ring_.clear();
    std::uint32_t out = kNone, in = kNone;  // where the edge of the square leaves the shape and comes back
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

  const Lattice<2>& lattice_;
  const CellsByIndex& cells_;
  const Field& field_;
  Vector2i block_count_;
  Skin2d skin_;
  std::array<std::vector<std::uint32_t>, 3> vertex_at_;  // by Place and sample
  std::vector<std::uint32_t> ring_;
  std::vector<std::array<std::uint32_t, 2>> next_on_outline_;  // from one vertex to the next
};

}  // namespace

Skin2d make_skin_2d(const Lattice<2>& lattice, float margin) {
  SC_ASSERT(margin >= 0 && margin <= kMaxSkinMargin, "a margin of {} cells", margin);
  const CellsByIndex cells(lattice);
  const Field field(cells, margin);
  return Mesher(lattice, cells, field).run();
}

Skin2d make_cover_2d(const Lattice<2>& lattice, const std::function<bool(const Vector2i&)>& drawn) {
  SC_ASSERT(static_cast<bool>(drawn), "nobody says what is drawn of {} cells", lattice.cells.size());
  const CellsByIndex cells(lattice);
  Skin2d skin;
  skin.spacing = lattice.spacing;
  const Vector2i low = cells.low() - Vector2i::Ones(), high = cells.high() + Vector2i::Ones();
  std::vector<std::uint32_t> vertex_at(
      static_cast<std::size_t>(high.x() - low.x() + 2) * static_cast<std::size_t>(high.y() - low.y() + 2),
      kNone);
  const auto add_vertex = [&](const Vector2f& rest) {
    skin.vertices.push_back(point_of(lattice, cells.nearest(rest), rest));
    skin.rest.push_back(rest);
    skin.slopes.push_back(Vector2f::Zero());
    return static_cast<std::uint32_t>(skin.vertices.size() - 1);
  };
  const auto corner = [&](int x, int y) {
    std::uint32_t& vertex =
        vertex_at[static_cast<std::size_t>(x - low.x()) * static_cast<std::size_t>(high.y() - low.y() + 2) +
                  static_cast<std::size_t>(y - low.y())];
    if (vertex == kNone) vertex = add_vertex({static_cast<float>(x), static_cast<float>(y)});
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
      const Vector2f middle = cell.cast<float>() + Vector2f::Constant(0.5f);
      const std::uint32_t nearest = cells.nearest(middle), centre = add_vertex(middle);
      const std::array<std::uint32_t, 4> ring{corner(x, y), corner(x + 1, y), corner(x + 1, y + 1),
                                              corner(x, y + 1)};
      for (std::size_t i = 0; i < 4; ++i) {
        skin.triangles.push_back({centre, ring[i], ring[(i + 1) % 4]});
        skin.cells.push_back(nearest);
      }
    }
  }
  return skin;
}

CellPoint2d point_in_cells(const Lattice<2>& lattice, const Vector2f& at) {
  const CellsByIndex cells(lattice);
  return point_of(lattice, cells.nearest(at), at);
}

void place(const Skin2d& skin, std::span<const Vector2f> particles, std::span<Vector2f> positions,
           std::span<Vector2f> slopes) {
  SC_ASSERT(positions.size() == skin.vertices.size() && slopes.size() == skin.vertices.size(),
            "room for {} positions and {} slopes of {} vertices", positions.size(), slopes.size(),
            skin.vertices.size());
  for (std::size_t i = 0; i < skin.vertices.size(); ++i) {
    const CellPoint2d& point = skin.vertices[i];
    positions[i] = point.at(particles);
    const auto& [a, b, c, d] = point.corner;
    // Slopes turn as normals do: by the cofactors of what stretches the cell.
    const Vector2f x = (particles[b] - particles[a]) + (particles[d] - particles[c]);
    const Vector2f y = (particles[c] - particles[a]) + (particles[d] - particles[b]);
    const Vector2f& slope = skin.slopes[i];
    slopes[i] = Vector2f(y.y() * slope.x() - x.y() * slope.y(), x.x() * slope.y() - y.x() * slope.x()) /
                (2 * skin.spacing);
  }
}

}  // namespace softcell::ppu
