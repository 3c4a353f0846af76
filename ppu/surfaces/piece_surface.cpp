// Derives the contact surface of a piece of a broken body from that of the whole.
//
// For a node inside of the whole, the nearest point of the piece's surface is either the nearest one of the whole's surface or lies on an
// open face of the piece, whichever is nearer. The reason: the ball around the node that touches the whole's surface holds nothing but
// solid, so any part of an open face in this ball is a cut, and the way to a part of the surface that is gone leads through a cut. So the
// distance is the smaller one of the two, and no triangle is looked at. The distance from a face is an integer's square root, as nodes and
// faces lie on one grid of half cells. Nodes outside of the solid are measured again where an open face is nearer than the whole's surface.
// (Where only cells of air lie between a node and a part that is gone, the node keeps its distance, which is too small.)

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "ppu/fracture/cracks.h"
#include "ppu/surfaces/contact_surface.h"
#include "ppu/surfaces/point_chooser.h"
#include "ppu/surfaces/triangle_distance.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

constexpr int kNodesPerCell = ContactSurface::kNodesPerEdge - 1;  // from one cell to the next
constexpr int kReachInNodes = static_cast<int>(ContactSurface::kReach) * kNodesPerCell;

/// A node 0..26 of a cell, x fastest, as steps from the cell's low corner.
Vector3i step_of(std::size_t node) {
  const auto n = static_cast<int>(node);
  return {n % 3, n / 3 % 3, n / 9};
}
std::size_t node_at(const Vector3i& step) {
  return static_cast<std::size_t>((step.z() * 3 + step.y()) * 3 + step.x());
}

/// Calls work(step) for the nine nodes of an open face, as steps from the cell's low corner.
template <typename Work>
void for_each_node_of(const OpenFace& face, const Work& work) {
  const auto axis = static_cast<int>(face.axis);
  for (int i = 0; i < 9; ++i) {
    Vector3i step;
    step[axis] = face.is_high ? kNodesPerCell : 0;
    step[(axis + 1) % 3] = i % 3;
    step[(axis + 2) % 3] = i / 3;
    work(step);
  }
}

/// Distances of the nodes in a box from open faces: squares of numbers of half cells, exact below kFar.
class SquareField {
 public:
  static constexpr std::uint8_t kFar = kReachInNodes * kReachInNodes;

  SquareField(const Vector3i& low, const Vector3i& high)
      : low_(low), counts_(high - low + Vector3i::Ones()), squares_(index_of(high) + 1, kUnset) {}

  std::uint8_t& at(const Vector3i& node) { return squares_[index_of(node)]; }

  /// Spreads distances from the faces' nodes, which have 0, to all others, axis by axis: squares along axes add up.
  void spread() {
    std::size_t stride = 1;
    for (int axis = 0; axis < 3; ++axis) {
      spread(stride, static_cast<std::size_t>(counts_[axis]));
      stride *= static_cast<std::size_t>(counts_[axis]);
    }
  }

 private:
  static constexpr std::uint8_t kUnset = 200;  // with three more squares added it is still below 256

  std::size_t index_of(const Vector3i& node) const {
    const Vector3i place = node - low_;
    return static_cast<std::size_t>((place.z() * counts_.y() + place.y()) * counts_.x() + place.x());
  }
  /// Spreads distances along an axis of `count` nodes that lie `stride` apart.
  void spread(std::size_t stride, std::size_t count) {
    before_ = squares_;
    for (std::size_t first = 0; first < squares_.size(); first += stride * count)
      for (int s = 1; s < kReachInNodes; ++s) {
        const auto steps = static_cast<std::size_t>(s);
        if (steps >= count) break;
        const std::size_t length = stride * (count - steps), ahead = stride * steps;
        for (std::size_t i = first; i < first + length; ++i) {
          squares_[i] = std::min(squares_[i], static_cast<std::uint8_t>(before_[i + ahead] + s * s));
          squares_[i + ahead] = std::min(squares_[i + ahead], static_cast<std::uint8_t>(before_[i] + s * s));
        }
      }
  }

  Vector3i low_, counts_;
  std::vector<std::uint8_t> squares_, before_;
};

/// Open faces are handled brick by brick, of so many cells along each axis: memory stays small however large a piece is.
constexpr int kBrick = 16;

/// A node of a cell that lies outside of the solid, near an open face.
struct NodeOutside {
  std::uint32_t cell = 0;
  std::size_t node = 0;
};

