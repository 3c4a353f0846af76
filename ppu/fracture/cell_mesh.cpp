#include "ppu/fracture/cell_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include "ppu/fracture/cut_triangle.h"
#include "ppu/fracture/fill_loops.h"
#include "ppu/lattice/locate.h"
#include "ppu/mesh/position_numbers.h"
#include "ppu/numbers/hash_of_numbers.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Eigen::Vector3i;
using Eigen::Vector4f;

std::uint64_t edge_key(const Vector3i& corner, std::uint32_t axis) {
  constexpr int kOffset = 1 << 19;
  const auto part = [](int i) { return static_cast<std::uint64_t>(i + kOffset); };
  return (part(corner.x()) << 40 | part(corner.y()) << 20 | part(corner.z())) * 3 + axis;
}

std::uint32_t part_of(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto after =
      std::upper_bound(mesh.parts.begin(), mesh.parts.end(), triangle,
                       [](std::uint32_t t, const MeshPart& part) { return t < part.first_triangle; });
  return after == mesh.parts.begin() ? 0 : static_cast<std::uint32_t>(after - mesh.parts.begin() - 1);
}

}  // namespace

/// Fills a CellMesh.
class CellMesh::Maker {
 public:
  explicit Maker(CellMesh& made)
      : made_(made),
        mesh_(made.mesh_),
        lattice_(made.lattice_),
        position_number_(number_positions(mesh_.positions)) {
    low_ = high_ = lattice_.cells.front();
    for (const Vector3i& cell : lattice_.cells) low_ = low_.cwiseMin(cell), high_ = high_.cwiseMax(cell);
    for (const Vector3f& position : mesh_.positions) places_.push_back(place_of(position));
    vertex_of_corner_.assign(mesh_.positions.size(), kNone);
  }

