#include "ppu/surfaces/contact_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unordered_map>

#include "ppu/lattice/locate.h"
#include "ppu/mesh/outer_surface.h"
#include "ppu/mesh/solid.h"
#include "ppu/surfaces/point_chooser.h"
#include "ppu/surfaces/triangle_distance.h"
#include "softcell/base/assert.h"

namespace softcell::ppu {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

// All in cells.
constexpr float kCandidateSpacing = 0.2f;  // between the candidates that points are chosen from

float volume_of(const TriangleMesh& mesh) {
  float volume = 0;
  for (const auto& t : mesh.triangles)
    volume += mesh.positions[t[0]].dot(mesh.positions[t[1]].cross(mesh.positions[t[2]])) / 6;
  return volume;
}

}  // namespace

TriangleMesh boundary_of(const Lattice<3>& lattice) {
  TriangleMesh mesh;
  mesh.positions.reserve(lattice.particles.size());
  for (std::size_t i = 0; i < lattice.particles.size(); ++i)
    mesh.positions.push_back(lattice.rest_position(i));
  mesh.normals.assign(mesh.positions.size(), Vector3f::UnitY());
  for (std::size_t c = 0; c < lattice.cells.size(); ++c) {
    for (unsigned d = 0; d < 3; ++d) {
      for (unsigned high = 0; high < 2; ++high) {
        const Vector3i beyond = lattice.cells[c] + (high != 0 ? 1 : -1) * Vector3i(Vector3i::Unit(d));
        if (find_cell(lattice, beyond)) continue;
        // The face's corners, counter-clockwise seen from outside.
        const unsigned u = 1u << ((d + 1) % 3), v = 1u << ((d + 2) % 3), at = high << d;
        const auto& corners = lattice.corners[c];
        std::array<std::uint32_t, 4> face{corners[at], corners[at | u], corners[at | u | v], corners[at | v]};
        if (high == 0) std::reverse(face.begin(), face.end());
        mesh.triangles.push_back({face[0], face[1], face[2]});
        mesh.triangles.push_back({face[0], face[2], face[3]});
      }
    }
  }
  return mesh;
}

ContactSurface::ContactSurface(const TriangleMesh& mesh, const Lattice<3>& lattice) {
  if (mesh.triangles.empty()) {
    const TriangleMesh boundary = boundary_of(lattice);
    sample(boundary, lattice);
    measure(boundary, lattice, nullptr);
    return;
  }
  const Solid solid(mesh);
  const std::optional<TriangleMesh> outside = outer_surface(mesh, solid, lattice.spacing);
  const TriangleMesh& surface = outside ? *outside : mesh;
  sample(surface, lattice);
  measure(surface, lattice, outside ? &solid : nullptr);
}