/// Turns the distances of a piece from those of the whole, which it starts with, into its own.
class FieldCutter {
 public:
  FieldCutter(const Lattice<3>& piece, const Cracks<3>& cracks,
              std::vector<ContactSurface::CellField>& fields)
      : piece_(piece),
        cracks_(cracks),
        fields_(fields),
        depths_(piece.particles.size(), kNoDepth),
        is_reached_(piece.cells.size()) {
    low_ = high_ = piece.cells.front();
    for (const Vector3i& cell : piece.cells) low_ = low_.cwiseMin(cell), high_ = high_.cwiseMax(cell);
  }

  void cut() {
    std::map<std::tuple<int, int, int>, std::vector<const OpenFace*>> bricks;
    for (const OpenFace& face : cracks_.open) {
      const Vector3i brick = (piece_.cells[face.cell] - low_) / kBrick;
      bricks[{brick.x(), brick.y(), brick.z()}].push_back(&face);
    }
    for (const auto& [brick, faces] : bricks) cut_around(faces);
    deepen();
  }

  /// Each node once for each cell that has it.
  std::span<const NodeOutside> outside() const { return outside_; }

 private:
  static constexpr float kNoDepth = std::numeric_limits<float>::max();

  void cut_around(const std::vector<const OpenFace*>& faces) {
    Vector3i low = piece_.cells[faces.front()->cell], high = low;
    for (const OpenFace* const face : faces) {
      low = low.cwiseMin(piece_.cells[face->cell]);
      high = high.cwiseMax(piece_.cells[face->cell]);
    }
    const Vector3i reach = Vector3i::Constant(kReachInNodes / kNodesPerCell);
    low = low_.cwiseMax(low - reach), high = high_.cwiseMin(high + reach);
    SquareField squares(kNodesPerCell * low, kNodesPerCell * (high + Vector3i::Ones()));
    for (const OpenFace* const face : faces)
      for_each_node_of(*face, [&](const Vector3i& step) {
        squares.at(kNodesPerCell * piece_.cells[face->cell] + step) = 0;
      });
    squares.spread();
    const auto first = std::lower_bound(piece_.cells.begin(), piece_.cells.end(), low.x(),
                                        [](const Vector3i& cell, int x) { return cell.x() < x; });
    for (auto cell = first; cell != piece_.cells.end() && cell->x() <= high.x(); ++cell)
      if ((cell->array() >= low.array()).all() && (cell->array() <= high.array()).all())
        cut_cell(static_cast<std::uint32_t>(cell - piece_.cells.begin()), squares);
  }

  void reach(std::uint32_t cell) {
    if (is_reached_[cell]) return;
    is_reached_[cell] = true;
    reached_.push_back(cell);
  }

  void cut_cell(std::uint32_t cell, SquareField& squares) {
    ContactSurface::CellField& field = fields_[cell];
    std::size_t n = 0;
    for (int z = 0; z <= kNodesPerCell; ++z)
      for (int y = 0; y <= kNodesPerCell; ++y)
        for (int x = 0; x <= kNodesPerCell; ++x, ++n) {
          const std::uint8_t square = squares.at(kNodesPerCell * piece_.cells[cell] + Vector3i(x, y, z));
          if (square >= SquareField::kFar) continue;
          const float depth = std::sqrt(static_cast<float>(square)) / kNodesPerCell;
          reach(cell);
          if (x != 1 && y != 1 && z != 1) {
            float& own = depths_[piece_.corners[cell][static_cast<std::size_t>(2 * z + y + x / 2)]];
            own = std::min(own, depth);
          }
          constexpr float kRounding = 1e-3f;
          if (field[n] <= 0)
            field[n] = std::max(field[n], -depth);
          else if (depth <= field[n] + kRounding)
            outside_.push_back({cell, n});
        }
  }

  /// Updates nodes too far from open faces for exact distances where these faces are nearer than the whole's surface. Counts steps from
  /// cell to cell.
  void deepen() {
    std::vector<std::array<std::uint32_t, 6>> next(piece_.cells.size(),
                                                   {kNone, kNone, kNone, kNone, kNone, kNone});
    for (const CellFace& face : cracks_.faces) {
      next[face.low][face.axis] = face.high;
      next[face.high][3 + face.axis] = face.low;
    }
    std::sort(reached_.begin(), reached_.end());
    const std::size_t near = reached_.size();
    for (std::size_t i = 0; i < reached_.size(); ++i) {
      const std::uint32_t cell = reached_[i];
      if (!deepen(cell) && i >= near) continue;
      for (const std::uint32_t other : next[cell])
        if (other != kNone) reach(other);
    }
  }