  void make() {
    std::vector<std::pair<std::uint32_t, Triangle>> triangles;  // with their cells
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) add(t, triangles);
    std::stable_sort(triangles.begin(), triangles.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    made_.first_triangle_.assign(lattice_.cells.size() + 1, 0);
    for (const auto& [cell, triangle] : triangles) {
      ++made_.first_triangle_[cell + 1];
      made_.triangles_.push_back(triangle);
    }
    for (std::size_t c = 1; c < made_.first_triangle_.size(); ++c)
      made_.first_triangle_[c] += made_.first_triangle_[c - 1];
    std::stable_sort(made_.segments_.begin(), made_.segments_.end(),
                     [](const Segment& a, const Segment& b) { return a.face < b.face; });
    for (auto& [key, crossings] : made_.crossings_)
      std::sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
        return std::tuple(a.along, a.point) < std::tuple(b.along, b.point);
      });
    wind();
  }

 private:
  static constexpr std::uint32_t kNone = ~0u;

  /// The position in units, from the lattice's low corner, clamped to the lattice's box.
  UnitPoint place_of(const Vector3f& position) const {
    UnitPoint place;
    for (int d = 0; d < 3; ++d) {
      const double cells =
          (double{position[d]} - double{lattice_.origin[d]}) / double{lattice_.spacing} - low_[d];
      const double most = high_[d] - low_[d] + 1;
      const auto units =
          2 * static_cast<std::int64_t>(std::floor(std::clamp(cells, 0.0, most) * (kUnitsPerCell / 2))) + 1;
      place[static_cast<std::size_t>(d)] =
          std::clamp<std::int64_t>(units, 1, static_cast<std::int64_t>(most) * kUnitsPerCell - 1);
    }
    return place;
  }

  float on_plane(std::uint8_t axis, int plane) const {
    return lattice_.origin[axis] + lattice_.spacing * static_cast<float>(plane);
  }

  std::uint32_t add_vertex(std::uint32_t point, std::span<const std::pair<std::uint32_t, double>> shares) {
    TriangleMesh& to = made_.vertices_;
    const auto blend = [&](const auto& values, auto sum) {
      for (const auto& [vertex, share] : shares) sum += static_cast<float>(share) * values[vertex];
      return sum;
    };
    const auto number = static_cast<std::uint32_t>(to.positions.size());
    to.positions.push_back(made_.points_[point].position);
    const Vector3f normal = blend(mesh_.normals, Vector3f(Vector3f::Zero()));
    to.normals.push_back(normal.norm() > 1e-6f ? Vector3f(normal.normalized())
                                               : mesh_.normals[shares[0].first]);
    if (!mesh_.texture_coordinates.empty())
      to.texture_coordinates.push_back(blend(mesh_.texture_coordinates, Vector2f(Vector2f::Zero())));
    if (!mesh_.colours.empty()) to.colours.push_back(blend(mesh_.colours, Vector4f(Vector4f::Zero())));
    made_.point_of_vertex_.push_back(point);
    return number;
  }

  std::uint32_t add_point(const Vector3d& position, const CutVertex& cut) {
    Point& point = made_.points_.emplace_back();
    point.position = position.cast<float>();
    point.planes = cut.planes;
    point.axis = cut.axis;
    for (std::size_t i = 0; i < cut.planes; ++i) {
      point.plane[i] = cut.plane[i] + low_[cut.axis[i]];
      point.position[cut.axis[i]] = on_plane(cut.axis[i], point.plane[i]);
    }
    return static_cast<std::uint32_t>(made_.points_.size() - 1);
  }

  std::uint32_t corner(std::uint32_t vertex) {
    std::uint32_t& known = vertex_of_corner_[vertex];
    if (known != kNone) return known;
    const auto [point, is_new] = point_of_position_.try_emplace(position_number_[vertex], 0);
    if (is_new) {
      point->second = add_point(mesh_.positions[vertex].cast<double>(), {});
      made_.points_.back().position = mesh_.positions[vertex];
    }
    const std::pair<std::uint32_t, double> own{vertex, 1.0};
    return known = add_vertex(point->second, {&own, 1});
  }

  /// Gives the same bits for both triangles of the side, whatever direction they list it in.
  std::uint32_t on_side(std::uint32_t a, std::uint32_t b, const CutVertex& cut) {
    if (position_number_[a] > position_number_[b]) std::swap(a, b);
    const std::array<std::uint32_t, 4> key{a, b, cut.axis[0], static_cast<std::uint32_t>(cut.plane[0])};
    const auto [vertex, is_new] = vertex_on_side_.try_emplace(key, 0);
    if (!is_new) return vertex->second;
    const std::uint8_t e = cut.axis[0];
    const double share = static_cast<double>(cut.plane[0] * kUnitsPerCell - places_[a][e]) /
                         static_cast<double>(places_[b][e] - places_[a][e]);
    const auto [point, is_new_point] =
        point_on_side_.try_emplace({position_number_[a], position_number_[b], key[2], key[3]}, 0);
    if (is_new_point)
      point->second = add_point(
          (1 - share) * mesh_.positions[a].cast<double>() + share * mesh_.positions[b].cast<double>(), cut);
    const std::array<std::pair<std::uint32_t, double>, 2> shares{{{a, 1 - share}, {b, share}}};
    return vertex->second = add_vertex(point->second, shares);
  }

  std::uint32_t on_line(const std::array<std::uint32_t, 3>& triangle, const CutVertex& cut) {
    const std::size_t u = cut.axis[0], v = cut.axis[1];
    const double at_u = static_cast<double>(cut.plane[0] * kUnitsPerCell),
                 at_v = static_cast<double>(cut.plane[1] * kUnitsPerCell);
    std::array<std::pair<std::uint32_t, double>, 3> shares;
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const UnitPoint &b = places_[triangle[(k + 1) % 3]], &c = places_[triangle[(k + 2) % 3]];
      const double share = (static_cast<double>(b[u]) - at_u) * (static_cast<double>(c[v]) - at_v) -
                           (static_cast<double>(b[v]) - at_v) * (static_cast<double>(c[u]) - at_u);
      shares[k] = {triangle[k], share};
      sum += share;
    }
    Vector3d position = Vector3d::Zero();
    for (auto& [vertex, share] : shares) {
      share = std::clamp(share / sum, 0.0, 1.0);
      position += share * mesh_.positions[vertex].cast<double>();
    }
    return add_vertex(add_point(position, cut), shares);
  }

  void add(std::uint32_t number, std::vector<std::pair<std::uint32_t, Triangle>>& triangles) {
    const std::array<std::uint32_t, 3>& triangle = mesh_.triangles[number];
    const std::array<UnitPoint, 3> corners{places_[triangle[0]], places_[triangle[1]], places_[triangle[2]]};
    const UnitPoint normal = normal_of(corners);
    std::map<std::tuple<int, int, int, int>, std::uint32_t> on_lines;  // for this triangle
    std::vector<std::uint32_t> vertices;
    for (const CutPolygon& polygon : cut_triangle(corners)) {
      const Vector3i cell = low_ + Vector3i(polygon.cell[0], polygon.cell[1], polygon.cell[2]);
      const auto own = find_cell(lattice_, cell);
      SC_ASSERT(own.has_value(), "triangle {} reaches a cell at ({}, {}, {}) that is not in the lattice",
                number, cell.x(), cell.y(), cell.z());
      vertices.clear();
      for (const CutVertex& cut : polygon.vertices) {
        if (cut.planes == 0) {
          vertices.push_back(corner(triangle[cut.of]));
        } else if (cut.planes == 1) {
          vertices.push_back(on_side(triangle[cut.of], triangle[(cut.of + 1u) % 3], cut));
        } else {
          const auto [known, is_new] =
              on_lines.try_emplace({cut.axis[0], cut.plane[0], cut.axis[1], cut.plane[1]}, 0);
          if (is_new) {
            known->second = on_line(triangle, cut);
            cross(made_.point_of_vertex_[known->second], cell, normal);
          }
          vertices.push_back(known->second);
        }
      }
      if (!own) continue;
      for (std::size_t i = 0; i < vertices.size(); ++i) {
        if (polygon.sides[i] < CutPolygon::kOnPlane) continue;
        const int axis = polygon.sides[i] - CutPolygon::kOnPlane;
        if (polygon.planes[i] != polygon.cell[static_cast<std::size_t>(axis)] + 1) continue;
        const std::uint32_t from = made_.point_of_vertex_[vertices[i]];
        const std::uint32_t to = made_.point_of_vertex_[vertices[(i + 1) % vertices.size()]];
        made_.segments_.push_back({3 * *own + static_cast<std::uint32_t>(axis), to, from});
      }
      for (std::size_t i = 1; i + 1 < vertices.size(); ++i)
        triangles.push_back({*own, {{vertices[0], vertices[i], vertices[i + 1]}, part_of(mesh_, number)}});
    }
  }

  /// @param cell  one of the cells around the line's edge
  void cross(std::uint32_t number, const Vector3i& cell, const UnitPoint& normal) {
    const Point& point = made_.points_[number];
    const auto axis = static_cast<std::uint32_t>(3 - point.axis[0] - point.axis[1]);
    Vector3i corner;
    for (std::size_t i = 0; i < 2; ++i) corner[point.axis[i]] = point.plane[i];
    corner[static_cast<int>(axis)] = cell[static_cast<int>(axis)];
    made_.crossings_[edge_key(corner, axis)].push_back(
        {number, double{point.position[static_cast<int>(axis)]}, normal[axis] < 0 ? 1 : -1});
  }

  /// Computes windings along lines of x, starting outside.
  void wind() {
    // Lines along x, by y and z: the change of the winding beyond x.
    std::map<std::pair<int, int>, std::map<int, int>> lines;
    for (const auto& [key, crossings] : made_.crossings_) {
      if (key % 3 != 0) continue;
      const auto part = [corner = key / 3](int shift) {
        return static_cast<int>(corner >> shift & 0xfffffu) - (1 << 19);
      };
      int& change = lines[{part(20), part(0)}][part(40)];
      for (const Crossing& crossing : crossings) change += crossing.enters;
    }
    for (const Vector3i& corner : lattice_.particles) {
      int winding = 0;
      if (const auto line = lines.find({corner.y(), corner.z()}); line != lines.end())
        for (const auto& [x, change] : line->second)
          if (x < corner.x()) winding += change;
      made_.winding_.push_back(winding);
    }
  }

  CellMesh& made_;
  const TriangleMesh& mesh_;
  const Lattice<3>& lattice_;
  std::vector<std::uint32_t> position_number_;
  Vector3i low_, high_;
  std::vector<UnitPoint> places_;                // of each vertex of the mesh
  std::vector<std::uint32_t> vertex_of_corner_;  // of each vertex of the mesh
  std::unordered_map<std::uint32_t, std::uint32_t> point_of_position_;
  std::unordered_map<std::array<std::uint32_t, 4>, std::uint32_t, HashOfNumbers> vertex_on_side_,
      point_on_side_;
};