/// Offers vertices first: those of sharp corners and edges must not give way to points beside them.
void ContactSurface::sample(const TriangleMesh& mesh, const Lattice<3>& lattice) {
  PointChooser chooser(lattice.spacing);
  const auto offer = [&](const Vector3f& point, const Vector3f& normal) {
    const auto place = locate(lattice, point);
    if (!place || !chooser.choose(point, normal)) return;
    points_.push_back({place->cell, place->xi.cast<float>(), point});
  };
  const auto for_each_triangle = [&](const auto& work) {
    for (const auto& t : mesh.triangles) {
      const Vector3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
      const Vector3f normal = (b - a).cross(c - a);
      if (normal.squaredNorm() > 0) work(a, b, c, normal.normalized());
    }
  };
  for_each_triangle([&](const Vector3f& a, const Vector3f& b, const Vector3f& c, const Vector3f& normal) {
    offer(a, normal), offer(b, normal), offer(c, normal);
  });
  for_each_triangle([&](const Vector3f& a, const Vector3f& b, const Vector3f& c, const Vector3f& normal) {
    const float longest =
        std::sqrt(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
    const int steps = static_cast<int>(std::ceil(longest / (kCandidateSpacing * lattice.spacing)));
    const float step = 1 / static_cast<float>(steps);
    for (int i = 0; i <= steps; ++i)
      for (int j = 0; j <= steps - i; ++j)
        offer(a + static_cast<float>(i) * step * (b - a) + static_cast<float>(j) * step * (c - a), normal);
  });
  std::stable_sort(points_.begin(), points_.end(),
                   [](const auto& a, const auto& b) { return a.cell < b.cell; });
}

namespace {

constexpr int kNodesToNext = ContactSurface::kNodesPerEdge - 1;  // nodes from one cell to the next
constexpr float kNodeStep = 1.0f / kNodesToNext;
constexpr float kNoDistance = -std::numeric_limits<float>::max();

/// In cells, by the keys of nodes.
using NodeDistances = std::unordered_map<std::uint64_t, float>;

/// Deeper inside than exact distances reach: counts steps from node to node, layer by layer.
void count_inwards(NodeDistances& distances, std::vector<Vector3i> unknown) {
  while (!unknown.empty()) {
    std::vector<Vector3i> later;
    std::vector<std::pair<std::uint64_t, float>> found;
    for (const Vector3i& node : unknown) {
      float deepest = kNoDistance;
      for (int d = 0; d < 6; ++d) {
        const auto neighbour =
            distances.find(key_of(node + (d < 3 ? 1 : -1) * Vector3i(Vector3i::Unit(d % 3))));
        if (neighbour != distances.end()) deepest = std::max(deepest, neighbour->second);
      }
      if (deepest == kNoDistance)
        later.push_back(node);
      else
        found.emplace_back(key_of(node), std::min(deepest, 0.0f) - kNodeStep);
    }
    for (const auto& [key, distance] : found) distances[key] = distance;
    if (found.empty()) break;  // no triangle is anywhere near
    unknown = std::move(later);
  }
}

}  // namespace

/// @param solid  tells what is inside; null: the nearest triangle decides
void ContactSurface::measure(const TriangleMesh& mesh, const Lattice<3>& lattice, const Solid* solid) {
  const TriangleGrid triangles(mesh, lattice.spacing);
  const float outwards = volume_of(mesh) < 0 ? -1.0f : 1.0f;  // -1 for a mesh turned inside out

  // Measures each node once, in the order of cells.
  NodeDistances distances;
  std::vector<Vector3i> unknown;
  const auto for_each_node = [&](std::size_t cell, const auto& work) {
    std::size_t n = 0;
    for (int z = 0; z <= kNodesToNext; ++z)
      for (int y = 0; y <= kNodesToNext; ++y)
        for (int x = 0; x <= kNodesToNext; ++x)
          work(n++, Vector3i(kNodesToNext * lattice.cells[cell] + Vector3i(x, y, z)));
  };
  for (std::size_t c = 0; c < lattice.cells.size(); ++c) {
    for_each_node(c, [&](std::size_t, const Vector3i& node) {
      const auto [entry, is_new] = distances.try_emplace(key_of(node), kNoDistance);
      if (!is_new) return;
      const Vector3f at = lattice.origin + lattice.spacing * kNodeStep * node.cast<float>();
      const float reach = kReach * lattice.spacing;
      float distance = outwards * triangles.signed_distance(at, reach) / lattice.spacing;
      if (solid != nullptr && std::abs(distance) < kReach)
        distance = solid->contains(at) ? -std::abs(distance) : std::abs(distance);
      if (std::abs(distance) < kReach)
        entry->second = distance;
      else
        unknown.push_back(node);
    });
  }
  count_inwards(distances, std::move(unknown));
  fields_.resize(lattice.cells.size());
  for (std::size_t c = 0; c < lattice.cells.size(); ++c)
    for_each_node(c,
                  [&](std::size_t n, const Vector3i& node) { fields_[c][n] = distances.at(key_of(node)); });
  allow_particles(lattice);
}

void ContactSurface::allow_particles(const Lattice<3>& lattice) {
  constexpr float kSlack = 0.1f;
  particles_.resize(lattice.particles.size());
  for (std::size_t c = 0; c < lattice.cells.size(); ++c)
    for (std::size_t k = 0; k < 8; ++k) {
      const float outside = fields_[c][node_of_corner(k)];
      const std::uint32_t i = lattice.corners[c][k];
      particles_[i] = {i, outside > 0 ? outside + kSlack : 0};
    }
}

FieldValue ContactSurface::field(std::uint32_t cell, const Vector3f& xi) const {
  SC_ASSERT(cell < fields_.size(), "cell {} of {}", cell, fields_.size());
  const CellField& nodes = fields_[cell];
  constexpr float kScale = kNodesPerEdge - 1;
  const Vector3f place = xi * kScale;
  const Vector3i low =
      place.cwiseMax(Vector3f::Zero()).cwiseMin(Vector3f::Constant(kScale - 0.5f)).cast<int>();
  const Vector3f f = place - low.cast<float>();
  const auto at = [&](int x, int y, int z) {
    return nodes[static_cast<std::size_t>(((low.z() + z) * kNodesPerEdge + low.y() + y) * kNodesPerEdge +
                                          low.x() + x)];
  };
  const auto mix = [](float a, float b, float t) { return a + t * (b - a); };
  const float d00 = mix(at(0, 0, 0), at(1, 0, 0), f.x()), d10 = mix(at(0, 1, 0), at(1, 1, 0), f.x());
  const float d01 = mix(at(0, 0, 1), at(1, 0, 1), f.x()), d11 = mix(at(0, 1, 1), at(1, 1, 1), f.x());
  const float d0 = mix(d00, d10, f.y()), d1 = mix(d01, d11, f.y());
  const float x0 = mix(at(1, 0, 0) - at(0, 0, 0), at(1, 1, 0) - at(0, 1, 0), f.y());
  const float x1 = mix(at(1, 0, 1) - at(0, 0, 1), at(1, 1, 1) - at(0, 1, 1), f.y());
  return {mix(d0, d1, f.z()),
          kScale * Vector3f(mix(x0, x1, f.z()), mix(d10 - d00, d11 - d01, f.z()), d1 - d0)};
}

}  // namespace softcell::ppu