  /// @return whether a node has changed
  bool deepen(std::uint32_t cell) {
    std::array<float, 8> depths;
    for (std::size_t k = 0; k < 8; ++k) depths[k] = depths_[piece_.corners[cell][k]];
    const float one_more = *std::min_element(depths.begin(), depths.end()) + 1;
    for (std::size_t k = 0; k < 8; ++k)
      if (depths[k] == kNoDepth) depths[k] = depths_[piece_.corners[cell][k]] = one_more;
    bool changes = false;
    ContactSurface::CellField& field = fields_[cell];
    for (std::size_t n = 0; n < field.size(); ++n) {
      if (field[n] >= -ContactSurface::kReach) continue;
      const float own = -std::max(depth_at(n, depths), ContactSurface::kReach);
      changes = changes || field[n] < own;
      field[n] = std::max(field[n], own);
    }
    return changes;
  }

  /// The depth at a node of a cell, interpolated between the cell's corners.
  static float depth_at(std::size_t node, const std::array<float, 8>& of_corner) {
    const Vector3i step = step_of(node);
    float sum = 0;
    int count = 0;
    for (unsigned k = 0; k < 8; ++k) {
      bool counts = true;
      for (unsigned d = 0; d < 3; ++d) counts = counts && step[d] != ((k >> d & 1u) != 0 ? 0 : kNodesPerCell);
      if (counts) sum += of_corner[k], ++count;
    }
    return sum / static_cast<float>(count);
  }

  static constexpr std::uint32_t kNone = ~0u;

  const Lattice<3>& piece_;
  const Cracks<3>& cracks_;
  std::vector<ContactSurface::CellField>& fields_;
  Vector3i low_, high_;
  std::vector<float> depths_;  // of each particle: cells from the nearest open face
  std::vector<bool> is_reached_;
  std::vector<std::uint32_t> reached_;  // cells
  std::vector<NodeOutside> outside_;
};

/// Distances from the triangles of a mesh that lie near a box.
class NearTriangles {
 public:
  NearTriangles(const TriangleMesh& mesh, const Bounds<3>& box, float spacing) : spacing_(spacing) {
    const Vector3f reach = Vector3f::Constant(ContactSurface::kReach * spacing);
    const Vector3f low = box.low - reach, high = box.high + reach;
    TriangleMesh near;
    for (const auto& t : mesh.triangles) {
      const Vector3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
      if ((a.cwiseMax(b).cwiseMax(c).array() < low.array()).any() ||
          (a.cwiseMin(b).cwiseMin(c).array() > high.array()).any())
        continue;
      const auto first = static_cast<std::uint32_t>(near.positions.size());
      near.positions.insert(near.positions.end(), {a, b, c});
      near.triangles.push_back({first, first + 1, first + 2});
    }
    if (!near.triangles.empty()) grid_.emplace(near, spacing);
  }

  /// In cells, positive on both sides; at most the reach.
  float distance(const Vector3f& at) const {
    const float reach = ContactSurface::kReach * spacing_;
    return grid_ ? std::abs(grid_->signed_distance(at, reach)) / spacing_ : ContactSurface::kReach;
  }

 private:
  float spacing_;
  std::optional<TriangleGrid> grid_;
};

void measure_outside(std::span<const NodeOutside> nodes, const Lattice<3>& piece, const TriangleMesh& mesh,
                     std::vector<ContactSurface::CellField>& fields) {
  if (nodes.empty()) return;
  const auto index_of = [&](const NodeOutside& node) {
    return Vector3i(kNodesPerCell * piece.cells[node.cell] + step_of(node.node));
  };
  const auto place_of = [&](const NodeOutside& node) {
    return Vector3f(piece.origin + piece.spacing / kNodesPerCell * index_of(node).cast<float>());
  };
  Bounds<3> box{place_of(nodes.front()), place_of(nodes.front())};
  for (const NodeOutside& node : nodes)
    box = {box.low.cwiseMin(place_of(node)), box.high.cwiseMax(place_of(node))};
  const NearTriangles triangles(mesh, box, piece.spacing);
  std::unordered_map<std::uint64_t, float> known;
  for (const NodeOutside& node : nodes) {
    const auto [distance, is_new] = known.try_emplace(key_of(index_of(node)), 0);
    if (is_new) distance->second = triangles.distance(place_of(node));
    fields[node.cell][node.node] = distance->second;
  }
}