CellMesh::CellMesh(const TriangleMesh& mesh, const Lattice<3>& lattice) : lattice_(lattice), mesh_(mesh) {
  SC_ASSERT(!lattice.cells.empty(), "a mesh of {} triangles is cut at the faces of no cells",
            mesh.triangles.size());
  Maker(*this).make();
}

bool CellMesh::is_empty(std::uint32_t cell) const {
  return triangles_of(cell).empty() && winding_[lattice_.corners[cell][0]] == 0;
}

std::span<const CellMesh::Segment> CellMesh::segments_of(std::uint32_t face) const {
  return {std::ranges::lower_bound(segments_, face, {}, &Segment::face),
          std::ranges::upper_bound(segments_, face, {}, &Segment::face)};
}

std::span<const CellMesh::Crossing> CellMesh::crossings_of(const Corner& corner, std::uint32_t axis) const {
  const auto found = crossings_.find(edge_key(corner, axis));
  return found == crossings_.end() ? std::span<const Crossing>() : std::span<const Crossing>(found->second);
}

namespace {

using Side = std::pair<std::uint32_t, std::uint32_t>;  // numbers of its two points
using Loop = std::vector<std::uint32_t>;               // numbers of points

/// Joins sides into loops. @return none: they do not close, because the mesh is open
std::optional<std::vector<Loop>> loops_of(std::span<const Side> sides, std::size_t points) {
  std::vector<std::vector<std::uint32_t>> next_of(points);
  std::vector<int> balance(points);
  for (const auto& [from, to] : sides) {
    next_of[from].push_back(to);
    ++balance[from], --balance[to];
  }
  if (std::any_of(balance.begin(), balance.end(), [](int out) { return out != 0; })) return std::nullopt;
  std::vector<Loop> loops;
  for (std::uint32_t begin = 0; begin < next_of.size(); ++begin) {
    while (!next_of[begin].empty()) {
      Loop loop;
      std::uint32_t at = begin;
      do {
        loop.push_back(at);
        const std::uint32_t next = next_of[at].back();
        next_of[at].pop_back();
        at = next;
      } while (at != begin);
      if (loop.size() >= 3) loops.push_back(std::move(loop));  // two sides, there and back, enclose nothing
    }
  }
  return loops;
}

}  // namespace