/// Chooses points on the cuts that close a piece: nodes of open faces well inside of the solid, and corners of the cuts where the surface
/// meets them.
class CutSampler {
 public:
  /// @param known  points of the piece that are the whole's, ascending by cell
  CutSampler(const ContactSurface& whole, const Lattice<3>& piece, const TriangleMesh& mesh,
             const Cracks<3>& cracks, std::span<const SurfacePointAtRest> known)
      : whole_(whole), piece_(piece), mesh_(mesh), cracks_(cracks), known_(known), rim_(piece.spacing) {}

  std::vector<SurfacePointAtRest> sample() {
    std::uint32_t last_rim = ~0u;
    for (const OpenFace& face : cracks_.open) {
      const ContactSurface::CellField& field = whole_.nodes(cracks_.cell_of_whole[face.cell]);
      bool is_rim = false;
      for_each_node_of(face, [&](const Vector3i& step) {
        if (field[node_at(step)] > -kInside)
          is_rim = true;
        else if (is_taken_.insert(key_of(kNodesPerCell * piece_.cells[face.cell] + step)).second)
          add(face.cell, step.cast<float>() / kNodesPerCell);
      });
      if (!is_rim) continue;
      if (face.cell != last_rim) avoid_known(face.cell);
      last_rim = face.cell;
      sample_rim(face);
    }
    return std::move(points_);
  }

 private:
  static constexpr float kInside = 0.25f;  // cells

  void add(std::uint32_t cell, const Vector3f& xi) {
    points_.push_back({cell, xi, piece_.origin + piece_.spacing * (piece_.cells[cell].cast<float>() + xi)});
  }

  void avoid_known(std::uint32_t cell) {
    const auto [first, end] = std::equal_range(
        known_.begin(), known_.end(), SurfacePointAtRest{cell},
        [](const SurfacePointAtRest& a, const SurfacePointAtRest& b) { return a.cell < b.cell; });
    for (auto point = first; point != end; ++point) rim_.choose(point->rest, Vector3f::Zero());
  }

  void sample_rim(const OpenFace& face) {
    const Vector3f normal = Vector3f((face.is_high ? 1.0f : -1.0f) * Vector3f(Vector3f::Unit(face.axis)));
    for (std::uint32_t t = face.first_triangle; t < face.first_triangle + face.triangle_count; ++t)
      for (const std::uint32_t vertex : mesh_.triangles[t]) {
        const Vector3f& at = mesh_.positions[vertex];
        const Vector3f xi = (at - piece_.origin) / piece_.spacing - piece_.cells[face.cell].cast<float>();
        if (rim_.choose(at, normal)) add(face.cell, xi.cwiseMax(0.0f).cwiseMin(1.0f));
      }
  }

  const ContactSurface& whole_;
  const Lattice<3>& piece_;
  const TriangleMesh& mesh_;
  const Cracks<3>& cracks_;
  std::span<const SurfacePointAtRest> known_;
  PointChooser rim_;
  std::unordered_set<std::uint64_t> is_taken_;  // nodes
  std::vector<SurfacePointAtRest> points_;
};

bool is_before(const SurfacePointAtRest& a, const SurfacePointAtRest& b) { return a.cell < b.cell; }

}  // namespace

ContactSurface::ContactSurface(const ContactSurface& whole, const Lattice<3>& piece, const TriangleMesh& mesh,
                               const Cracks<3>& cracks) {
  SC_ASSERT(cracks.whole != nullptr && cracks.cell_of_whole.size() == piece.cells.size(),
            "{} cells of a piece of {}", cracks.cell_of_whole.size(), piece.cells.size());
  fields_.reserve(piece.cells.size());
  for (std::uint32_t c = 0; c < piece.cells.size(); ++c) {
    const std::uint32_t of = cracks.cell_of_whole[c];
    fields_.push_back(whole.fields_[of]);
    for (auto point =
             std::lower_bound(whole.points_.begin(), whole.points_.end(), SurfacePointAtRest{of}, is_before);
         point != whole.points_.end() && point->cell == of; ++point)
      points_.push_back({c, point->xi, point->rest});
  }
  if (!cracks.open.empty()) {
    FieldCutter cutter(piece, cracks, fields_);
    cutter.cut();
    measure_outside(cutter.outside(), piece, mesh, fields_);
    std::vector<SurfacePointAtRest> cuts = CutSampler(whole, piece, mesh, cracks, points_).sample();
    const auto known = static_cast<std::ptrdiff_t>(points_.size());
    points_.insert(points_.end(), cuts.begin(), cuts.end());  // sorted by cell, as the open faces are
    std::inplace_merge(points_.begin(), points_.begin() + known, points_.end(), is_before);
  }
  allow_particles(piece);
}

}  // namespace softcell::ppu