/// Makes the cap of one face. The cut of the solid with a face is bounded by the mesh's cuts with the face, and by those parts of the
/// face's edges that are inside the solid.
class CellMesh::CapMaker {
 public:
  CapMaker(const CellMesh& mesh, std::uint32_t cell, std::uint32_t axis)
      : mesh_(mesh), cell_(cell), axis_(axis) {}

  Cap make() {
    append_cuts();
    append_rim();
    auto loops = loops_of(sides_, cap_.positions.size());
    if (!loops) return {};
    const Lattice<3>& lattice = mesh_.lattice_;
    std::vector<Eigen::Vector2d> flat;
    for (const Vector3f& position : cap_.positions) {
      const Vector3f local = (position - lattice.rest_position(lattice.corners[cell_][0])) / lattice.spacing;
      flat.emplace_back(local[u_], local[v_]);
    }
    cap_.triangles = fill_loops(flat, std::move(*loops));
    return std::move(cap_);
  }

 private:
  std::uint32_t number_of(std::uint32_t point) {
    const auto [number, is_new] =
        number_of_point_.try_emplace(point, static_cast<std::uint32_t>(cap_.positions.size()));
    if (is_new) cap_.positions.push_back(mesh_.points_[point].position);
    return number->second;
  }
  std::uint32_t number_of_corner(std::size_t i) {
    if (!std::exchange(has_number_[i], true)) {
      corner_number_[i] = static_cast<std::uint32_t>(cap_.positions.size());
      cap_.positions.push_back(mesh_.lattice_.rest_position(mesh_.lattice_.corners[cell_][around_[i]]));
    }
    return corner_number_[i];
  }

  /// The mesh's cuts with the face.
  void append_cuts() {
    for (const Segment& segment : mesh_.segments_of(3 * cell_ + axis_)) {
      const std::uint32_t from = number_of(segment.from);  // evaluated first by every compiler
      sides_.emplace_back(from, number_of(segment.to));
    }
  }

  /// The parts of the face's edges that are inside the solid, counter-clockwise seen from outside.
  void append_rim() {
    for (std::size_t i = 0; i < 4; ++i) {
      const std::uint32_t along = i % 2 == 0 ? u_ : v_;
      const std::size_t next = (i + 1) % 4, from = i < 2 ? i : next, to = i < 2 ? next : i;  // along the axis
      const std::uint32_t begin = mesh_.lattice_.corners[cell_][around_[from]];
      int winding = mesh_.winding_[begin];
      std::optional<std::uint32_t> last;  // number of the last point
      const auto end_at = [&](std::uint32_t number) {
        const bool forwards = (i < 2) == (winding > 0);
        for (int times = std::abs(winding); times > 0; --times)
          forwards ? sides_.emplace_back(*last, number) : sides_.emplace_back(number, *last);
      };
      if (winding != 0) last = number_of_corner(from);
      for (const Crossing& crossing : mesh_.crossings_of(mesh_.lattice_.particles[begin], along)) {
        const std::uint32_t number = number_of(crossing.point);
        if (winding != 0) end_at(number);
        winding += crossing.enters;
        last = number;
      }
      if (winding != 0) end_at(number_of_corner(to));
    }
  }

  const CellMesh& mesh_;
  const std::uint32_t cell_, axis_;
  const std::uint32_t u_ = (axis_ + 1) % 3, v_ = (axis_ + 2) % 3;  // axes in the face
  const std::array<unsigned, 4> around_{1u << axis_, 1u << axis_ | 1u << u_,
                                        1u << axis_ | 1u << u_ | 1u << v_, 1u << axis_ | 1u << v_};
  Cap cap_;
  std::vector<Side> sides_;  // of points in cap_.positions
  std::unordered_map<std::uint32_t, std::uint32_t> number_of_point_;
  std::array<std::uint32_t, 4> corner_number_{};
  std::array<bool, 4> has_number_{};
};

CellMesh::Cap CellMesh::cap(std::uint32_t cell, std::uint32_t axis) const {
  SC_ASSERT(cell < lattice_.cells.size() && axis < 3, "the face of cell {} of {} along axis {}", cell,
            lattice_.cells.size(), axis);
  return CapMaker(*this, cell, axis).make();
}

}  // namespace softcell::ppu
